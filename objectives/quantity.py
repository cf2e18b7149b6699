"""A quantity and its facts: all properties of a number that serves as an objective or in a constraint."""

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
from ..model.arrays import IntArray
from ..model.machine.mechanism import Mechanism
from .bounds_over_ranges import QuantityBounds
from .kinds import DisplayUnit, Kind
from .machine_needs import Consequence, Need

Better = Literal["low", "high", ""]
Offer = Literal["motion", "proportions", "requirement", "objective"]
"""Parts of a form that always ask for a quantity: the target motion, rules of proportion, requirements, objectives."""
Number = Callable[[int], Any]
"""Raw number of a machine at a slot (`Raw`, `PINS`): for each design (n,), one for all, or an enclosure over boxes."""
Formula = Callable[[Number], Any]
MECHANICS = "derived there from plane rigid-body mechanics"


class Group(Enum):
    """Groups in which quantities are shown, in order."""

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
    """Values that a quantity can have in some linkage: from lower to upper, SI.

    open: whether the ends are excluded. idle: whether a lower bound below the domain is accepted, because it has no
    effect. rule, remedy: parts of a message.
    """

    lower: float
    upper: float = math.inf
    open: bool = True
    idle: bool = False
    rule: str
    remedy: str

    @classmethod
    def of_fraction(cls, subject: str, usual: str) -> Domain:
        """Return the domain for a fraction, 0 to 1."""
        return cls(
            upper=1.0, lower=0.0, open=False, rule=f"{subject} must lie between 0 and 1", remedy=f"{usual} are usual"
        )

    @classmethod
    def of_acute_angle(cls, rule: str, usual: str) -> Domain:
        """Return the domain for an acute angle, 0 to 90 deg. rule: the rule in words."""
        remedy = f"{usual} are usual (a plain number is in rad)"
        return cls(lower=0.0, upper=0.5 * math.pi, rule=f"{rule}, ends excluded", remedy=remedy)

    def refuses_bound(self, value: float, *, least: bool) -> bool:
        """Return whether no linkage can have a value. least: whether the value is a lower bound.

        A lower bound at the lower end has no effect, except that it disables the quantity's floor if there is one.
        """
        if least and (self.idle or value == self.lower):
            return False
        return not (self.lower < value < self.upper or (not self.open and value in (self.lower, self.upper)))


@dataclass(frozen=True)
class Values:
    """Values of a quantity for n designs.

    values: (n,), SI. gradients: (n, 3 + k), by crank, rod, offset and the machine's variables; None unless requested.
    """

    values: Array
    gradients: Array | None

    def multiplied_by(self, factor: Values) -> Values:
        """Return the product of two quantities for the same designs."""
        slopes = None
        if self.gradients is not None and factor.gradients is not None:
            slopes = self.gradients * factor.values[:, None] + self.values[:, None] * factor.gradients
        return Values(self.values * factor.values, slopes)


def undefined_values(designs: Array, gradients: bool) -> Values:
    """Return NaN for designs (n, 3 + k), in both values and gradients."""
    blank = np.full(np.shape(designs), np.nan)
    return Values(blank[:, 0], blank if gradients else None)


@dataclass(frozen=True)
class Pieces:
    """A quantity as the maximum of smooth pieces: the local peaks of a curve over the cycle, highest first.

    values: (n, k), SI, -inf where a design has fewer than k pieces. gradients: (n, k, 3 + v) for v variables. labels:
    (n, k), labels that match pieces between neighbouring designs: the crank angle of a peak, rad, or a number. A tie
    between two pieces is a kink in the quantity; a solver treats it as a minimax. least: whether the quantity is the
    minimum of its pieces instead, lowest first, +inf for absent ones. opposite: for a quantity with kinks of both
    kinds, its pieces from the other side. Each side freezes the kinks of the other one at the active piece.
    """

    values: Array
    gradients: Array
    labels: Array
    least: bool = False
    opposite: Pieces | None = None

    def select_pieces(self, places: IntArray) -> Pieces:
        """Return the pieces at indices (n, m), row by row."""
        return Pieces(
            np.take_along_axis(self.values, places, axis=1),
            np.take_along_axis(self.gradients, places[:, :, None], axis=1),
            np.take_along_axis(self.labels, places, axis=1),
            self.least,
        )


