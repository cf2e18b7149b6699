"""A quantity under tolerances: its worst case, or the value that a fraction of all machines meets."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from dataclasses import field as _field
from functools import partial
from typing import Any, Literal

import numpy as np

from ...model.arrays import IntArray, Mask
from ...model.errors import InputError
from ...model.machine.loads.load import require_word
from ...model.machine.mechanism import Mechanism
from ...model.tolerance.error_distributions import Shape, error_distribution
from ..kinds import Kind
from ..quantity import Array, Pieces, Quantity, Values
from .negated_quantity import NegatedQuantity, negated_pieces
from .quantile import sample
from .worst_points import (
    PointValues,
    box_corners,
    evaluate_points,
    match_pieces,
    quadratic_fit_points,
    tolerance_limits,
    toleranced_columns,
    worst_inner_points,
)

Side = Literal["high", "low"]
Case = Literal["worst case", "percentile"]

SAMPLES = 2048
"""Default number of machines for a percentile."""
_LEAST = 64
_MOST = 65536
_MOST_PIECES = 8  # pieces of a worst case that may tie
_LABEL_STEP = 100.0  # rad, between the labels of different corners
_STEP = 0.05  # in units of the limits, see `_linear_worst_case`
_BLOCK = 1 << 22  # numbers of a sample held in memory together


@dataclass(frozen=True, kw_only=True)
class RobustQuantity(Quantity):
    """A quantity within the tolerances of crank, rod and offset.

    inner: the nominal quantity. side: the bad side, "high" if low values are better. case "worst case", order 1: f +
    sum_i |df/dx_i| T_i (high) or f - sum_i |df/dx_i| T_i (low). Order 2: the exact worst f in the box, including terms
    of second and all higher orders. The worst f is at a corner, at offset zero if the limits span it, or inside, at an
    extreme found by `worst_points`. If the limits span offset zero, order 1 becomes order 2, because quantities that
    depend on its magnitude have no derivative there. case "percentile": the value that a fraction of all machines
    meets, `P(f <= v) = share` (high) or `P(f >= v) = share` (low). Errors are independent, with the distribution
    `shape`, in units of the limits T_i = absolute + fraction |x_i|. samples: number of machines, rounded up to a power
    of two; see `quantile`. seed: seed for scrambling. suffix: suffix of name and column key.

    The slope of a percentile has small steps where machines change rank, and larger ones where peaks tie within
    machines. A design at such a step may have the status "best found" rather than stationary. Infinite on the bad side
    if a corner or a point of the star does not rotate fully, or a lever there cannot make its swing. Raises
    `InputError` for options that are out of range.
    """

    name: str = _field(init=False)
    title: str = _field(init=False, compare=False)
    kind: Kind = _field(init=False)
    inner: Quantity
    side: Side
    case: Case = "percentile"
    order: int = 2
    share: float = 0.99
    samples: int = SAMPLES
    shape: Shape = "normal"
    seed: int = 1
    suffix: str = "robust"

    def __post_init__(self) -> None:
        require_word("side", self.side, Side)
        require_robust_options_in_range(self.case, self.order, self.share, self.samples, self.shape)
        whose = "all within tolerances" if self.case == "worst case" else f"{100.0 * self.share:.6g} % of machines"
        facts = {
            "name": f"{self.inner.name if self.inner.name.isidentifier() else self.inner.column_stem}_{self.suffix}",
            "key": f"{self.inner.column_stem}_{self.suffix}",
            "title": f"{self.inner.short_title}, {whose}",
            "short": "",
            "signed": True,  # errors may take a quantity beyond the range of nominal linkages
            "domain": None,
            "floor": None,
            "in_line": None,
            "bounds": None,
        }
        for fact in fields(Quantity):  # the other facts are those of the nominal quantity
            object.__setattr__(self, fact.name, facts.get(fact.name, getattr(self.inner, fact.name)))

    def __reduce__(self) -> tuple[Any, ...]:
        options = {field.name for field in fields(self)} - {fact.name for fact in fields(Quantity)}
        return partial(type(self), **{name: getattr(self, name) for name in options}), ()

    @property
    def component_quantities(self) -> tuple[Quantity, ...]:
        """The quantity itself."""
        return (self.inner,)

    def with_parts(self, parts: tuple[Quantity, ...]) -> RobustQuantity:
        """Return the robust version of another quantity with the same name."""
        return replace(self, inner=parts[0])

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if not toleranced_columns(mechanism):
            return self.inner.evaluate(mechanism, dimensions, gradients=gradients)
        pieces = self.pieces(mechanism, dimensions)
        values = pieces.values.min(axis=1) if pieces.least else pieces.values.max(axis=1)
        if not gradients:
            return Values(values, None)
        first = (np.argmin if pieces.least else np.argmax)(pieces.values, axis=1)
        return Values(values, pieces.gradients[np.arange(len(values)), first])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the maximum of smooth pieces, or their minimum on the low side."""
        dimensions = np.asarray(dimensions, dtype=np.float64)
        limits = tolerance_limits(mechanism, dimensions)  # raises for unusable tolerances
        columns = toleranced_columns(mechanism)
        if columns and self.inner.pieces(mechanism, dimensions[:1]).least:
            same = ("name", "kind", "smooth_at_zero_offset")
            facts: dict[str, Any] = {name: getattr(self.inner, name) for name in same}
            inner = NegatedQuantity(inner=self.inner, **facts)
            negated = replace(self, inner=inner, side="low" if self.side == "high" else "high")
            return negated_pieces(negated.pieces(mechanism, dimensions))
        if not columns:
            pieces = self.inner.pieces(mechanism, dimensions)
            if self.side == "high":
                return pieces
            return replace(pieces, least=True).select_pieces(
                np.argmax(pieces.values, axis=1)[:, None]
            )  # its only active piece
        if self.case == "percentile":
            return self._quantile(mechanism, dimensions, tuple(columns))
        low = self.side == "low"
        spans = (np.abs(dimensions[:, 2]) < limits[:, 2]) | (self.order == 2)
        parts = [
            (np.flatnonzero(rows), exact(mechanism, dimensions[rows], columns))
            for rows, exact in ((spans, self._exact_worst_case), (~spans, self._linear_worst_case))
            if rows.any() or (len(rows) == 0 and exact == self._exact_worst_case)
        ]
        merged = _merge_parts(len(dimensions), parts, absent=np.inf if low else -np.inf)
        pieces = Pieces(*merged, least=low)
        return pieces.select_pieces(
            np.argsort(pieces.values if low else -pieces.values, axis=1, kind="stable")[:, :_MOST_PIECES]
        )

    def first_order_estimate(self, mechanism: Mechanism, dimensions: Array, inner: Values) -> Array:
        """Return the first-order estimate (n,) from values and gradients of the nominal quantity.

        A percentile is estimated from a normal distribution with the same variance. Used to rank many designs.
        """
        assert inner.gradients is not None
        limits = tolerance_limits(mechanism, dimensions)
        steps = inner.gradients[:, :3] * limits
        sign = 1.0 if self.side == "high" else -1.0
        if self.case == "percentile":
            from scipy.special import ndtri

            width = float(ndtri(self.share)) * np.sqrt(
                (steps**2).sum(axis=1) * float(error_distribution(self.shape).var())
            )
        else:
            width = np.abs(steps).sum(axis=1)
        moves = _box_turns_fully(dimensions, limits) if mechanism.lever is None else ~np.isnan(inner.values)
        return np.where(moves, inner.values + sign * width, sign * np.inf)

    # ---- worst case -----------------------------------------------------------------------------------------------

    def _exact_worst_case(
        self, mechanism: Mechanism, dimensions: Array, columns: list[int]
    ) -> tuple[Array, Array, Array]:
        low = self.side == "low"
        at_corners = evaluate_points(self.inner, mechanism, dimensions, box_corners(columns))
        values, slopes, labels = self._values_on_bad_side(at_corners)
        inner_points = worst_inner_points(self.inner, mechanism, dimensions, columns, at_corners, low=low)
        if not len(inner_points.rows):
            return values, slopes, labels
        # Further points in the box where they are worse than the corners; they stay fixed while the design and its box
        # move.
        count = inner_points.points.shape[1]
        at_inner = evaluate_points(self.inner, mechanism, dimensions[inner_points.rows], inner_points.points)
        worse, slope, label = self._values_on_bad_side(at_inner)
        slope[:, :, :3] *= np.repeat(np.abs(inner_points.points) == 1.0, worse.shape[1] // count, axis=1)
        inner_values = np.full((len(values), worse.shape[1]), np.inf if low else -np.inf)
        inner_slopes, inner_labels = np.zeros((*inner_values.shape, slopes.shape[2])), np.zeros(inner_values.shape)
        inner_values[inner_points.rows], inner_slopes[inner_points.rows] = worse, slope
        inner_labels[inner_points.rows] = label + _LABEL_STEP * at_corners.values.shape[1]
        return (
            np.concatenate([values, inner_values], axis=1),
            np.concatenate([slopes, inner_slopes], axis=1),
            np.concatenate([labels, inner_labels], axis=1),
        )

    def _values_on_bad_side(self, point_values: PointValues) -> tuple[Array, Array, Array]:
        """Return values (n, m), gradients and labels at the points: all pieces, or the highest on the low side."""
        labels = point_values.labels + _LABEL_STEP * np.arange(point_values.labels.shape[1])[:, None]
        if self.side == "high":
            n, _, _, width = point_values.gradients.shape
            return (
                point_values.values.reshape(n, -1),
                point_values.gradients.reshape(n, -1, width),
                labels.reshape(n, -1),
            )
        values, slopes = point_values.highest_pieces(point_values.gradients)
        point = np.broadcast_to(_LABEL_STEP * np.arange(values.shape[1]), values.shape)
        # Infinite where friction locks the linkage: nothing is high there.
        return np.where(point_values.turns & (values < np.inf), values, -np.inf), slopes, point

    def _linear_worst_case(
        self, mechanism: Mechanism, dimensions: Array, columns: list[int]
    ) -> tuple[Array, Array, Array]:
        """Return the linear extrapolation of every piece to every corner.

        Directional derivatives are central differences over a small fraction h of the limits. Their error is h^2 times
        the third order, 1/400 of the terms that first order neglects anyway. Their gradients follow from exact
        gradients.
        """
        signs = box_corners(columns)
        point_values = evaluate_points(
            self.inner, mechanism, dimensions, np.concatenate([np.zeros((1, 3)), _STEP * signs])
        )
        values, slopes, has_twin = match_pieces(point_values)
        centre, slope = values[:, :1], slopes[:, :1]
        ahead, opposite = np.s_[:, 1:], np.s_[:, :0:-1]  # opposite corners are in mirrored rows
        on_both_sides = has_twin[ahead] & has_twin[opposite]
        with np.errstate(invalid="ignore"):
            change = (values[ahead] - values[opposite]) / (2.0 * _STEP)
        change_slope = (slopes[ahead] - slopes[opposite]) / (2.0 * _STEP)
        # A peak that vanishes nearby is hardly the highest, so its own slope suffices.
        limits = tolerance_limits(mechanism, dimensions)
        plain = np.einsum("npi,ci->ncp", slope[:, 0, :, :3] * limits[:, None, :], signs)
        values = np.where(np.isfinite(centre), centre + np.where(on_both_sides, change, plain), -np.inf)
        slopes = slope + np.where(on_both_sides[:, :, :, None], change_slope, 0.0)
        labels = point_values.labels[:, :1] + _LABEL_STEP * np.arange(len(signs))[:, None]
        turns_fully = _box_turns_fully(dimensions, limits)
        if mechanism.lever is not None:
            turns_fully = np.asarray(evaluate_points(self.inner, mechanism, dimensions, signs).turns.all(axis=1))
        if self.side == "low":
            values, slopes, labels = values[:, :, :1], slopes[:, :, :1], labels[:, :, :1]  # the highest piece
        values = np.where(turns_fully[:, None, None], values, np.inf if self.side == "high" else -np.inf)
        slopes = np.where(turns_fully[:, None, None, None], slopes, 0.0)
        n, _, _, width = slopes.shape
        return values.reshape(n, -1), slopes.reshape(n, -1, width), labels.reshape(n, -1)

    # ---- percentile -----------------------------------------------------------------------------------------------

    def _quantile(self, mechanism: Mechanism, dimensions: Array, columns: tuple[int, ...]) -> Pieces:
        star_values = evaluate_points(self.inner, mechanism, dimensions, quadratic_fit_points(list(columns)))
        values, slopes, has_twin = match_pieces(star_values)
        has_all_twins: Mask = np.logical_and.reduce(has_twin, axis=1)
        values = np.where(has_all_twins[:, None, :], values, -np.inf)
        # If a peak is absent at some points but matters at others, the maximum over all peaks is taken as one piece.
        top, steepest = star_values.highest_pieces(star_values.gradients)
        greatest: Array = values.max(axis=2, initial=-np.inf)
        lost = np.flatnonzero((greatest < top).any(axis=1))
        values[lost, :, 0], values[lost, :, 1:] = top[lost], -np.inf
        slopes[lost, :, 0] = steepest[lost]
        share = self.share if self.side == "high" else 1.0 - self.share
        drawn = sample(columns, self.shape, self.samples, self.seed, share)
        # Quantities that depend on |offset| have a kink at zero, which machines in the sample may reach.
        widest = np.abs(drawn.deviations[:, 2]).max()
        near_zero = np.abs(dimensions[:, 2]) < widest * tolerance_limits(mechanism, dimensions)[:, 2]
        kinked = near_zero & (2 in columns and not self.inner.smooth_at_zero_offset)
        good = np.isfinite(top).all(axis=1) & ~kinked
        n, _, _, width = slopes.shape
        quantiles, gradients = np.full(n, np.inf if self.side == "high" else -np.inf), np.zeros((n, width))
        quantiles[(top == -np.inf).all(axis=1)] = -np.inf  # a margin that is infinite for all machines
        for rows in _row_blocks(good, len(drawn.deviations) * values.shape[2]):
            quantiles[rows], gradients[rows] = drawn.quantile_from_star_points(values[rows], slopes[rows])
        for rows in _row_blocks(kinked, 32 * len(drawn.deviations)):
            star_values = evaluate_points(self.inner, mechanism, dimensions[rows], drawn.deviations)
            machines, steep = star_values.highest_pieces(star_values.gradients)
            if self.side == "low":
                machines = np.where(star_values.turns & (machines < np.inf), machines, -np.inf)
            quantiles[rows], gradients[rows] = drawn.quantile_of_machines(machines, steep)
        return Pieces(quantiles[:, None], gradients[:, None], np.zeros((n, 1)), least=self.side == "low")


def _row_blocks(rows: Mask, size: int) -> Iterator[IntArray]:
    """Yield the indices of rows in blocks that fit in memory. size: number of values per row."""
    places, step = np.flatnonzero(rows), max(1, _BLOCK // size)
    for begin in range(0, len(places), step):
        yield places[begin : begin + step]


def _merge_parts(
    count: int, parts: list[tuple[IntArray, tuple[Array, Array, Array]]], *, absent: float
) -> tuple[Array, Array, Array]:
    """Return values, gradients and labels for all designs, merged from parts that each hold some of the designs.

    Missing pieces are `absent`.
    """
    if len(parts) == 1:
        return parts[0][1]
    widest = max(values.shape[1] for _, (values, _, _) in parts)
    values, labels = np.full((count, widest), absent), np.zeros((count, widest))
    slopes = np.zeros((count, widest, parts[0][1][1].shape[2]))
    for rows, (part_values, part_slopes, part_labels) in parts:
        values[rows, : part_values.shape[1]], labels[rows, : part_values.shape[1]] = part_values, part_labels
        slopes[rows, : part_values.shape[1]] = part_slopes
    return values, slopes, labels


def require_robust_options_in_range(case: str, order: int, share: float, samples: int, shape: str) -> None:
    """Raise `InputError` for options of a robust quantity that are out of range."""
    require_word("case", case, Case)
    require_word("shape", shape, Shape)
    if order not in (1, 2):
        raise InputError(f"the order of a worst case must be 1 or 2; got {order}")
    if not 0.5 <= share < 1.0:
        raise InputError(f"share must be at least 0.5 and below 1; got {share:g}; 0.99 is 99 of 100 machines")
    if not _LEAST <= samples <= _MOST:
        raise InputError(f"samples must be {_LEAST} to {_MOST}; got {samples}")
    if samples * (1.0 - share) < 10.0 and case == "percentile":
        raise InputError(
            f"samples times 1 - share must be at least 10, so that the tail is known; got {samples} samples for a "
            f"share of {share:g}; raise samples or lower share"
        )


def _box_turns_fully(dimensions: Array, limits: Array) -> Mask:
    crank, rod, offset = dimensions.T[:3]
    return np.asarray((crank > limits[:, 0]) & (rod - crank - np.abs(offset) > limits.sum(axis=1)))
