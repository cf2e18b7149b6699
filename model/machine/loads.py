"""Loads on the slider, along its line. Forces are positive outward (away from the crank pivot); several add up.

Where a load depends on the slider position, the position is counted from a `Datum`:
the crank pivot (distance along the slider line), the inner dead centre (outward), or the outer dead centre (inward).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from ..errors import InputError

Datum = Literal["crank pivot", "inner dead centre", "outer dead centre"]
During = Literal["cycle", "outward stroke", "inward stroke"]


def _finite(owner: object, *names: str) -> None:
    for name in names:
        value = getattr(owner, name)
        if not math.isfinite(value):
            raise InputError(f"{name} of a {type(owner).__name__} must be finite; got {value}")


def require_word(name: str, value: object, words: object) -> None:
    """Refuse a value that is none of the words of a `Literal`."""
    if value not in get_args(words):
        raise InputError(f"{name} must be {' or '.join(map(repr, get_args(words)))}; got {value!r}")


def _table(what: str, at: Sequence[float], forces: Sequence[float]) -> None:
    if len(at) != len(forces) or len(at) < 2:
        raise InputError(
            f"a table needs as many forces as {what}, two at least; got {len(at)} {what} and {len(forces)} forces"
        )
    if not all(math.isfinite(value) for value in (*at, *forces)):
        raise InputError(f"a table of {what} and forces must be finite throughout")
    for before, after in itertools.pairwise(at):
        if after <= before:
            raise InputError(f"{what} of a table must increase; got {after:g} after {before:g}; sort the table")


@dataclass(frozen=True, kw_only=True)
class StrokeForce:
    """A force that is constant within each stroke, N, positive outward.

    Equal values make a constant force; `outward=-F, inward=0` resists the outward stroke only;
    `outward=-F, inward=F` always opposes the motion (Coulomb, of given size).
    """

    outward: float
    inward: float

    def __post_init__(self) -> None:
        _finite(self, "outward", "inward")


@dataclass(frozen=True, kw_only=True)
class Spring:
    """A linear spring: force = -stiffness (position - free_position), N, position counted outward from the datum.

    stiffness: N/m. free_position: m. datum: a dead centre moves with the design. From the outer dead centre the
    position counts inward and so does the force that pulls it back: the spring is the same, only its rest point moves.
    """

    stiffness: float
    free_position: float = 0.0
    datum: Datum = "crank pivot"

    def __post_init__(self) -> None:
        _finite(self, "stiffness", "free_position")
        require_word("datum", self.datum, Datum)


@dataclass(frozen=True, kw_only=True)
class Viscous:
    """A viscous resistance: force = -coefficient velocity. coefficient: N s/m."""

    coefficient: float

    def __post_init__(self) -> None:
        _finite(self, "coefficient")


@dataclass(frozen=True, kw_only=True)
class PositionTable:
    """A force tabulated over slider position, interpolated linearly, constant beyond the ends of the table.

    positions: increasing, m, from the datum. forces: N, positive outward. during: the force acts in these strokes.
    """

    positions: tuple[float, ...]
    forces: tuple[float, ...]
    datum: Datum = "crank pivot"
    during: During = "cycle"

    def __post_init__(self) -> None:
        _table("positions", self.positions, self.forces)
        require_word("datum", self.datum, Datum)
        require_word("during", self.during, During)


@dataclass(frozen=True, kw_only=True)
class AngleTable:
    """A force tabulated over crank angle, interpolated linearly and periodically.

    angles: increasing, rad, spanning less than one turn (the first point follows the last one a turn later).
    forces: N, positive outward. during: the force acts in these strokes.
    """

    angles: tuple[float, ...]
    forces: tuple[float, ...]
    during: During = "cycle"

    def __post_init__(self) -> None:
        _table("angles", self.angles, self.forces)
        require_word("during", self.during, During)
        span = self.angles[-1] - self.angles[0]
        if span >= 2.0 * math.pi:
            raise InputError(
                f"angles of a periodic table must span less than 360 deg; got {math.degrees(span):g} deg; "
                "leave out the last point, which repeats the first"
            )


Load = StrokeForce | Spring | Viscous | PositionTable | AngleTable
