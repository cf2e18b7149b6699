"""A swing in numbers: drive, holding forces, energies, transmission and error of the driven side."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from ..cycle.cycle import kinks_of_loads
from ..linkage.linkage import Linkage
from ..machine.friction import Friction
from ..machine.loads.load import Enters
from ..machine.mechanism import Mechanism
from ..machine.raw import load_structure
from .forces import SwingCurves, driver_ends, swing_curves
from .law import corners, share_of
from .swing import Array, Swing, dead_points, require_swing

_SAMPLES = 721
_ZOOMS, _ZOOMED = 7, 41
_EQUAL = 1e-12
_PANELS = 6
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)
_SIDES = 400
_BISECTIONS = 55


@dataclass(frozen=True)
class At:
    """A value of a swing and its place: way, share of the time, crank angle, slider position; SI."""

    value: float
    back: bool
    share: float
    crank_angle: float
    slider_position: float


@dataclass(frozen=True)
class SwingSummary:
    """One linkage over a swing, SI and radians.

    driver_ends: crank angles or slider positions. swing_angle, travel: of crank and slider, sizes. peak_drive: greatest
    size of the driver's torque or force, either way. drive_start, drive_end: what the driver brings there on its way
    forth and on its way back, without inertia: the two hold the linkage at rest where friction is next to nothing, and
    any force between them where it is not. holds: whether friction alone holds the linkage at rest all over the swing.
    energy_forth, energy_back: of the driver, J. stored: what the way forth takes slowly and without friction, J.
    efficiency: stored over energy_forth, or energy_back over minus stored where the way back is driven; None where
    nothing is stored. peak_power: W, None where the swing is slow. least_transmission: angle of the driven side.
    position_error: None without tolerances. Drive and energy are NaN, and the first place in `locked`, where friction
    locks the linkage.
    """

    swing: Swing
    linkage: Linkage
    crank_angles: tuple[float, float]
    slider_positions: tuple[float, float]
    peak_drive: At
    drive_start: tuple[float, float]
    drive_end: tuple[float, float]
    holds: bool
    energy_forth: float
    energy_back: float
    stored: float
    efficiency: float | None
    peak_power: At | None
    least_transmission: At
    position_error: At | None
    locked: At | None

    @property
    def swing_angle(self) -> float:
        """Angle that the crank turns by, one way."""
        return abs(self.crank_angles[1] - self.crank_angles[0])

    @property
    def travel(self) -> float:
        """Distance of the slider's positions at both ends; on its way it may go beyond them where the crank drives."""
        return abs(self.slider_positions[1] - self.slider_positions[0])


