"""A quantity and its facts: everything asked about a number that is an objective or stands in a constraint."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from dataclasses import field as _field
from enum import Enum
from typing import Any, ClassVar, Literal

import numpy as np

from ..model.arrays import Array as Array
from ..model.arrays import Whole
from ..model.machine.mechanism import Mechanism
from .bounds import QuantityBounds
from .kinds import DisplayUnit, Kind
from .needs import Consequence, Need

Better = Literal["low", "high", ""]
Offer = Literal["motion", "proportions", "requirement", "objective"]
"""Parts of a form that ask for a quantity unasked: the wanted motion, rules of proportion, what must hold, what is
wanted."""
Number = Callable[[int], Any]
"""The raw number of a machine at a slot (`Raw`, `PINS`): of each design (n,), one for all, or enclosed over boxes."""
Formula = Callable[[Number], Any]
MECHANICS = "derived there from plane rigid-body mechanics"


class Group(Enum):
    """Groups in which quantities are shown, in their order."""

    DIMENSIONS = "Dimensions"
    MOTION = "Motion"
    PROPORTIONS = "Transmission and proportions"
    DRIVE = "Drive"
    FORCES = "Forces"
    STRENGTH = "Strength and mass"
    ACCURACY = "Accuracy"
    FURTHER = "Further quantities"


@dataclass(frozen=True, kw_only=True)
class Domain:
    """The values of a quantity that some linkage has: from lower to upper, SI.

    open: whether the ends are excluded. idle: whether a least value below the domain is let pass, as it asks nothing.
    rule, remedy: in words, for a message.
    """

    lower: float
    upper: float = math.inf
    open: bool = True
    idle: bool = False
    rule: str
    remedy: str

    @classmethod
    def share(cls, subject: str, usual: str) -> Domain:
        """Return the domain of a share, 0 to 1."""
        return cls(
            upper=1.0, lower=0.0, open=False, rule=f"{subject} lies between 0 and 1", remedy=f"{usual} are usual"
        )

    @classmethod
    def acute(cls, rule: str, usual: str) -> Domain:
        """Return the domain of an acute angle; within: what lies between 0 and 90 deg, in words."""
        remedy = f"{usual} are usual (a plain number is in rad)"
        return cls(lower=0.0, upper=0.5 * math.pi, rule=f"{rule}, ends excluded", remedy=remedy)

    def refuses(self, value: float, *, least: bool) -> bool:
        """Return whether no linkage has a value. least: whether the value is a lower bound.

        A least value at the lower end has no effect, except that it switches off the floor of a quantity with one.
        """
        if least and (self.idle or value == self.lower):
            return False
        return not (self.lower < value < self.upper or (not self.open and value in (self.lower, self.upper)))


@dataclass(frozen=True)
class Values:
    """A quantity of n designs.

    values: (n,), SI. gradients: (n, 3 + k), by crank, rod, offset and the machine's varying
    numbers; None unless asked for.
    """

    values: Array
    gradients: Array | None

    def times(self, factor: Values) -> Values:
        """Return the product of two quantities of the same designs."""
        slopes = None
        if self.gradients is not None and factor.gradients is not None:
            slopes = self.gradients * factor.values[:, None] + self.values[:, None] * factor.gradients
        return Values(self.values * factor.values, slopes)


def undefined(designs: Array, gradients: bool) -> Values:
    """Return no numbers for designs (n, 3 + k), NaN throughout."""
    blank = np.full(np.shape(designs), np.nan)
    return Values(blank[:, 0], blank if gradients else None)


@dataclass(frozen=True)
class Pieces:
    """A quantity as the greatest of smooth pieces: the local peaks of a curve over the cycle, highest first.

    values: (n, k), SI, -inf where a design has fewer than k pieces. gradients: (n, k, 3 + v) for v varying numbers.
    labels: (n, k), what tells the pieces of neighbouring designs apart: the crank angle of a peak, rad, or a number.
    A tie between two pieces is a kink of the quantity; a solver treats it as a minimax.
    least: the quantity is the least of its pieces instead, lowest first, +inf for absent ones. opposite: of a quantity
    with kinks of both kinds, the same from the other side; each side holds the kinks of the other one at the piece that
    is active.
    """

    values: Array
    gradients: Array
    labels: Array
    least: bool = False
    opposite: Pieces | None = None

    def take(self, places: Whole) -> Pieces:
        """Return the pieces at some places (n, m) of each design."""
        return Pieces(
            np.take_along_axis(self.values, places, axis=1),
            np.take_along_axis(self.gradients, places[:, :, None], axis=1),
            np.take_along_axis(self.labels, places, axis=1),
            self.least,
        )


def fact(default: Any) -> Any:
    """Return a fact that is told, not computed with: quantities that differ in it alone compute the same."""
    return _field(default=default, compare=False)


@dataclass(frozen=True, kw_only=True)
class Quantity(ABC):
    """A number that judges a design: its facts, and its values and gradients for a batch of designs.

    name: in job files. title: for people, the name in words if left out. kind: of value, with its units. key: how its
    column begins, the name if left out. short: title where room is scarce, the title if left out. place: in tables,
    lower first.

    group: that it is shown in. sentence: of the help, for an engineer who meets it first. advice: what is usual, or
    what it trades against. formula: in plain text, its symbols those of docs/theory.md. section: of docs/theory.md.
    source: of the equations. picture: what a picture of the linkage points out.

    example: a usual value as job files have it, that of the kind if left out. better: its good side, low or high, on
    which a requirement or an objective usually asks for it; empty for one without. signed: whether it may be negative.
    instead_of_quotient: the quantity to use where a formula would divide by it. domain: values that some linkage has.
    floor: least value that holds where a job sets none, SI. in_line: its value for every design without offset.
    endless: why it may be infinite for every design, as a sentence. needs: of the machine. instead: quantities that
    serve where a need is not met. reach: bounds within ranges of the dimensions. allowed_by: what sets its allowable
    value, in words; empty for one without. about_tolerances: whether it includes tolerances already. offered: parts of
    a form that ask for it. on_sheet: whether the sheet of a design has it. plain: whether it follows from others at a
    glance, so that a short table leaves it out. turning: whether it needs a crank that rotates fully, so that a swing
    has none.
    """

    name: str
    title: str = fact("")
    kind: Kind
    key: str = fact("")
    short: str = fact("")
    place: int = fact(1000)
    group: Group = fact(Group.FURTHER)
    sentence: str = fact("")
    advice: str = fact("")
    formula: str = fact("")
    section: str = fact("")
    source: str = fact(MECHANICS)
    picture: str = fact("")
    example: str | float | None = fact(None)
    better: Better = fact("low")
    signed: bool = fact(False)
    instead_of_quotient: str = fact("")
    domain: Domain | None = fact(None)
    floor: float | None = fact(None)
    in_line: float | None = fact(None)
    endless: str = fact("")
    needs: tuple[Need, ...] = fact(())
    instead: str = fact("")
    bounds: QuantityBounds | None = fact(None)
    allowed_by: str = fact("")
    about_tolerances: bool = fact(False)
    offered: tuple[Offer, ...] = fact(())
    on_sheet: bool = fact(False)
    plain: bool = fact(False)
    turning: bool = fact(True)
    table: ClassVar[str] = ""
    """Table of a job without which there is no such quantity; none for one that every problem has."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "title", self.title or self.name.replace("_", " "))

    @property
    def stem(self) -> str:
        """Its column without the unit."""
        return self.key or self.name

    @property
    def field(self) -> str:
        """Key in tables and JSON, carrying the unit: "stroke_mm"."""
        return self.stem + self.kind.metric.suffix

    @property
    def unit(self) -> DisplayUnit:
        """Unit in tables, JSON and figures."""
        return self.kind.metric

    @property
    def short_title(self) -> str:
        """Title where room is scarce."""
        return self.short or self.title

    @property
    def usual(self) -> str | float:
        """A usual value as job files have it."""
        if self.example is not None:
            return self.example
        return self.kind.example if self.kind.unit else float(self.kind.example)

    @property
    def has_gradient(self) -> bool:
        """Whether it has derivatives by the dimensions."""
        return True

    @property
    def constant(self) -> bool:
        """Whether it is the same for every design of one machine."""
        return False

    @property
    def of_dimensions(self) -> bool:
        """Whether it follows from crank, rod and offset alone, without a search over the cycle."""
        return False

    def follows_speed(self, mechanism: Mechanism) -> bool:
        """Return whether the crank speed, its sense, or that there is one, changes the quantity of a machine."""
        numbers = [item.fullest for item in mechanism.varying]
        designs = np.array([[0.05, 0.2, offset, *numbers] for offset in (0.02, -0.02)])
        still, *moving = (
            self.evaluate(replace(mechanism, speed=speed), designs).values for speed in (0.0, 1.0, -1.0, 1000.0)
        )
        return not all(np.allclose(still, values, rtol=1e-9, atol=0.0, equal_nan=True) for values in moving)

    def bounds_for(self, mechanism: Mechanism) -> QuantityBounds | None:
        """Return its reach if it holds for the machine."""
        return self.bounds

    def allowable(self, mechanism: Mechanism) -> float:
        """Return the greatest value that a machine withstands, the least if high is better, SI; see `allowed_by`."""
        raise NotImplementedError(f"{self.name} has no allowable value")

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return formulas of raw numbers, of which it is the greatest, for bounds over ranges; none without."""
        return ()

    @property
    def made_of(self) -> tuple[Quantity, ...]:
        """The quantities that it is computed from, if it is made of others."""
        return ()

    def with_parts(self, parts: tuple[Quantity, ...]) -> Quantity:
        """Return the same made of other parts, in the order of `made_of`."""
        return self

    def lacks(self, mechanism: Mechanism, consequence: Consequence) -> str | None:
        """Return rule, value and remedy for the first unmet need of a machine; None if there is none.

        consequence: what becomes of the quantity: "undefined", "equal" to another one, or "zero" for every design.
        """
        for need in self.needs:
            if need.consequence == consequence and not need.is_met(mechanism):
                return need.missing.replace("{instead}", self.instead)
        return None

    @property
    def blank(self) -> str:
        """Why a design may have none though the machine defines it."""
        needs = (need for need in self.needs if need.consequence == "undefined")
        return next((need.missing for need in needs), "it has no value for this design")

    def undefined_because(self, machines: Iterable[Mechanism]) -> str | None:
        """Return rule, value and remedy where one of the machines does not define the quantity; None if all do.

        Nor is it defined where it only equals another quantity.
        """
        reasons = (self.lacks(m, "undefined") or self.lacks(m, "equal") for m in machines)
        return next(filter(None, reasons), None)

    def zero_because(self, machines: Iterable[Mechanism]) -> str | None:
        """Return rule, value and remedy where the quantity is zero for all designs and machines; None otherwise."""
        reasons = [self.lacks(machine, "zero") for machine in machines]
        return reasons[0] if all(reasons) else None

    @abstractmethod
    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k), each turning fully.

        Columns: crank, rod, offset, m, then the value of each of the machine's varying numbers, SI.
        """

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the greatest of smooth pieces: as its only one, unless its class has several."""
        evaluation = self.evaluate(mechanism, dimensions, gradients=True)
        assert evaluation.gradients is not None
        return Pieces(evaluation.values[:, None], evaluation.gradients[:, None], np.zeros((len(evaluation.values), 1)))
