"""A load on the slider or the crank: everything that kernels, job files, the page and summaries need.

A kind of load is a module in this package with a frozen dataclass that derives from `Load`. It declares how it enters
the kernels: in one of the forms that are summed before a sweep (`Enters`), or through its own `formula`.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from inspect import Parameter, Signature, signature
from typing import Any, ClassVar, Literal, NamedTuple, get_args

import numpy as np

from ...arrays import Array
from ...checks import require_all_finite
from ...errors import InputError
from .load_text import effect_in_strokes

Datum = Literal["crank pivot", "inner dead centre", "outer dead centre"]
AngleDatum = Literal["zero crank angle", "inner dead centre", "outer dead centre"]
CycleAngle = Literal["360 deg", "720 deg"]
During = Literal["cycle", "outward stroke", "inward stroke"]
Formula = Callable[[Any, Any, Any, Any, Any], Any]


class Enters(IntEnum):
    """How a kind of load enters the kernels; this is also the order of kinds in lists.

    Stroke forces, springs, viscous loads and added masses are summed for each design before a sweep, so any number of
    them costs as much as one. Tables and cylinders create breakpoints. All others are evaluated one by one: forces with
    a formula, and torques on the crank, which affect only the drive torque.
    """

    STROKE_FORCE = 0
    SPRING = 1
    VISCOUS = 2
    ADDED_MASS = 3
    POSITION_TABLE = 4
    ANGLE_TABLE = 5
    CYLINDER = 6
    BURNING_CYLINDER = 7
    CRANK_TORQUE = 8
    FORMULA = 9


class Passage(NamedTuple):
    """A stroke of n designs, divided into m steps.

    outward: whether it is the outward stroke. angle: crank angles in the middle of each step, (n, m), rad. distance:
    distance of the slider from the crank pivot along its line at the ends of the steps, (n, m + 1), m.
    """

    outward: bool
    angle: Array
    distance: Array

    def work_of_force(self, force: Any) -> Array:
        """Return the work (n,), J, of a force given in the middle of each step, N outward."""
        return np.asarray(np.sum(force * np.diff(self.distance, axis=1), axis=1))


@dataclass(frozen=True)
class StrokePart:
    """Part of a stroke: the whole stroke, or its first or last `length`, m."""

    part: Literal["whole", "first", "last"] = "whole"
    length: float = 0.0

    def __repr__(self) -> str:
        return "whole stroke" if self.part == "whole" else f"{self.part} {self.length!r} m"


@dataclass(frozen=True)
class Entry:
    """A key of a load's table in a job file.

    kind: kind of its value, a name from `optimise.job.value_types`, or the words to choose from. increasing: whether a
    table's points increase. optional: whether it has a default.
    """

    name: str
    kind: str | tuple[str, ...]
    description: str
    example: Any
    several: bool = False
    increasing: bool = False
    default: Any = None


@dataclass(frozen=True)
class Table:
    """A [[load]] table in a job file, identified by its key.

    title: title in the form's list. help: help text, one sentence. initial: initial values in the form. build: function
    that builds the load from SI values by name. motion: crank motion to which it applies (full rotation or swing); ""
    for either.
    """

    key: str
    name: str
    title: str
    help: str
    entries: tuple[Entry, ...]
    initial: Mapping[str, Any]
    build: Callable[..., Load]
    motion: Literal["", "turn", "swing"] = ""

    def __post_init__(self) -> None:
        if self.key not in {entry.name for entry in self.entries}:
            raise ValueError(
                f"a load table must be identified by the key of one of its entries; got {self.key!r}; name one"
            )
        keys, parameters = {entry.name for entry in self.entries}, signature(self.build).parameters.values()
        named = {parameter.name for parameter in parameters if parameter.kind is not Parameter.VAR_KEYWORD}
        needed = {
            parameter.name
            for parameter in parameters
            if parameter.name in named and parameter.default is Parameter.empty
        }
        unknown = keys - named if len(named) == len(parameters) else set()
        if unknown or needed - keys:
            raise ValueError(
                f"a load table's build function must take its entries by name; got {_word_list(unknown)}, which "
                f"{self.name} does not take, and no {_word_list(needed - keys)}; map entries to fields with "
                "load_builder(kind, key='field')"
            )


@dataclass(frozen=True, kw_only=True)
class Load:
    """A load on the slider along its line, positive outward, or on the crank, positive counter-clockwise.

    enters: see `Enters`. formula: force as a function of position (m outward of the crank pivot), velocity (m/s
    outward), way (1 while the slider moves outward, -1 inward) and the load's own two numbers; zero if both numbers are
    zero; `analytic`, without branches on its arguments. speed_power: power of the crank speed to which the formula is
    proportional. on_crank: whether it is a torque on the crank. every_corner: whether its variables must be valid at
    every combination of their bounds, rather than only with all at the lower or all at the upper bounds. sizes: fields
    that are all zero if the load is zero throughout; empty for a load that is never zero. slots: place in the load's
    numbers and SI unit for each field that designs can vary. tables: its tables in job files.
    """

    enters: ClassVar[Enters]
    formula: ClassVar[Formula | None] = None
    speed_power: ClassVar[Literal[0, 1, 2]] = 0
    on_crank: ClassVar[bool] = False
    every_corner: ClassVar[bool] = False
    sizes: ClassVar[tuple[str, ...]] = ()
    slots: ClassVar[Mapping[str, tuple[int, str]]] = {}
    tables: ClassVar[tuple[Table, ...]]

    def numbers_for_kernel(self) -> tuple[float, ...]:
        """Return factors for the outward and the inward stroke, and the load's own two numbers; more for a cylinder."""
        raise NotImplementedError

    @property
    def acts(self) -> bool:
        """Whether it is nonzero anywhere."""
        return not self.sizes or any(np.any(getattr(self, name)) for name in self.sizes)

    def knots(self) -> tuple[Sequence[float], Sequence[float]]:
        """Return the knots of the load's table and the forces at the knots; empty without a table.

        Two knots at one location are a step: the first has the force before it, the second the force after it.
        """
        return (), ()

    @property
    def has_steps(self) -> bool:
        """Whether the table steps: a force that jumps while the slider moves."""
        return False

    @property
    def has_knots_in_sense_of_rotation(self) -> bool:
        """Whether the knots are crank angles counted in the sense of rotation."""
        return False

    @property
    def differs_after_a_turn(self) -> bool:
        """Whether the load does not repeat after one crank turn; only a swinging crank can have it."""
        return False

    @property
    def cycle_turns(self) -> int:
        """Number of crank turns after which the load repeats."""
        return 1

    def load_on_turn(self, turn: int) -> Load:
        """Return the load in turn 1 or 2 alone, for a cycle of two turns."""
        return self

    @property
    def cycle_datum(self) -> str:
        """Zero of a two-turn cycle: zero crank angle or a dead centre."""
        return str(getattr(self, "datum", "zero crank angle"))

    def name_of_number_on_turn(self, name: str, turn: int) -> str | None:
        """Return the name that one of its numbers has in `load_on_turn`; None if that turn does not have it."""
        return name

    @property
    def is_conservative(self) -> bool:
        """Whether it returns over a cycle what it absorbs: a force that depends on position alone, or a mass."""
        return False

    @property
    def is_moving_mass(self) -> bool:
        """Whether it is a mass that moves with the slider."""
        return self.enters is Enters.ADDED_MASS

    @property
    def has_stroke_dependent_formula(self) -> bool:
        """Whether the force has different formulas in the two strokes."""
        first, second = self.numbers_for_kernel()[:2]
        return first != second

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return magnitudes of the work over a turn by key; works under one key may cancel.

        moving: whether the crank turns; at rest, speed-dependent loads are zero.
        """
        takes = not self.is_conservative and (moving or not self.speed_power)
        return {type(self).__name__: (1.0,)} if takes else {}

    def work_deciding_loaded_stroke(self, passage: Passage) -> Any:
        """Return the work (n,), J, that decides which stroke is loaded.

        Zero for a load that returns it in the other stroke, or that always resists.
        """
        return 0.0

    @property
    def may_drive(self) -> bool:
        """Whether the load may by definition drive the machine: gas, or a force that helps a stroke."""
        return False

    @property
    def magnitude_text(self) -> str:
        """Its magnitude and sign as a short text."""
        raise NotImplementedError

    @property
    def possible_stroke_forces(self) -> tuple[Sequence[float], Sequence[float]] | None:
        """Possible forces in the outward and the inward stroke, N outward.

        None if they depend on more than the stroke.
        """
        return None

    @property
    def never_drives(self) -> bool:
        """Whether it certainly does no net work on the machine over a cycle."""
        if self.possible_stroke_forces is None:
            return self.is_conservative
        outward, inward = self.possible_stroke_forces
        return self.is_conservative or (max(outward) <= 0.0 and min(inward) >= 0.0)

    @property
    def effect_text(self) -> str:
        """Effect on the strokes, and whether the net work over a cycle is zero."""
        parts = [] if self.possible_stroke_forces is None else [effect_in_strokes(*self.possible_stroke_forces)]
        return ", ".join([*parts, "no net work over a cycle"] if self.is_conservative and self.acts else parts)

    @property
    def range_text(self) -> str:
        """Range in which it acts."""
        return ""

    @property
    def text(self) -> str:
        """The load in a sentence: magnitude and sign, effect, range."""
        return ", ".join(filter(None, (self.magnitude_text, self.effect_text, self.range_text)))


def _word_list(names: set[str]) -> str:
    return " and ".join(sorted(names)) or "other"


def load_builder(kind: Callable[..., Load], **fields: str) -> Callable[..., Load]:
    """Return the function that builds a load from its table's values. fields: keys whose fields have other names."""
    keys = {field: key for key, field in fields.items()}

    def build(**values: Any) -> Load:
        return kind(**{fields.get(key, key): value for key, value in values.items()})

    named = [parameter.replace(name=keys.get(name, name)) for name, parameter in signature(kind).parameters.items()]
    build.__signature__ = Signature(named)  # type: ignore[attr-defined]
    return build


