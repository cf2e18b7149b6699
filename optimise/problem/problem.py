"""An optimisation problem: its machine, variables, requirements and objectives. SI, immutable, validated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from html import escape
from typing import TYPE_CHECKING, Any, Literal, overload

from numpy.typing import ArrayLike

from ...model.checks import is_integer, require_field_types, store_as_tuples
from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage, SlowStroke
from ...model.machine.loads.crank_torque import require_loads_repeating_each_turn
from ...model.machine.loads.load import require_word
from ...model.machine.mechanism import Mechanism
from ...objectives.bounds_over_ranges import QuantityBounds
from ...objectives.catalogue_amount import Amount, substitute_amounts
from ...objectives.formula.resolve_names import is_formula_or_number_name, resolve_quantities
from ...objectives.quantity import Array, Quantity
from ...objectives.registry import QUANTITIES, first_names_text
from ...objectives.tables.design_input import designs_as_array, names_of_design_numbers, warn_of_lengths
from ...objectives.tables.evaluate_quantities import quantities_as_array
from ...objectives.tables.swing_columns import (
    reason_undefined_for_swing,
    require_loads_for_swing,
    require_motion_of_machine_kind,
    require_quantities_of_motion,
    require_swing_quantity,
    swing_quantities,
)
from .design_analysis import Analysis, analyse_machine, machine_and_design_row
from .question_registry import question_about
from .requirements import Constraint, Discrete, Objective, Range, Word, merge_constraints, require_distinct_numbers
from .table_columns import (
    choice_field,
    note_field,
    require_free_columns,
    sufficient_amount_field,
    sufficient_option_field,
)
from .tolerance_costs import Costs, SectionLimits

if TYPE_CHECKING:
    from ...model.swing.request_and_summary import SwingSummary
    from ...model.swing.swing import Swing
    from ...model.swing.swing_types import Driver, Law, Side

_IN_WORDS: dict[Word, str] = {"min": "at least ", "max": "at most ", "equals": ""}


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the search.

    method: a name from `methods.registry`. designs: maximum number of designs to return. samples: designs evaluated per
    round before the polish; None lets the method choose. evaluations: number of designs that a method other than "auto"
    may evaluate; None for its own budget. seed: seed of all random numbers.
    """

    method: str = "auto"
    designs: int = 100
    samples: int | None = None
    evaluations: int | None = None
    seed: int = 1

    def __post_init__(self) -> None:
        for name, least in (("designs", 1), ("samples", 1), ("evaluations", 1), ("seed", 0)):
            value = getattr(self, name)
            if value is None and name in ("samples", "evaluations"):
                continue
            if not is_integer(value) or int(value) < least:
                raise InputError(f"{name} must be at least {least}, a whole number; got {value!r}")


@dataclass(frozen=True, kw_only=True)
class Variant:
    """One combination of discrete choices.

    labels: the chosen options, one for each of the problem's `choices`. mechanism, crank, rod, offset: those of the
    problem with this choice. limits: constraints that the choice adds (such as the greatest torque of a gearmotor);
    where the problem constrains the same quantity, both hold. slow_stroke: the stroke that it requires to be slow.
    amounts: values of the problem's amounts, SI. notes: texts such as a maker, each preceded by its choice and its
    column heading. ranks: for each choice, the number of options in its catalogue that are smaller than this one.
    """

    labels: tuple[str, ...]
    mechanism: Mechanism
    crank: Range
    rod: Range
    offset: Range
    limits: tuple[Constraint, ...] = ()
    slow_stroke: SlowStroke | None = None
    amounts: tuple[tuple[str, float], ...] = ()
    notes: tuple[tuple[str, str, str], ...] = ()
    ranks: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        store_as_tuples(self, "labels", "limits", "amounts", "notes", "ranks")
        _require_slow_stroke_word(self.slow_stroke)

    def note(self, choice: str, head: str) -> str:
        """Return a text of the chosen option; empty if it has none."""
        return next((text for *of, text in self.notes if of == [choice, head]), "")


