"""Pieces of formulas: kinks from quantities, min, max and abs, propagated through sums, products and functions.

Every part of a formula is represented from above and from below. From above it is the maximum of smooth pieces; its
concave kinks are frozen at the active piece. From below it is the minimum of smooth pieces; its convex kinks are
frozen. An increasing function preserves the sides; a decreasing one swaps them. From above, for example, the difference
of two peaks is the maximum of the first peak's pieces, minus the second's highest piece. Where nothing is frozen, as in
a sum of peaks, both sides are exact.

The number of pieces depends only on the formula, not on the design, because solvers match pieces between designs. Which
side of an argument a function uses therefore depends only on signs that hold for all designs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import IntArray, Mask
from ..quantity import Array, Pieces
from .expression import BINARY, UNARY, Number, partial_derivatives, weighted_sum_of_gradients

_MOST_PIECES = 8
"""Maximum number of pieces of a part that may tie."""
_LABEL_STEP = 50.0
"""rad, between the labels of the arguments of min and max."""


@dataclass(frozen=True)
class Side:
    """Smooth pieces for one side, active piece first. values, labels, present: (n, k). gradients: (n, k, d)."""

    values: Array
    gradients: Array
    labels: Array
    present: Mask

    @property
    def active_piece(self) -> Side:
        """Only the active piece."""
        return Side(self.values[:, :1], self.gradients[:, :1], self.labels[:, :1], self.present[:, :1])

    def select_pieces(self, places: IntArray) -> Side:
        """Return the pieces at indices (n, m), row by row."""
        return Side(
            np.take_along_axis(self.values, places, axis=1),
            np.take_along_axis(self.gradients, places[:, :, None], axis=1),
            np.take_along_axis(self.labels, places, axis=1),
            np.take_along_axis(self.present, places, axis=1),
        )

    def padded_to_width(self, width: int) -> Side:
        """Return the side padded to `width` with absent pieces."""
        widths = [(0, 0), (0, width - self.values.shape[1])]
        values, labels, present = np.pad(self.values, widths), np.pad(self.labels, widths), np.pad(self.present, widths)
        return Side(values, np.pad(self.gradients, [*widths, (0, 0)]), labels, present)

    def ordered_pieces(self, *, from_above: bool) -> Side:
        """Return the pieces in order, without impossible pieces; the active piece stays first.

        A function that is not increasing all the way between two pieces can lift a piece beyond the active one.
        """
        top = self.values[:, :1]
        with np.errstate(invalid="ignore"):
            right = self.present & ((self.values <= top) if from_above else (self.values >= top))
        right[:, 0] = True
        sort_keys = np.where(right, -self.values if from_above else self.values, np.inf)
        sort_keys[:, 0] = -np.inf
        order = np.argsort(sort_keys, axis=1, kind="stable")[:, :_MOST_PIECES]
        return replace(self, present=right).select_pieces(order)


@dataclass(frozen=True)
class TwoSided:
    """Part of a formula from above and from below; both sides have the same active piece.

    sign: 1 if no design in the problem makes it negative, -1 if none makes it positive, 0 if unknown.
    """

    from_above: Side
    from_below: Side
    sign: int = 0

    def side_seen_by_function(self, slope: Array, known_sign: int, *, from_above: bool) -> Side:
        """Return the side that a function uses, from above or below.

        slope: (n,), derivative of the function with respect to this part. known_sign: sign of the slope if known, else
        0. Designs with the opposite sign are outside their ranges, and keep only their active piece.
        """
        same, swapped = (self.from_above, self.from_below) if from_above else (self.from_below, self.from_above)
        if known_sign:
            side = same if known_sign > 0 else swapped
            return _choose_side(
                known_sign * slope >= 0.0, side, side.active_piece.padded_to_width(side.values.shape[1])
            )
        width = max(same.values.shape[1], swapped.values.shape[1])
        return (
            same
            if width == 1
            else _choose_side(slope >= 0.0, same.padded_to_width(width), swapped.padded_to_width(width))
        )


def pieces_from_above_and_below(pieces: Pieces, factor: float, sign: int) -> TwoSided:
    """Return a quantity's pieces from both sides. factor: label factor, which makes the labels of sums distinct."""
    least = pieces.least
    places = np.argsort(pieces.values if least else -pieces.values, axis=1, kind="stable")
    ordered = pieces.select_pieces(places)
    side = Side(ordered.values, ordered.gradients, factor * ordered.labels, np.isfinite(ordered.values))
    if pieces.opposite is None:
        return TwoSided(side.active_piece, side, sign) if least else TwoSided(side, side.active_piece, sign)
    opposite = pieces_from_above_and_below(pieces.opposite, factor, sign)
    return TwoSided(opposite.from_above, side, sign) if least else TwoSided(side, opposite.from_below, sign)


