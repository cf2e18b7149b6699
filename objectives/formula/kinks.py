"""Pieces of formulas: kinks of quantities, of min, max and abs, passed on through sums, products and functions.

Every part of a formula is seen from both sides. From above it is the greatest of smooth pieces, its concave kinks held
at the piece that is active; from below the least of smooth pieces, its convex kinks held. A function that rises with
its argument keeps the sides, one that falls swaps them: the difference of two peaks is from above the greatest of the
first peak's pieces less the second's highest one. Where nothing is held, as in a sum of peaks, both are exact.

How many pieces there are follows from the formula alone, whatever the designs: solvers match the rows of two designs.
So the side that a function sees follows from signs that are known for all designs, where any are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Mask, Whole
from ..quantity import Array, Pieces
from .expression import Number
from .slopes import BINARY, UNARY, partials, sum_of

_KEPT = 8
"""Pieces of a part that may tie."""
_APART = 50.0
"""rad, between the labels of the arguments of min and max."""


@dataclass(frozen=True)
class Side:
    """Smooth pieces of one side, the active one first. values, labels, there: (n, k). gradients: (n, k, d)."""

    values: Array
    gradients: Array
    labels: Array
    there: Mask

    @property
    def first(self) -> Side:
        """The active piece alone."""
        return Side(self.values[:, :1], self.gradients[:, :1], self.labels[:, :1], self.there[:, :1])

    def at(self, places: Whole) -> Side:
        """Return the pieces at some places (n, m) of each design."""
        return Side(
            np.take_along_axis(self.values, places, axis=1),
            np.take_along_axis(self.gradients, places[:, :, None], axis=1),
            np.take_along_axis(self.labels, places, axis=1),
            np.take_along_axis(self.there, places, axis=1),
        )

    def padded(self, width: int) -> Side:
        """Return the side with places for more pieces, which are not there."""
        room = [(0, 0), (0, width - self.values.shape[1])]
        values, labels, there = np.pad(self.values, room), np.pad(self.labels, room), np.pad(self.there, room)
        return Side(values, np.pad(self.gradients, [*room, (0, 0)]), labels, there)

    def ordered(self, *, above: bool) -> Side:
        """Return the pieces in their order, those that cannot be right left out; the active one stays the first.

        A piece beyond the active one comes of a function that does not rise all the way from one to the other.
        """
        top = self.values[:, :1]
        with np.errstate(invalid="ignore"):
            right = self.there & ((self.values <= top) if above else (self.values >= top))
        right[:, 0] = True
        worth = np.where(right, -self.values if above else self.values, np.inf)
        worth[:, 0] = -np.inf
        order = np.argsort(worth, axis=1, kind="stable")[:, :_KEPT]
        return replace(self, there=right).at(order)


@dataclass(frozen=True)
class Both:
    """A part of a formula from above and from below; both have the same active piece.

    sign: 1 where no design of the problem makes it negative, -1 where none makes it positive, 0 where nothing is known.
    """

    above: Side
    below: Side
    sign: int = 0

    def on(self, slope: Array, known: int, *, above: bool) -> Side:
        """Return the side that a function sees from above or below.

        slope: (n,), of the function by this part. known: its sign if that is known; designs that differ from it, which
        are out of their ranges, have their active piece alone.
        """
        same, swapped = (self.above, self.below) if above else (self.below, self.above)
        if known:
            seen = same if known > 0 else swapped
            return _either(known * slope >= 0.0, seen, seen.first.padded(seen.values.shape[1]))
        width = max(same.values.shape[1], swapped.values.shape[1])
        return same if width == 1 else _either(slope >= 0.0, same.padded(width), swapped.padded(width))


def both_of(pieces: Pieces, factor: float, sign: int) -> Both:
    """Return a quantity's pieces from both sides. factor: of labels, so that sums tell the pieces of parts apart."""
    least = pieces.least
    places = np.argsort(pieces.values if least else -pieces.values, axis=1, kind="stable")
    known = pieces.at(places)
    own = Side(known.values, known.gradients, factor * known.labels, np.isfinite(known.values))
    if pieces.other is None:
        return Both(own.first, own, sign) if least else Both(own, own.first, sign)
    more = both_of(pieces.other, factor, sign)
    return Both(more.above, own, sign) if least else Both(own, more.below, sign)


@dataclass(frozen=True)
class Kinks:
    """An algebra of pieces. leaves: what the names mean. n, d: designs and numbers of each."""

    leaves: Mapping[str, Both]
    n: int
    d: int

    def number(self, number: Number) -> Both:
        """Return a number, the same for all designs."""
        one = smooth(np.full(self.n, number.si), np.zeros((self.n, self.d)))
        return Both(one, one, 1 if number.si >= 0.0 else -1)

    def name(self, name: str) -> Both:
        """Return the pieces of a name."""
        return self.leaves[name]

    def call(self, function: str, arguments: list[Both]) -> Both:
        """Return a function of its arguments."""
        if function == "abs":
            return replace(_extreme("max", [arguments[0], self.call("neg", arguments)]), sign=1)
        if function in ("min", "max"):
            return _extreme(function, arguments)
        given = [item.above.values[:, 0] for item in arguments]
        slopes = partials(function, given, _values(function, given))
        signs, sign = _signs(function, arguments)
        sides = []
        for above in (True, False):
            own = [item.on(slope, up, above=above) for item, slope, up in zip(arguments, slopes, signs, strict=True)]
            sides.append(_combined(function, own).ordered(above=above))
        return Both(sides[0], sides[1], sign)