_KINDS = {"name": str, "mechanism": Mechanism, "crank": Range, "rod": Range, "offset": Range, "settings": Settings}
_EACH = {
    "objectives": Objective,
    "constraints": Constraint,
    "own": Quantity,
    "variants": Variant,
    "catalogue": Variant,
    "discrete": Discrete,
}
_WITH_LEAST = "amounts and texts of the least option"
_CHANGE = "change the problem with `dataclasses.replace`, or state it again with `problem`"


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A complete optimisation problem.

    mechanism: the machine with its extra variables. crank, rod, offset: ranges of the three dimensions, m. choices:
    names of the discrete choices. variants: every combination of them; empty if there are no choices. left_out:
    combinations whose limits the constraints exclude, label and reason, to be reported. With variants, use the
    mechanism and ranges of `parts`: those here belong to no particular variant. catalogue: combinations that may be the
    least sufficient option for a design, see `search.cheapest_sufficient_option`; some are not searched. costs: costs
    of the tolerances, for their allocation. sections: limits within which bars are sized, in the material of the
    mechanism. own: quantities besides those that every problem has; objectives and constraints may name them too.
    slow_stroke: the stroke that must be slow, if one is required. The time ratio is then above 1, see
    `constraints_with_floors`, and the offset has only one sign, see `slow_side`, unless the speed follows a profile.
    discrete: the numbers of a design with discrete values; their ranges are the hulls of these. motion: a swing of the
    crank, which then need not rotate fully. Its quantities are among the own ones; quantities of a rotating crank raise
    an error. warnings: sentences on statements in the job that are probably not intended.
    """

    name: str
    mechanism: Mechanism
    crank: Range
    rod: Range
    offset: Range
    objectives: tuple[Objective, ...]
    constraints: tuple[Constraint, ...] = ()
    settings: Settings = Settings()
    costs: Costs | None = None
    sections: SectionLimits | None = None
    own: tuple[Quantity, ...] = ()
    choices: tuple[str, ...] = ()
    variants: tuple[Variant, ...] = ()
    left_out: tuple[tuple[str, str], ...] = ()
    catalogue: tuple[Variant, ...] = ()
    slow_stroke: SlowStroke | None = None
    discrete: tuple[Discrete, ...] = ()
    motion: Swing | None = None
    warnings: tuple[str, ...] = field(default=(), compare=False)

    def __post_init__(self) -> None:
        store_as_tuples(self, "objectives", "constraints", "own", "choices", "variants", "left_out")
        store_as_tuples(self, "catalogue", "discrete", "warnings")
        require_field_types(self, _KINDS, _CHANGE)
        require_field_types(self, _EACH, _CHANGE, item_by_item=True)
        require_distinct_numbers(self.discrete, [*self.ranges])
        for own in self.variants or (self,):
            require_motion_of_machine_kind(own.mechanism, self.motion)
        if self.motion is not None:
            self._add_swing_quantities(self.motion)
        else:
            for own in self.variants or (self,):
                require_loads_repeating_each_turn(own.mechanism)
        self._add_formulas()
        require_free_columns(self.own, self.mechanism.varying, self.choice_fields)
        _require_slow_stroke_word(self.slow_stroke)
        for item in self.mechanism.varying:
            if item.name in DIMENSIONS:
                raise InputError(f"a variable besides the dimensions must have a unique name; got {item.name!r}")
        for variant in self.variants:
            if len(variant.labels) != len(self.choices):
                raise InputError(f"a variant must have a label for each of {self.choices}; got {variant.labels}")
            if [x.name for x in variant.mechanism.varying] != [x.name for x in self.mechanism.varying]:
                raise InputError("the same numbers must vary in all variants of a problem")
        if not self.objectives:
            raise InputError(f"a problem needs at least one objective; choose from {first_names_text(QUANTITIES)}")
        names = [objective.quantity for objective in self.objectives]
        machines = self.machines
        keys = [("objectives", name) for name in names]
        keys += [("constraints", constraint.quantity) for constraint in self.every_constraint]
        for table, name in keys:
            reason = self.quantity(name).undefined_because(machines)
            if reason:
                raise InputError(f"{table}.{name}: {reason}")
        constrained = [constraint.quantity for constraint in self.constraints]
        for what, given, remedy in (("objective", names, "keep one"), ("constraint on", constrained, "merge the two")):
            for name in given:
                if given.count(name) > 1:
                    raise InputError(f"the {what} {name} may be given only once; got it twice; {remedy}")
        if self.offset.lower <= 0.0 <= self.offset.upper:
            for objective in self.objectives:
                if self.quantity(objective.quantity).in_line == math.inf and objective.sense == "maximise":
                    raise InputError(
                        f"{objective.quantity} grows without bound as the offset goes to zero, so it cannot be "
                        f"maximised; got an offset from {self.offset.lower:g} to {self.offset.upper:g} m; keep the "
                        "range away from zero"
                    )
        if self.crank.lower <= 0.0 or self.rod.lower <= 0.0:
            raise InputError("crank and rod must be above zero; raise the lower end of their ranges")

    def _add_swing_quantities(self, swing: Swing) -> None:
        """Add the quantities of a swing. Raises `InputError` for anything that a swing cannot have."""
        known = {of.name for of in self.own}
        more = tuple(of for of in swing_quantities(swing) if of.name not in known)
        object.__setattr__(self, "own", (*self.own, *more))
        if self.slow_stroke is not None:
            raise InputError(
                f"constraints.slow_stroke: needs a rotating crank; got {self.slow_stroke} with a swing; leave it out"
            )
        for variant in self.variants or (self,):
            require_loads_for_swing(variant.mechanism)
        tables = {item.quantity: "objectives" for item in self.objectives}
        for name, table in ({item.quantity: "constraints" for item in self.every_constraint} | tables).items():
            reason = reason_undefined_for_swing(name, swing)
            if reason is not None:
                raise InputError(f"{table}.{name}: {reason}")
            require_swing_quantity(f"{table}.{name}", self.quantity(name), swing)

    def _add_formulas(self) -> None:
        """Add the formulas that objectives and constraints name."""
        requested_names = [item.quantity for item in self.objectives]
        for name in (*requested_names, *(item.quantity for item in self.every_constraint)):
            if is_formula_or_number_name(name, self.mechanism, self.own):
                made = self.quantity(name)
                if made.name != name:
                    raise InputError(
                        f"an objective or constraint must name a formula as it is printed; got {name!r}; write "
                        f"{made.name!r}"
                    )
                object.__setattr__(self, "own", (*self.own, made))

    def __repr__(self) -> str:
        senses = ", ".join(f"{objective.sense} {objective.quantity}" for objective in self.objectives)
        count = f"{len(self.constraints)} constraint" + ("" if len(self.constraints) == 1 else "s")
        return f"Problem({self.name!r}: {senses}; {count})"

    def _repr_html_(self) -> str:
        """Drawing of a linkage within the ranges, and its requirements, for notebooks."""
        sizes = [0.5 * (ends.lower + ends.upper) for ends in (self.crank, self.rod, self.offset)]
        try:
            picture = Linkage(sizes[0], sizes[1], sizes[2], self.mechanism.branch)._repr_html_() or ""
        except InputError:  # the middle of the ranges need not be a linkage
            picture = ""
        if self.mechanism.lever is not None:  # it has neither rod nor slider
            picture = ""
        rows = [(name, self.ranges[name]) for name in DIMENSIONS]
        ranges = "".join(f"<li>{name}: {1e3 * r.lower:g} to {1e3 * r.upper:g} mm</li>" for name, r in rows)
        requirements = "".join(
            f"<li>{escape(_constraint_in_words(self.quantity(c.quantity), c))}</li>" for c in self.constraints
        )
        return f"<div><p>{escape(repr(self))}</p>{picture}<ul>{ranges}{requirements}</ul></div>"

    def quantity(self, name: str) -> Quantity:
        """Return the quantity of a given name, including custom ones, or the quantity of a formula as in job files.

        Raises `InputError` with the nearest names, or with the error in the formula.
        """
        require_quantities_of_motion([name], self.own, self.motion)
        lengths = {name: getattr(self, name) for name in DIMENSIONS}
        (found,) = resolve_quantities([name], self.mechanism, self.own, ranges=lengths, turning=self.motion is None)
        return found

    @overload
    def evaluate(
        self, designs: ArrayLike, quantities: Sequence[str] | None = None, *, gradients: Literal[False] = False
    ) -> Array: ...
    @overload
    def evaluate(
        self, designs: ArrayLike, quantities: Sequence[str] | None = None, *, gradients: Literal[True]
    ) -> tuple[Array, Array]: ...
    def evaluate(
        self, designs: ArrayLike, quantities: Sequence[str] | None = None, *, gradients: bool = False
    ) -> Array | tuple[Array, Array]:
        """Return quantities (n, q) of designs (n, 3 + k), SI; with `gradients`, also the Jacobian.

        The Jacobian is (n, q, 3 + k). quantities: names or formulas; by default the objectives, in the order of
        `objectives`. Values are those of the quantities, before any change of sign for minimisation. Rows of designs
        that do not rotate fully are NaN. See `tables.evaluate`. Raises `InputError` for a problem with choices: use its
        `parts`.
        """
        self._require_no_choices()
        names = [objective.quantity for objective in self.objectives] if quantities is None else quantities
        given = designs_as_array(designs, names_of_design_numbers(self.mechanism))
        warn_of_lengths(self, given, self._greatest_dimensions)
        return quantities_as_array(self.mechanism, given, names, gradients=gradients, own=self.own, swing=self.motion)

    def analyse(self, design: ArrayLike) -> Analysis:
        """Return the analysis of one design (3 + k,): crank, rod, offset, m, and the extra variables, SI.

        Raises `AssemblyError` for a design that does not rotate fully, or not as far as a swing requires; `InputError`
        for a problem with choices.
        """
        self._require_no_choices()
        machine, sizes = machine_and_design_row(self.mechanism, design)
        warn_of_lengths(self, sizes, self._greatest_dimensions)
        return analyse_machine(self.mechanism, machine, sizes, own=self.own, title=self.name, swing=self.motion)

    def ask(self, question: str, /, design: ArrayLike | None = None, **inputs: object) -> dict[str, Any]:
        """Answer a question about a design (3 + k,), with the keys of the JSON: `problem.ask("press", design=...)`.

        Without a design, the question is about the job: `problem.ask("sweep", over="offset=0 mm..20 mm:5",
        of="peak_torque")` returns `rows` as the command prints them. Lengths that the job does not fix are further
        inputs, `crank="40 mm"`.

        question: a topic of `analyse --show`, "inverse", "swing", "allocate", "counterweight" (the command `balance`),
        "sections", or a question from another installed package. inputs: its inputs, in SI or as text with a unit,
        `touch_distance="12 mm"`. Keys and values are those of `analyse --show press --json`. Raises `InputError` for an
        unknown question or input, for anything that the design lacks, and as `analyse` does.
        """
        self._require_no_choices()
        if design is None:
            return dict(question_about("job", question).answer_of(self, None, inputs))
        machine, sizes = machine_and_design_row(self.mechanism, design)
        warn_of_lengths(self, sizes, self._greatest_dimensions)
        linkage = Linkage(sizes[0], sizes[1], sizes[2], machine.branch)
        return dict(question_about("design", question).answer(machine, linkage, self, inputs))

    def swing(
        self,
        design: ArrayLike,
        *,
        start: float | None = None,
        end: float | None = None,
        slider_start: float | None = None,
        slider_end: float | None = None,
        crank_side: Side | None = None,
        driver: Driver | None = None,
        law: Law | None = None,
        duration: float | None = None,
        actuator_tolerance: float | None = None,
    ) -> SwingSummary:
        """Return the summary of a crank swing for a design (3 + k,), which need not rotate fully.

        Omitted arguments are those of the problem's own motion; if it has none, the crank drives slowly. start, end:
        crank angles, rad. slider_start, slider_end: slider positions instead, m, with the crank pin on the `crank_side`
        of the line to the slider pin. driver: "crank", by a torque, or "slider", by a force. law: motion law of the
        driver, see `model.swing.swing_types`. duration: time from end to end, s, for all laws except "slow".
        actuator_tolerance: tolerance of the driven slider, m. Raises `AssemblyError` if the linkage does not close,
        `InputError` for a dead point that the slider cannot pass, for ends that are missing or of two kinds, and as
        `analyse` does.
        """
        from ...model.swing.request_and_summary import SwingRequest, resolve_swing, summarise_swing

        self._require_no_choices()
        requested_names = SwingRequest(
            start=start,
            end=end,
            slider_start=slider_start,
            slider_end=slider_end,
            side=crank_side,
            driver=driver,
            law=law,
            duration=duration,
            actuator_tolerance=actuator_tolerance,
        )
        machine, sizes = machine_and_design_row(self.mechanism, design)
        machine, swing = resolve_swing(machine, self.motion, requested_names, {"side": "crank_side"})
        return summarise_swing(machine, Linkage(sizes[0], sizes[1], sizes[2], machine.branch), swing)

    def _require_no_choices(self) -> None:
        if self.variants:
            raise InputError(
                f"a design of a problem with choices ({', '.join(self.choices)}) must belong to one option; got "
                f"the problem with all {len(self.variants)}; use one of problem.parts()"
            )

    @property
    def _greatest_dimensions(self) -> list[float]:
        """Greatest magnitudes of crank, rod and offset within the ranges, m."""
        return [max(abs(ends.lower), abs(ends.upper)) for ends in (self.crank, self.rod, self.offset)]

    @property
    def ranges(self) -> dict[str, Range]:
        """Ranges of a design's numbers by name, in order."""
        lengths: dict[str, Range] = {name: getattr(self, name) for name in DIMENSIONS}
        return lengths | {item.name: Range(lower=item.lower, upper=item.upper) for item in self.mechanism.varying}

    @property
    def machines(self) -> tuple[Mechanism, ...]:
        """Machine of every variant; without choices, that of the problem."""
        return tuple(variant.mechanism for variant in self.variants) or (self.mechanism,)

    @property
    def choice_fields(self) -> list[tuple[str, str]]:
        """Column keys of chosen options and their amounts, each with its meaning in words."""
        least = [self.choices[place] for place in self.catalogues]
        return [
            *((choice_field(name), f"the choice {name}") for name in self.choices),
            *(
                (note_field(name, head), "a column of a catalogue")
                for name in self.choices
                for head in self.heads(name)
            ),
            *((sufficient_option_field(name), "the smallest sufficient option") for name in least),
            *((note_field(f"least {name}", head), _WITH_LEAST) for name in least for head in self.heads(name)),
            *((sufficient_amount_field(name, of), _WITH_LEAST) for name in least for of in self.amounts(name)),
        ]

    def heads(self, choice: str) -> list[str]:
        """Return the headings of the texts that options of a choice have, such as "maker"."""
        every = (note for variant in (*self.variants, *self.catalogue) for note in variant.notes)
        return [*dict.fromkeys(head for name, head, _ in every if name == choice)]

    def amounts(self, choice: str) -> list[Amount]:
        """Return the amounts that options of a choice have, such as a price."""
        return [of for of in self.own if isinstance(of, Amount) and of.choice == choice]

    @property
    def catalogues(self) -> tuple[int, ...]:
        """Indices of the choices whose options are ordered, smallest first."""
        ranks = {variant.ranks for variant in self.catalogue}
        return tuple(place for place in range(len(self.choices)) if len({of[place] for of in ranks}) > 1)

    @property
    def every_constraint(self) -> tuple[Constraint, ...]:
        """The constraints, including those from choices."""
        return (*self.constraints, *(limit for variant in self.variants for limit in variant.limits))

    def common_bounds(self, of: Quantity) -> QuantityBounds | None:
        """Return the bounds of a quantity if they hold for every machine of the problem."""
        return of.bounds if all(of.bounds_for(machine) is not None for machine in self.machines) else None

    def without_gradient(self) -> list[str]:
        """Return the quantities without a gradient in objectives and constraints, including those of choices."""
        requested_names = {item.quantity for item in self.objectives} | {
            item.quantity for item in self.every_constraint
        }
        return [item.name for item in self.own if item.name in requested_names and not item.has_gradient]

    def slow_side(self) -> float | None:
        """Sign of the offset (+1 or -1) that gives the required slow stroke; None if none is required.

        The inward stroke is slow if e w s > 0, with s = +1 on the open branch and -1 on the crossed one. Also None
        with a speed profile, where a constraint replaces the sign, see `constraints_with_floors`.
        """
        if self.slow_stroke is None or self.mechanism.speed_profile is not None:
            return None
        side = self.mechanism.direction * self.mechanism.sign
        return side if self.slow_stroke == "inward" else -side

    def part(self, variant: int) -> Problem:
        """Return the problem of one variant, without choices. Raises `InputError` for an unknown variant."""
        if not self.variants:
            return self
        if not is_integer(variant) or not -len(self.variants) <= variant < len(self.variants):
            raise InputError(f"a variant must be one of 0 to {len(self.variants) - 1}, see `variants`; got {variant!r}")
        return self.with_variant(self.variants[variant])

    def with_variant(self, chosen: Variant) -> Problem:
        """Return the problem for a combination of choices. Raises `InputError` if its limits exclude every design."""
        amounts = dict(chosen.amounts)
        return replace(
            self,
            mechanism=chosen.mechanism,
            crank=chosen.crank,
            rod=chosen.rod,
            offset=chosen.offset,
            constraints=merge_constraints((*self.constraints, *chosen.limits)),
            slow_stroke=_common_stroke(self.slow_stroke, chosen.slow_stroke),
            own=tuple(substitute_amounts(of, amounts) for of in self.own),
            choices=(),
            variants=(),
            left_out=(),
            catalogue=(),
        )

    def parts(self) -> tuple[Problem, ...]:
        """Return the problem of every variant; without choices, itself."""
        return tuple(self.part(index) for index in range(max(1, len(self.variants))))


def _constraint_in_words(of: Quantity, constraint: Constraint) -> str:
    unit = of.unit
    ends = [f"{_IN_WORDS[word]}{unit.factor * bound:.6g} {unit.symbol}".rstrip() for word, bound in constraint.sides]
    return f"{of.title}: {', '.join(ends)}"


def _common_stroke(stroke: SlowStroke | None, more: SlowStroke | None) -> SlowStroke | None:
    """Return the slow stroke that both require. Raises `InputError` if they differ."""
    if stroke is not None and more is not None and stroke != more:
        raise InputError(
            f"the slow stroke must be either the outward or the inward one; got {stroke} and {more} of a choice"
        )
    return stroke if more is None else more


def require_problem(problem: object, what: str) -> None:
    """Raise `InputError` unless the argument is a problem. what: name of the function that was called."""
    if not isinstance(problem, Problem):
        raise InputError(f"{what} needs a problem; got {type(problem).__name__}; make one with problem or load_job")


def _require_slow_stroke_word(stroke: object) -> None:
    if stroke is not None:
        require_word("slow_stroke", stroke, SlowStroke)