@dataclass(frozen=True)
class Kinks:
    """An algebra of pieces. leaves: pieces of the names. n, d: number of designs, and of numbers in each design."""

    leaves: Mapping[str, TwoSided]
    n: int
    d: int

    def number(self, number: Number) -> TwoSided:
        """Return a number, the same for all designs."""
        side = single_smooth_piece(np.full(self.n, number.si), np.zeros((self.n, self.d)))
        return TwoSided(side, side, 1 if number.si >= 0.0 else -1)

    def name(self, name: str) -> TwoSided:
        """Return the pieces of a name."""
        return self.leaves[name]

    def call(self, function: str, arguments: list[TwoSided]) -> TwoSided:
        """Return a function from the pieces of its arguments."""
        if function == "abs":
            return replace(_extreme_of_parts("max", [arguments[0], self.call("neg", arguments)]), sign=1)
        if function in ("min", "max"):
            return _extreme_of_parts(function, arguments)
        active_values = [item.from_above.values[:, 0] for item in arguments]
        slopes = partial_derivatives(function, active_values, _apply_function(function, active_values))
        signs, sign = _signs_of_slopes_and_value(function, arguments)
        sides = []
        for from_above in (True, False):
            argument_sides = [
                item.side_seen_by_function(slope, up, from_above=from_above)
                for item, slope, up in zip(arguments, slopes, signs, strict=True)
            ]
            sides.append(_combine_pieces(function, argument_sides).ordered_pieces(from_above=from_above))
        return TwoSided(sides[0], sides[1], sign)


def single_smooth_piece(values: Array, gradients: Array) -> Side:
    """Return a single smooth piece (n,) with its gradients (n, d)."""
    return Side(values[:, None], gradients[:, None], np.zeros((len(values), 1)), np.ones((len(values), 1), np.bool_))


def pieces_of_formula(formula: TwoSided) -> Pieces:
    """Return a formula as the maximum of its pieces, plus its other side if it has both kinds of kinks."""
    from_above, from_below = (
        Pieces(np.where(side.present, side.values, absent), side.gradients, side.labels, absent > 0.0)
        for side, absent in ((formula.from_above, -np.inf), (formula.from_below, np.inf))
    )
    for item, side in ((from_above, formula.from_above), (from_below, formula.from_below)):
        item.values[:, 0] = side.values[:, 0]  # infinite where friction locks the linkage, NaN where undefined
    if from_below.values.shape[1] == 1:
        return from_above
    return Pieces(from_above.values, from_above.gradients, from_above.labels, opposite=from_below)


_RISING = {
    "+": (1, 1),
    "-": (1, -1),
    "neg": (-1,),
    "sqrt": (1,),
    "asin": (1,),
    "acos": (-1,),
    "atan": (1,),
    "tan": (1,),
}
"""Signs of the slopes of functions that are monotone everywhere."""