def increasing_points_entry(name: str, kind: str, description: str, *example: str) -> Entry:
    """Return the key of a table's increasing coordinates, in which two equal ones are a step."""
    return Entry(name, kind, description, list(example), several=True, increasing=True)


def require_word(name: str, value: object, words: object) -> None:
    """Raise an error unless the value is one of the words in a `Literal`."""
    if value not in get_args(words):
        raise InputError(f"{name} must be {' or '.join(map(repr, get_args(words)))}; got {value!r}")


def require_valid_table(argument: str, at: Sequence[float], forces: Sequence[float], *, values: str = "forces") -> None:
    """Raise `InputError` for a table that decreases, has three points at one location or fewer than two in total.

    The numbers must be finite. argument, values: names of both columns, for the message.
    """
    if len(at) != len(forces) or len(at) < 2:
        raise InputError(
            f"a table needs as many {values} as {argument}, at least two; got {len(at)} {argument} and "
            f"{len(forces)} {values}"
        )
    require_all_finite(f"a table of {argument} and {values}", (*at, *forces), "throughout")
    n = index_of_first_misplaced_point(at)
    if n is not None:
        raise InputError(f"{argument} of a table {order_rule_broken_at_point(n, at, f'{at[n]:g}', f'{at[n - 1]:g}')}")