def summarise(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> SwingSummary:
    """Return the numbers of a swing. Peaks are of the continuous crank angle, energies integrals between kinks.

    Raises what `require_swing` raises.
    """
    own = require_swing(mechanism, linkage, swing)
    over = _Over(mechanism, own, swing)
    ends = np.array([0.0, 1.0])
    slow = _Over(mechanism, own, replace(swing, law="slow", duration=None))
    still = slow.at(ends), slow.at(ends, back=True)
    free = _Over(replace(mechanism, friction=Friction()), own, slow.swing)
    stored = free.energy(back=False)
    spent, returned = over.energy(back=False), over.energy(back=True)
    locked = over.first_locked()
    moves = swing.duration is not None
    tolerances = mechanism.tolerances.given or swing.actuator_tolerance > 0.0
    return SwingSummary(
        swing=swing,
        linkage=own,
        crank_angles=(swing.start, swing.end),
        slider_positions=(float(still[0].slider_position[0]), float(still[0].slider_position[1])),
        peak_drive=over.greatest("drive"),
        drive_start=(float(still[0].drive[0]), float(still[1].drive[1])),
        drive_end=(float(still[0].drive[1]), float(still[1].drive[0])),
        holds=slow.holds(),
        energy_forth=spent,
        energy_back=returned,
        stored=stored,
        efficiency=_efficiency(stored, spent, returned),
        peak_power=over.greatest("power") if moves else None,
        least_transmission=over.least("driven_angle"),
        position_error=over.greatest("driven_error") if tolerances else None,
        locked=locked,
    )


def _efficiency(stored: float, spent: float, returned: float) -> float | None:
    if stored > 0.0 and spent > 0.0:
        return stored / spent
    if stored < 0.0 and returned > 0.0:
        return -stored / returned
    return None


@dataclass(frozen=True)
class _Over:
    """A machine, a linkage and a swing."""

    mechanism: Mechanism
    linkage: Linkage
    swing: Swing

    def at(self, share: Array, *, back: bool = False) -> SwingCurves:
        return swing_curves(self.mechanism, self.linkage, self.swing, share, back=back)

    def greatest(self, name: str) -> At:
        """Return the greatest size of a curve on both ways."""
        forth, back = (self._extreme(name, way, np.abs) for way in (False, True))
        # The same on both ways but for rounding, as without friction: the first.
        return back if abs(back.value) > abs(forth.value) * (1.0 + _EQUAL) or np.isnan(forth.value) else forth

    def least(self, name: str) -> At:
        """Return the least value of a curve, the same on both ways."""
        return self._extreme(name, False, np.negative)

    def _extreme(self, name: str, back: bool, worth: np.ufunc) -> At:
        low, high, count = 0.0, 1.0, _SAMPLES
        for _ in range(1 + _ZOOMS):
            share = np.linspace(low, high, count)
            curves = self.at(share, back=back)
            values = getattr(curves, name)
            ranks = np.where(np.isnan(values), -np.inf, worth(values))
            best = int(np.argmax(ranks))
            low, high, count = share[max(best - 1, 0)], share[min(best + 1, len(share) - 1)], _ZOOMED
        return _place(curves, best, back, float(values[best]))

    def first_locked(self) -> At | None:
        """Return the first place where friction locks the linkage, among many."""
        for back in (False, True):
            curves = self.at(np.linspace(0.0, 1.0, _SAMPLES), back=back)
            rows = np.flatnonzero(np.isnan(curves.drive))
            if len(rows):
                return _place(curves, int(rows[0]), back, np.nan)
        return None

    def holds(self) -> bool:
        """Return whether no drive, zero, lies between what moves it forth and what moves it back, all over."""
        share = np.linspace(0.0, 1.0, _SAMPLES)
        forth, back = self.at(share), self.at(share, back=True)
        # Forth is along the driver's way: what resists needs a drive that way, and back one the other way.
        first, last = driver_ends(self.linkage, self.swing)
        way = np.sign(last - first)
        return bool(np.all((way * forth.drive >= 0.0) & (way * back.drive[::-1] <= 0.0)))

    def energy(self, *, back: bool) -> float:
        """Return the driver's work, J: Gauss's quadrature between the places where the drive has kinks or jumps."""
        cuts = self._cuts(back)
        edges = np.concatenate([np.linspace(a, b, _PANELS + 1)[:-1] for a, b in itertools.pairwise(cuts)])
        edges = np.append(edges, 1.0)
        half = 0.5 * np.diff(edges)[:, None]
        share = (edges[:-1, None] + half + half * _NODES).ravel()
        curves = self.at(share, back=back)
        return float(np.sum((half * _WEIGHTS).ravel() * curves.drive * curves.rate))

    def _cuts(self, back: bool) -> Array:
        shares = [0.0, 1.0, *corners(self.swing.law), *(self._share(angle) for angle in self._kinks())]
        if back:
            shares = [1.0 - share for share in shares]
        return np.unique([*shares, *self._changes(back)])

    def _kinks(self) -> list[float]:
        """Return the crank angles at which loads or friction change: knots of tables, dead centres, the rod's turn."""
        own, swing = self.linkage, self.swing
        angles = [*dead_points(own), 0.5 * np.pi, 1.5 * np.pi]
        if bool(own.rotates_fully):
            angles += kinks_of_loads(self.mechanism, own).tolist()
        else:  # then none is counted from a dead centre
            loads = load_structure(self.mechanism)
            for k, load in enumerate(self.mechanism.loads):
                knots = loads.at[loads.start[k] : loads.start[k + 1]]
                angles += knots.tolist() if load.enters == Enters.ANGLE_TABLE else self._angles_of(knots)
        return [inside for angle in angles for inside in swing.inside(float(angle))]

    def _angles_of(self, knots: Array) -> list[float]:
        """Return the crank angles at which the slider passes distances from the crank pivot."""
        own = self.linkage
        r, l, e = float(own.crank), float(own.rod), float(own.offset)
        found: list[float] = []
        for x in (own.sign * knots).tolist():
            d = float(np.hypot(x, e))
            ratio = (r * r + d * d - l * l) / (2.0 * r * d) if d else np.inf
            if abs(ratio) < 1.0:
                found += [float(np.arctan2(e, x) + side * np.arccos(ratio)) for side in (-1.0, 1.0)]
        return found

    def _share(self, angle: float) -> float:
        first, last = driver_ends(self.linkage, self.swing)
        place = angle
        if self.swing.driver == "slider":
            r, l, e, sign = self.linkage.crank, self.linkage.rod, self.linkage.offset, self.linkage.sign
            place = float(r * np.cos(angle) + sign * np.sqrt(max(0.0, l * l - (e - r * np.sin(angle)) ** 2)))
        return share_of(self.swing.law, float(np.clip((place - first) / (last - first), 0.0, 1.0)))

    def _changes(self, back: bool) -> list[float]:
        """Return the shares at which friction changes sides: of the guide, and of a crank pin that turns back."""
        if not self.mechanism.friction.acts:
            return []
        share = np.linspace(0.0, 1.0, _SIDES)
        found: list[float] = []
        for side in (_guide, _pin_turn):
            values = side(self.at(share, back=back))
            for i in np.flatnonzero(values[:-1] * values[1:] < 0.0).tolist():
                low, high, sign = share[i], share[i + 1], values[i]
                for _ in range(_BISECTIONS):
                    middle = 0.5 * (low + high)
                    now = float(side(self.at(np.array([middle]), back=back))[0])
                    low, high = (middle, high) if now * sign > 0.0 else (low, middle)
                found.append(float(0.5 * (low + high)))
        return found


def _guide(curves: SwingCurves) -> Array:
    return curves.guide


def _pin_turn(curves: SwingCurves) -> Array:
    return 1.0 - curves.rod_rate


def _place(curves: SwingCurves, row: int, back: bool, value: float) -> At:
    return At(
        value,
        back,
        float(curves.share[row]),
        float(curves.crank_angle[row]),
        float(curves.slider_position[row]),
    )
