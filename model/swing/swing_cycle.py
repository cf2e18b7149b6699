"""One linkage over both strokes of a swing: extremes of curves, energies between kinks, where friction locks."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, Mask
from ..cycle.cycle import kinks_of_loads
from ..dynamics.segments import crank_angle_at
from ..linkage.linkage import Linkage
from ..machine.loads.load import Enters
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import load_structure
from ..quadrature import graded_gauss_nodes_and_weights
from .forces import SwingCurves, driver_start_and_end, swing_curves
from .law import corner_times, reversed_law_pieces, time_fractions_at_travel
from .swing import Swing, dead_point_angles

_SAMPLES = 721
_ZOOMS, _ZOOMED = 7, 41
_EQUAL = 1e-12
_PANELS, _GRADED = 12, 3
_SIDES = 400
_BISECTIONS = 55


@dataclass(frozen=True)
class SwingPoint:
    """A value in a swing and its place: direction, fraction of the time, crank angle, slider position; SI."""

    value: float
    back: bool
    share: float
    crank_angle: float
    slider_position: float


@dataclass(frozen=True)
class SwingCycle:
    """A machine, a linkage and a swing."""

    mechanism: Mechanism
    linkage: Linkage
    swing: Swing

    def curves(self, share: Array, *, back: bool = False) -> SwingCurves:
        """Return the curves at fractions (n,) of the time of one stroke."""
        return swing_curves(self.mechanism, self.linkage, self.swing, share, back=back)

    def greatest_magnitude(self, name: str) -> SwingPoint:
        """Return the maximum magnitude of a curve over both strokes."""
        forward, back = (self._extreme_in_stroke(name, way, np.abs) for way in (False, True))
        # If both strokes are equal up to rounding, as without friction, take the first.
        return back if abs(back.value) > abs(forward.value) * (1.0 + _EQUAL) or np.isnan(forward.value) else forward

    def minimum_of_curve(self, curve: str) -> SwingPoint:
        """Return the minimum of a curve that is the same in both strokes."""
        return self._extreme_in_stroke(curve, False, np.negative)

    def range_of_curve(self, curve: str) -> tuple[SwingPoint, SwingPoint]:
        """Return the minimum and the maximum of a curve over both strokes; NaN if friction locks throughout."""
        lows, highs = (
            [self._extreme_in_stroke(curve, way, rank, count=4) for way in (False, True)]
            for rank in (np.negative, np.positive)
        )
        # If both strokes are equal up to rounding, take the first.
        span = max(point.value for point in highs) - min(point.value for point in lows)
        least = lows[1] if lows[1].value < lows[0].value - _EQUAL * span or np.isnan(lows[0].value) else lows[0]
        greatest = highs[1] if highs[1].value > highs[0].value + _EQUAL * span or np.isnan(highs[0].value) else highs[0]
        return least, greatest

    @cached_property
    def _sampled_strokes(self) -> tuple[SwingCurves, SwingCurves]:
        """Curves over both strokes at many fractions of the time."""
        share = np.linspace(0.0, 1.0, _SAMPLES)
        return self.curves(share), self.curves(share, back=True)

    @cached_property
    def _zoomed_curves(self) -> dict[tuple[bool, float, float], SwingCurves]:
        """Curves between two fractions of the time, cached by stroke and fractions: many extremes coincide."""
        return {}

    def _extreme_in_stroke(self, name: str, back: bool, rank: np.ufunc, count: int = 1) -> SwingPoint:
        """Return the extreme in one stroke. count: number of the best local extremes to refine between samples."""
        curves = self._sampled_strokes[back]
        ranks = _ranked_without_nan(getattr(curves, name), rank)
        padded = np.concatenate([[-np.inf], ranks, [-np.inf]])
        local = np.flatnonzero((ranks >= padded[:-2]) & (ranks >= padded[2:]))
        best = [int(np.argmax(ranks)), *local[np.argsort(-ranks[local], kind="stable")][: count - 1].tolist()]
        candidates = [self._refine_extreme(name, back, rank, curves, row) for row in dict.fromkeys(best)]
        return candidates[int(np.argmax(_ranked_without_nan(np.array([point.value for point in candidates]), rank)))]

    def _refine_extreme(self, name: str, back: bool, rank: np.ufunc, curves: SwingCurves, best: int) -> SwingPoint:
        for _ in range(_ZOOMS):
            low, high = curves.share[max(best - 1, 0)], curves.share[min(best + 1, len(curves.share) - 1)]
            if (back, low, high) not in self._zoomed_curves:
                self._zoomed_curves[back, low, high] = self.curves(np.linspace(low, high, _ZOOMED), back=back)
            curves = self._zoomed_curves[back, low, high]
            best = int(np.argmax(_ranked_without_nan(getattr(curves, name), rank)))
        return _point_of_sample(curves, best, back, float(getattr(curves, name)[best]))

    def first_lockable_point(self) -> SwingPoint | None:
        """Return the first place where friction may lock the linkage, by bisection between many samples."""
        if not self.mechanism.friction.acts:
            return None
        for back in (False, True):
            share, drive = self._sampled_strokes[back].share, self._sampled_strokes[back].drive
            rows = np.flatnonzero(np.isnan(drive))
            if len(rows):
                first = int(rows[0])
                before = share[max(first - 1, 0)]
                at = (
                    self._time_fraction_of_side_change(
                        before, share[first], lambda curves: np.isnan(curves.drive), back
                    )
                    if first
                    else 0.0
                )
                return _point_of_sample(self.curves(np.array([at]), back=back), 0, back, np.nan)
        return None

    def is_held_by_friction(self) -> bool:
        """Return whether friction alone holds the linkage throughout: zero lies between the drives of both strokes."""
        if not self.mechanism.friction.acts:
            return False
        forward, back = self._sampled_strokes
        # The forward stroke is along the driver's direction: resistance needs a drive in that direction, and the
        # opposite on return.
        first, last = driver_start_and_end(self.linkage, self.swing)
        way = np.sign(last - first)
        return bool(np.all((way * forward.drive >= 0.0) & (way * back.drive[::-1] <= 0.0)))

    def driver_work(self, *, back: bool) -> float:
        """Return the driver's work, J; zero if it is only a rounding error.

        Gauss quadrature on panels between the places where the drive has kinks or jumps. Each interval is graded
        towards its ends, because near a dead point the drive grows as the inverse square root of the distance from it.
        """
        cuts = self._cut_time_fractions(back)
        u, w = graded_gauss_nodes_and_weights(_PANELS, _GRADED)
        spans = np.diff(cuts)
        share = (cuts[:-1, None] + spans[:, None] * u).ravel()
        curves = self.curves(share, back=back)
        parts = (spans[:, None] * w).ravel() * curves.drive * curves.rate
        total, gross = float(np.sum(parts)), float(np.sum(np.abs(parts)))
        return 0.0 if abs(total) <= _EQUAL * gross else total

    def _cut_time_fractions(self, back: bool) -> Array:
        table = reversed_law_pieces(self.swing.points) if back else self.swing.law_pieces
        shares = [
            0.0,
            1.0,
            *corner_times(self.swing.law, table),
            *self._shares_at_angles(self._crank_angles_of_kinks(), table),
        ]
        if back:
            shares = [1.0 - share for share in shares]
        return np.unique([*shares, *self._time_fractions_of_friction_changes(back)])

    def _crank_angles_of_kinks(self) -> list[float]:
        """Return the crank angles at which loads or friction change: knots of tables, dead centres, rod reversals."""
        linkage, swing = self.linkage, self.swing
        angles = [*dead_point_angles(linkage), 0.5 * np.pi, 1.5 * np.pi]
        if bool(linkage.rotates_fully):
            angles += kinks_of_loads(self.mechanism, linkage).tolist()
        else:  # then no load is counted from a dead centre
            loads = load_structure(self.mechanism)
            for k, load in enumerate(self.mechanism.loads):
                knots = loads.knots[loads.start[k] : loads.start[k + 1]]
                angles += knots.tolist() if load.enters == Enters.ANGLE_TABLE else self._angles_at_positions(knots)
        return [occurrence for angle in angles for occurrence in swing.equal_angles_within_swing(float(angle))]

    def _angles_at_positions(self, knots: Array) -> list[float]:
        """Return the crank angles at which the slider passes given distances from the crank pivot."""
        linkage = self.linkage
        r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
        angles: list[float] = []
        for x in (linkage.sign * knots).tolist():
            if abs(r - l) < math.hypot(x, e) < r + l:
                angles += [crank_angle_at(x, r, l, e, second) for second in (False, True)]
        return angles

    def _shares_at_angles(self, angles: list[float], table: Array) -> list[float]:
        first, last = driver_start_and_end(self.linkage, self.swing)
        places = np.array(angles)
        if self.swing.driver == "slider":
            places = self.linkage.at(places).slider_position
        ways = np.clip((places - first) / (last - first), 0.0, 1.0)
        shares: list[float] = time_fractions_at_travel(self.swing.law, ways, table).tolist()
        return shares

    def _time_fractions_of_friction_changes(self, back: bool) -> list[float]:
        """Return the fractions of the time at which friction in the guide, or in the crank pin, changes sides."""
        if not self.mechanism.friction.acts:
            return []
        share = np.linspace(0.0, 1.0, _SIDES)
        shares: list[float] = []
        sides: tuple[Callable[[SwingCurves], Mask], ...] = (
            lambda curves: curves.guide > 0.0,
            lambda curves: curves.rod_rate > 1.0,  # the crank pin rubs the other way
        )
        for side in sides:
            values = side(self.curves(share, back=back))
            places = np.flatnonzero(values[:-1] != values[1:]).tolist()
            shares += [self._time_fraction_of_side_change(share[i], share[i + 1], side, back) for i in places]
        return shares

    def _time_fraction_of_side_change(
        self, low: float, high: float, side: Callable[[SwingCurves], Mask], back: bool
    ) -> float:
        """Return the fraction between two at which a side changes, just past the change; by bisection."""
        after = side(self.curves(np.array([high]), back=back))[0]
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            low, high = (
                (low, middle) if side(self.curves(np.array([middle]), back=back))[0] == after else (middle, high)
            )
        return float(high)


def _ranked_without_nan(values: Array, rank: np.ufunc) -> Array:
    return np.where(np.isnan(values), -np.inf, rank(values))


def _point_of_sample(curves: SwingCurves, sample: int, back: bool, value: float) -> SwingPoint:
    return SwingPoint(
        value,
        back,
        float(curves.share[sample]),
        float(curves.crank_angle[sample]),
        float(curves.slider_position[sample]),
    )