def index_of_first_misplaced_point(at: Sequence[float]) -> int | None:
    """Return the index of the first point that lies below its predecessor or is the third at one location.

    None if there is no such point.
    """
    for n in range(1, len(at)):
        if at[n] < at[n - 1] or (n > 1 and at[n] == at[n - 2]):
            return n
    return None


def order_rule_broken_at_point(n: int, at: Sequence[float], point: str, before: str) -> str:
    """Return the rule that point n in a table breaks, with this point and its predecessor as typed."""
    if at[n] < at[n - 1]:
        return f"must increase; got {point} after {before}; sort the table"
    return (
        f"must increase, except for two equal ones at a step; got {point} three times; keep the values before and "
        "after the step"
    )


def has_step(at: Sequence[float]) -> bool:
    """Whether two points in a table are at one location."""
    return any(after == before for before, after in itertools.pairwise(at))


DURING = Entry("during", get_args(During), "motion or stroke in which the load acts", "outward stroke", default="cycle")
DATUM = Entry(
    "measured_from",
    get_args(Datum),
    "origin of the positions: the crank pivot or inner dead centre (counted outward), or the outer dead centre "
    "(counted inward)",
    "outer dead centre",
    default="crank pivot",
)
ANGLE_DATUM = Entry(
    "measured_from",
    get_args(AngleDatum),
    "origin of the crank angles: zero (counted counter-clockwise), or a dead centre (counted in the direction "
    "of rotation)",
    "outer dead centre",
    default="zero crank angle",
)
CYCLE = Entry(
    "cycle",
    get_args(CycleAngle),
    "period of the table; 720 deg for four strokes",
    "720 deg",
    default="360 deg",
)
FORCES = Entry(
    "forces",
    "Force",
    "force on the slider at each point; positive outward, away from the crank pivot",
    ["-600 N", "0 N"],
    several=True,
)