def _signs_of_slopes_and_value(function: str, arguments: list[TwoSided]) -> tuple[tuple[int, ...], int]:
    """Return the known signs of a function's slopes by its arguments, and the known sign of its value."""
    first, last = arguments[0].sign, arguments[-1].sign
    if function == "*":
        return (last, first), first * last
    if function == "/":
        return (last, -first), first * last
    if function == "**":
        return ((last if first > 0 else 0), 0), max(first, 0)
    values = {"neg": -first, "+": first if first == last else 0, "sqrt": 1, "acos": 1, "asin": first, "atan": first}
    return _RISING.get(function, (0,)), values.get(function, 0)


def _apply_function(function: str, arguments: list[Array]) -> Array:
    return UNARY[function][0](arguments[0]) if function in UNARY else BINARY[function][0](arguments[0], arguments[1])


def _combine_pieces(function: str, sides: list[Side]) -> Side:
    """Return a smooth function for every combination of one argument's pieces with the other's."""
    if len(sides) == 1:
        (first,) = sides
        values = _apply_function(function, [first.values])
        return Side(
            values,
            weighted_sum_of_gradients(partial_derivatives(function, [first.values], values), [first.gradients]),
            first.labels,
            first.present,
        )
    first, second = sides
    (n, p), (_, q), d = first.values.shape, second.values.shape, first.gradients.shape[2]
    places, second_places = np.repeat(np.arange(p), q), np.tile(np.arange(q), p)
    part_values = [first.values[:, places], second.values[:, second_places]]
    values = _apply_function(function, part_values)
    slopes = partial_derivatives(function, part_values, values)
    gradients = weighted_sum_of_gradients(slopes, [first.gradients[:, places], second.gradients[:, second_places]])
    assert gradients.shape == (n, p * q, d)
    return Side(
        values,
        gradients,
        first.labels[:, places] + second.labels[:, second_places],
        first.present[:, places] & second.present[:, second_places],
    )


def _extreme_of_parts(function: str, arguments: list[TwoSided]) -> TwoSided:
    """Return the minimum or maximum of parts: all pieces on one side, the active part's pieces on the other."""
    greatest = function == "max"
    wide = [item.from_above if greatest else item.from_below for item in arguments]
    wide = [Side(s.values, s.gradients, s.labels + _LABEL_STEP * place, s.present) for place, s in enumerate(wide)]
    tops = np.stack([item.values[:, 0] for item in wide])
    first = (np.argmax if greatest else np.argmin)(tops, axis=0)
    width = max(item.values.shape[1] for item in wide)
    all_of = [item.padded_to_width(width) for item in wide]
    together = Side(*(np.concatenate([getattr(s, f) for s in all_of], axis=1) for f in Side.__dataclass_fields__))
    places = np.argsort(np.arange(together.values.shape[1]) != (first * width)[:, None], axis=1, kind="stable")
    together = together.select_pieces(places).ordered_pieces(from_above=greatest)
    narrow_sides = [item.from_below if greatest else item.from_above for item in arguments]
    width = max(item.values.shape[1] for item in narrow_sides)
    narrow = narrow_sides[0].padded_to_width(width)
    for place, item in enumerate(narrow_sides[1:], start=1):
        narrow = _choose_side(first == place, item.padded_to_width(width), narrow)
    signs = {item.sign for item in arguments}
    sign = (
        1 if greatest and 1 in signs else -1 if not greatest and -1 in signs else signs.pop() if len(signs) == 1 else 0
    )
    return TwoSided(together, narrow, sign) if greatest else TwoSided(narrow, together, sign)


def _choose_side(rows: Mask, chosen: Side, alternative: Side) -> Side:
    """Return the chosen side in the marked `rows` (n,), the alternative elsewhere."""
    column = rows[:, None]
    return Side(
        np.where(column, chosen.values, alternative.values),
        np.where(column[:, :, None], chosen.gradients, alternative.gradients),
        np.where(column, chosen.labels, alternative.labels),
        np.where(column, chosen.present, alternative.present),
    )