def display_only_field(default: Any) -> Any:
    """Return a display-only fact: quantities that differ only in such facts compute the same values."""
    return _field(default=default, compare=False)


@dataclass(frozen=True, kw_only=True)
class Quantity(ABC):
    """A number that judges a design: its facts, and its values and gradients for a batch of designs.

    name: name in job files. title: title for readers, by default the name in words. kind: kind of its values, with
    units. key: first part of its column name, by default the name. short: title for small spaces, by default the title.
    place: rank in tables, lower first.

    group: group in which it is shown. sentence: explanation for an engineer new to it. advice: usual values, or
    conflicting quantities. formula: formula in plain text, with the symbols of docs/theory.md. section: section of
    docs/theory.md. source: source of the equations. picture: the feature highlighted in a picture of the linkage.

    example: a usual value as in job files, by default that of the kind. better: the preferred direction, low or high,
    in requirements and objectives; empty if there is none. signed: whether it may be negative. instead_of_quotient: the
    quantity to use where a formula would divide by it. domain: values that it can have in some linkage. floor: minimum
    if a job sets none, SI. in_line: its value for every design without offset. endless: reason why it may be infinite
    for every design, as a sentence. needs: needs that a machine must meet. instead: quantities to use if a need is not
    met. reach: bounds within ranges of the dimensions. allowed_by: origin of its allowable value, in words; empty if
    there is none. about_tolerances: whether it already includes tolerances. offered: parts of a form that offer it.
    on_datasheet: whether the datasheet of a design shows it. plain: whether it follows obviously from others, so that a
    short table omits it. turning: whether it needs a fully rotating crank, so that a swing does not have it.
    smooth_at_zero_offset: whether it has no kink where the offset changes its sign.
    """

    name: str
    title: str = display_only_field("")
    kind: Kind
    key: str = display_only_field("")
    short: str = display_only_field("")
    place: int = display_only_field(1000)
    group: Group = display_only_field(Group.FURTHER)
    sentence: str = display_only_field("")
    advice: str = display_only_field("")
    formula: str = display_only_field("")
    section: str = display_only_field("")
    source: str = display_only_field(MECHANICS)
    picture: str = display_only_field("")
    example: str | float | None = display_only_field(None)
    better: Better = display_only_field("low")
    signed: bool = display_only_field(False)
    instead_of_quotient: str = display_only_field("")
    domain: Domain | None = display_only_field(None)
    floor: float | None = display_only_field(None)
    in_line: float | None = display_only_field(None)
    endless: str = display_only_field("")
    needs: tuple[Need, ...] = display_only_field(())
    instead: str = display_only_field("")
    bounds: QuantityBounds | None = display_only_field(None)
    allowed_by: str = display_only_field("")
    about_tolerances: bool = display_only_field(False)
    offered: tuple[Offer, ...] = display_only_field(())
    on_datasheet: bool = display_only_field(False)
    plain: bool = display_only_field(False)
    turning: bool = display_only_field(True)
    smooth_at_zero_offset: bool = display_only_field(False)
    table: ClassVar[str] = ""
    """Table that a job must have for the quantity to exist; empty if every problem has it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "title", self.title or self.name.replace("_", " "))

    @property
    def column_stem(self) -> str:
        """Its column name without the unit."""
        return self.key or self.name

    @property
    def field(self) -> str:
        """Key in tables and JSON, including the unit: "stroke_mm"."""
        return self.column_stem + self.kind.metric.suffix

    @property
    def unit(self) -> DisplayUnit:
        """Unit in tables, JSON and figures."""
        return self.kind.metric

    @property
    def short_title(self) -> str:
        """Short title for small spaces."""
        return self.short or self.title

    @property
    def usual_value(self) -> str | float:
        """A usual value as in job files."""
        if self.example is not None:
            return self.example
        return self.kind.example if self.kind.unit else float(self.kind.example)

    @property
    def job_requirements_text(self) -> str:
        """Requirements on a job, in words; empty if every job meets them."""
        table = [f"it needs the table [{self.table}]"] if self.table else []
        return "; ".join(dict.fromkeys([*table, *(need.rule for need in self.needs)]))

    @property
    def has_gradient(self) -> bool:
        """Whether it has derivatives with respect to the dimensions."""
        return True

    @property
    def is_constant(self) -> bool:
        """Whether it is the same for every design of one machine."""
        return False

    @property
    def depends_only_on_dimensions(self) -> bool:
        """Whether it depends on crank, rod and offset alone, without a search over the cycle."""
        return False

    def depends_on_speed(self, mechanism: Mechanism) -> bool:
        """Return whether the magnitude, sign or presence of the crank speed changes the quantity for a machine."""
        numbers = [item.largest_magnitude_bound for item in mechanism.varying]
        designs = np.array([[0.05, 0.2, offset, *numbers] for offset in (0.02, -0.02)])
        still, *moving = (
            self.evaluate(replace(mechanism, speed=speed), designs).values for speed in (0.0, 1.0, -1.0, 1000.0)
        )
        return not all(np.allclose(still, values, rtol=1e-9, atol=0.0, equal_nan=True) for values in moving)

    def bounds_for(self, mechanism: Mechanism) -> QuantityBounds | None:
        """Return its bounds if they hold for the machine."""
        return self.bounds

    def allowable_value(self, mechanism: Mechanism) -> float:
        """Return the maximum that a machine withstands, or the minimum if high is better, SI; see `allowed_by`."""
        raise NotImplementedError(f"{self.name} has no allowable value")

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return formulas in the machine's raw numbers whose maximum is the quantity, to bound it over ranges.

        Empty if it has none.
        """
        return ()

    @property
    def component_quantities(self) -> tuple[Quantity, ...]:
        """The quantities from which it is computed."""
        return ()

    def with_parts(self, parts: tuple[Quantity, ...]) -> Quantity:
        """Return the quantity with other parts, in the order of `component_quantities`."""
        return self

    def unmet_need(self, mechanism: Mechanism, consequence: Consequence) -> str | None:
        """Return rule, value and remedy for the first need that a machine does not meet; None if there is none.

        consequence: effect on the quantity: "undefined", "equal" to another one, or "zero" for every design.
        """
        for need in self.needs:
            if need.consequence == consequence and not need.is_met(mechanism):
                return need.missing.replace("{instead}", self.instead)
        return None

    @property
    def no_value_reason(self) -> str:
        """Reason why a design may have no value even though the machine defines the quantity."""
        needs = (need for need in self.needs if need.consequence == "undefined")
        return next((need.missing for need in needs), "it has no value for this design")

    def undefined_because(self, machines: Iterable[Mechanism]) -> str | None:
        """Return rule, value and remedy if any of the machines does not define the quantity; None if all do.

        A quantity that merely equals another one counts as undefined.
        """
        reasons = (self.unmet_need(m, "undefined") or self.unmet_need(m, "equal") for m in machines)
        return next(filter(None, reasons), None)

    def zero_because(self, machines: Iterable[Mechanism]) -> str | None:
        """Return rule, value and remedy if the quantity is zero for all designs and machines; None otherwise."""
        reasons = [self.unmet_need(machine, "zero") for machine in machines]
        return reasons[0] if all(reasons) else None

    @abstractmethod
    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k), all fully rotating.

        Columns: crank, rod, offset, m, then the machine's variables, SI.
        """

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the maximum of smooth pieces: a single one, unless its class has several."""
        evaluation = self.evaluate(mechanism, dimensions, gradients=True)
        assert evaluation.gradients is not None
        return Pieces(evaluation.values[:, None], evaluation.gradients[:, None], np.zeros((len(evaluation.values), 1)))