def smooth(values: Array, gradients: Array) -> Side:
    """Return one smooth piece (n,) with its gradients (n, d)."""
    return Side(values[:, None], gradients[:, None], np.zeros((len(values), 1)), np.ones((len(values), 1), np.bool_))


def pieces_of(both: Both) -> Pieces:
    """Return a formula as the greatest of its pieces, with its other side where it has kinks of both kinds."""
    above, below = (
        Pieces(np.where(side.there, side.values, absent), side.gradients, side.labels, absent > 0.0)
        for side, absent in ((both.above, -np.inf), (both.below, np.inf))
    )
    for item, side in ((above, both.above), (below, both.below)):
        item.values[:, 0] = side.values[:, 0]  # infinite where friction locks, no number where it is not defined
    if below.values.shape[1] == 1:
        return above
    return Pieces(above.values, above.gradients, above.labels, other=below)


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
"""Signs of the slopes of functions that rise or fall everywhere."""


def _signs(function: str, arguments: list[Both]) -> tuple[tuple[int, ...], int]:
    """Return the known signs of a function's slopes by its arguments, and of its value."""
    one, other = arguments[0].sign, arguments[-1].sign
    if function == "*":
        return (other, one), one * other
    if function == "/":
        return (other, -one), one * other
    if function == "**":
        return ((other if one > 0 else 0), 0), max(one, 0)
    values = {"neg": -one, "+": one if one == other else 0, "sqrt": 1, "acos": 1, "asin": one, "atan": one}
    return _RISING.get(function, (0,)), values.get(function, 0)


def _values(function: str, given: list[Array]) -> Array:
    return UNARY[function][0](given[0]) if function in UNARY else BINARY[function][0](given[0], given[1])


def _combined(function: str, sides: list[Side]) -> Side:
    """Return a smooth function of every piece of one argument with every piece of the other."""
    if len(sides) == 1:
        (one,) = sides
        values = _values(function, [one.values])
        return Side(values, sum_of(partials(function, [one.values], values), [one.gradients]), one.labels, one.there)
    one, other = sides
    (n, p), (_, q), d = one.values.shape, other.values.shape, one.gradients.shape[2]
    places, others = np.repeat(np.arange(p), q), np.tile(np.arange(q), p)
    given = [one.values[:, places], other.values[:, others]]
    values = _values(function, given)
    slopes = partials(function, given, values)
    gradients = sum_of(slopes, [one.gradients[:, places], other.gradients[:, others]])
    assert gradients.shape == (n, p * q, d)
    return Side(
        values,
        gradients,
        one.labels[:, places] + other.labels[:, others],
        one.there[:, places] & other.there[:, others],
    )


def _extreme(function: str, arguments: list[Both]) -> Both:
    """Return the least or the greatest of parts: all pieces on one side, those of the active on the other."""
    greatest = function == "max"
    wide = [item.above if greatest else item.below for item in arguments]
    wide = [Side(s.values, s.gradients, s.labels + _APART * place, s.there) for place, s in enumerate(wide)]
    tops = np.stack([item.values[:, 0] for item in wide])
    first = (np.argmax if greatest else np.argmin)(tops, axis=0)
    width = max(item.values.shape[1] for item in wide)
    all_of = [item.padded(width) for item in wide]
    together = Side(*(np.concatenate([getattr(s, f) for s in all_of], axis=1) for f in Side.__dataclass_fields__))
    places = np.argsort(np.arange(together.values.shape[1]) != (first * width)[:, None], axis=1, kind="stable")
    together = together.at(places).ordered(above=greatest)
    held = [item.below if greatest else item.above for item in arguments]
    width = max(item.values.shape[1] for item in held)
    narrow = held[0].padded(width)
    for place, item in enumerate(held[1:], start=1):
        narrow = _either(first == place, item.padded(width), narrow)
    signs = {item.sign for item in arguments}
    sign = (
        1 if greatest and 1 in signs else -1 if not greatest and -1 in signs else signs.pop() if len(signs) == 1 else 0
    )
    return Both(together, narrow, sign) if greatest else Both(narrow, together, sign)


def _either(rows: Mask, one: Side, other: Side) -> Side:
    """Return one side where `rows` (n,) says so, another one elsewhere."""
    at = rows[:, None]
    return Side(
        np.where(at, one.values, other.values),
        np.where(at[:, :, None], one.gradients, other.gradients),
        np.where(at, one.labels, other.labels),
        np.where(at, one.there, other.there),
    )
