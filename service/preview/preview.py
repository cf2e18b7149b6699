"""Preview of a job during editing: its mistakes, and sentences on requirements that its ranges cannot meet."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ...model.errors import InfeasibleError, InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import count_with_noun
from ...optimise.feasibility.relaxation import Relaxation, relaxation_of_missed_bound
from ...optimise.front.saved_front import is_constant
from ...optimise.job import Job
from ...optimise.job.incomplete_formulas import FormulaName, StatedFormula, formula_names, stated_formulas
from ...optimise.job.job_file import require_few_values
from ...optimise.job.mistake_messages import where_key_belongs
from ...optimise.job.model import schema_of
from ...optimise.job.plain_numbers import numbers_without_unit
from ...optimise.job.reachable_values import STROKE_RATIOS, ratio_and_angle_conflict
from ...optimise.problem.constraint_violation import constraints_with_floors
from ...optimise.problem.problem import Problem
from ...optimise.problem.question_registry import Change, Remark
from ...optimise.problem.requirements import Constraint, Word
from .partial_job import omitted_requirements, problem_in_crank_rod_offset
from .possible_swing import PossibleSwing, possible_swing
from .possible_values import Ends, Possible, possible_values

_COUNT = re.compile(r"\d+ problems|very many problems")
_PLACE = re.compile(r'((?:[a-z_]\w*|"[^"\n]*")(?: #\d+)?(?:\.(?:\w+|"[^"\n]*")(?: #\d+)?)*): (.+)', re.DOTALL)
_LONGER = 1.25  # rod length over its minimum beyond which the linkage is far from locking
_REST = "all other requirements on the dimensions"


@dataclass(frozen=True)
class Wrong:
    """Mistake in a job. path: its key, such as "mechanism.slider.mass" or "load #2.force"; "" for the whole job.

    infeasible: whether the input is valid but no design can meet it.
    """

    path: str
    sentence: str
    infeasible: bool = False


@dataclass(frozen=True)
class JobPreview:
    """Preview of a job.

    wrong: its mistakes, empty if the job can be solved. problem: problem of the whole job, if valid.

    stated, possible: values that the dimensions state and allow; None while their ranges cannot be read. unchecked:
    requirements that were not checked. sentences: sentences on unattainable requirements. formulas: formulas of the
    job, in order. names: names available only to formulas of this job. swing: values that the ranges of a swing job
    allow.
    """

    wrong: list[Wrong]
    problem: Problem | None
    stated: Problem | None
    possible: Possible | None
    unchecked: list[str]
    sentences: list[str]
    formulas: list[StatedFormula] = field(default_factory=list)
    names: list[FormulaName] = field(default_factory=list)
    swing: PossibleSwing | None = None


def job_preview(tables: Mapping[str, Any], read: Callable[[Mapping[str, Any]], Problem]) -> JobPreview:
    """Return the findings about a job. read: function that returns its problem, or raises its mistakes."""
    try:
        require_few_values(tables)
    except InputError as error:
        return JobPreview(_mistakes_in(error), None, None, None, [], [])
    look = _preview_without_formulas(tables, read)
    formulas = stated_formulas(tables)
    wrong = look.wrong if look.problem is not None else _with_formula_mistakes(look.wrong, formulas)
    swing = possible_swing(tables, look.problem)
    return replace(look, wrong=wrong, formulas=formulas, names=formula_names(tables), swing=swing)


def _with_formula_mistakes(wrong: list[Wrong], formulas: list[StatedFormula]) -> list[Wrong]:
    """Return mistakes with those in formulas, which the others hide: a job is read before its formulas.

    A message about the formula itself replaces the message about its place, unless that is a key of another table.
    """
    schema = schema_of(Job)
    wrong_by_key = {
        formula.key: formula.wrong
        for formula in formulas
        if formula.wrong is not None and not where_key_belongs(formula.key.split(".")[-1], schema)
    }
    return [
        *(mistake for mistake in wrong if mistake.path not in wrong_by_key),
        *(Wrong(*item) for item in wrong_by_key.items()),
    ]


def _preview_without_formulas(tables: Mapping[str, Any], read: Callable[[Mapping[str, Any]], Problem]) -> JobPreview:
    """Return the findings about a job except those on its formulas."""
    try:
        stated = problem_in_crank_rod_offset(tables, None)
    except InputError:
        stated = None
    full_problem, wrong, rest = None, list[Wrong](), tables
    checked_ratios = (
        [] if stated is None else [(ratio.name, ratio_and_angle_conflict(stated, ratio)) for ratio in STROKE_RATIOS]
    )
    sentences_by_name = {name: sentence for name, sentence in checked_ratios if sentence is not None}
    if sentences_by_name:  # reported only here; the rest of the job is checked without it
        wrong += [
            Wrong(f"constraints.{name}", sentence, infeasible=True) for name, sentence in sentences_by_name.items()
        ]
        rest = {
            **tables,
            "constraints": {name: at for name, at in tables["constraints"].items() if name not in sentences_by_name},
        }
    try:
        full_problem = read(rest)
        if not sentences_by_name and stated is not None:
            stated = problem_in_crank_rod_offset(tables, full_problem)
    except InputError as error:
        wrong += _mistakes_in(error)
    if sentences_by_name:
        full_problem = None
    if stated is None:
        return JobPreview(wrong, full_problem, None, None, [], [])
    ranges = possible_values(stated)
    fixed_names = () if full_problem is None else tuple(item.name for item in full_problem.mechanism.varying)
    doubts = _implausible_lengths(tables)
    reported = () if full_problem is None else full_problem.warnings
    return JobPreview(
        wrong,
        full_problem,
        stated,
        ranges,
        [*omitted_requirements(tables, stated), *ranges.unchecked],
        [doubt for doubt in doubts if doubt not in reported]
        if doubts  # lengths in the wrong unit would lead to wrong remedies
        else infeasibility_sentences(stated, ranges, fixed_names, tables),
    )


def _implausible_lengths(tables: Mapping[str, Any]) -> list[str]:
    """Return the warnings about crank, rod and offset values without a unit that are implausible."""
    keys = {f"variables.{name}" for name in DIMENSIONS}
    plain = numbers_without_unit(Job, {"variables": tables["variables"]})
    return [item.warning_text for item in plain if item.key in keys and item.warning_text]


def _mistakes_in(error: InputError) -> list[Wrong]:
    """Return the mistakes in the sentences of an error, each with its path in the job."""
    mistakes = []
    for line in str(error).split("\n  "):
        if _COUNT.fullmatch(line):
            continue
        match = _PLACE.fullmatch(line)
        is_key = match is not None and re.split(r"[. ]", match[1])[0] in Job.model_fields
        path, sentence = (match[1], match[2]) if match and is_key else ("", line)
        mistakes.append(Wrong(path, sentence, infeasible=isinstance(error, InfeasibleError)))
    return mistakes


def infeasibility_sentences(
    problem: Problem, possible_values: Possible, fixed_names: Sequence[str], tables: Mapping[str, Any]
) -> list[str]:
    """Return a sentence for each unattainable requirement, and one if no sample meets all requirements.

    Some are a `Remark` with the change that resolves it. fixed_names: names of the extra variables, which have one
    value in the samples. tables: tables of the job.
    """
    sentences: list[str] = []
    constraints = {constraint.quantity: constraint for constraint in problem.constraints}
    for name in ("stroke", "time_ratio", "transmission_angle"):
        ends: Ends | None = getattr(possible_values, name)
        if name in constraints and ends is not None:
            sentences += _nearest_possible_remarks(problem, constraints[name], ends)
    if possible_values.turning == 0.0 and not possible_values.example_feasible:
        sentences.append(_locking_sentence(problem, tables))
    elif possible_values.sampled and not possible_values.example_feasible and not sentences:
        sentences.append(_none_meets_all_sentence(problem, possible_values, fixed_names))
    return sentences


def _none_meets_all_sentence(problem: Problem, possible_values: Possible, fixed_names: Sequence[str]) -> str:
    """Return a sentence on samples of which none meets everything: the hardest requirement, and a value to require."""
    hardest, change = "", None
    if possible_values.hardest is not None and possible_values.hardest[1] < 1.0:
        name, share = possible_values.hardest
        title = problem.quantity(name).title
        percent = f"{100.0 * share:.0f} %" if share >= 0.01 or share == 0.0 else "less than 1 %"
        hardest = f"; on its own, {title} is met by {percent} of those that rotate fully"
        constraint = next(item for item in constraints_with_floors(problem) if item.quantity == name)
        nearest = possible_values.nearest
        for word, bound in constraint.sides:
            item = None if nearest is None else relaxation_of_missed_bound(problem, constraint, word, bound, nearest)
            if item is not None:
                hardest += f", and of those that meet all others, one in ten has {item.relation} {item.with_unit}"
                change = _change_to_reachable_value(problem, constraint, word, item)
    values = f" with the job's values of {', '.join(fixed_names)}" if fixed_names else ""
    return Remark(
        f"none of {count_with_noun(possible_values.sampled, 'design')} tried{values} meets every requirement{hardest}; "
        "the search looks more closely",
        change,
    )


def _locking_sentence(problem: Problem, tables: Mapping[str, Any]) -> str:
    """Return a sentence on ranges in which no crank rotates fully: the required rod, and the remedy."""
    crank, rod, offset = problem.crank, problem.rod, problem.offset
    nearest_line = 0.0 if offset.lower <= 0.0 <= offset.upper else min(abs(offset.lower), abs(offset.upper))
    needed = crank.lower + nearest_line
    fixed = all(item.lower == item.upper for item in (crank, rod, offset))
    subject = "this crank does not rotate" if fixed else "no crank within these ranges rotates"
    rule = f"{subject} fully: the rod must be longer than crank + offset"
    at_least, at_most = ("", "") if fixed else ("at least ", "at most ")
    longer = f" by more than {1e3 * (needed - rod.upper):.6g} mm" if needed > rod.upper else ""
    if needed < rod.upper:
        needed = crank.upper + max(abs(offset.lower), abs(offset.upper))
        sentence = f"hardly any {rule.removeprefix('no ')}; allow longer rods"
    else:
        sentence = (
            f"{rule}, {at_least}{1e3 * needed:.6g} mm; got {at_most}{1e3 * rod.upper:.6g} mm; lengthen the rod{longer}"
        )
    longest = f"{math.ceil(100.0 * _LONGER * 1e3 * needed) / 100.0:.10g} mm"
    stated = tables["variables"]["rod"]
    if isinstance(stated, list) and len(stated) == 2:
        change = Change("variables.rod", [stated[0], longest], f"Allow rods up to {longest}")
    elif isinstance(stated, str | float | int):
        change = Change("variables.rod", longest, f"Lengthen the rod to {longest}")
    else:
        return sentence
    return Remark(sentence, change)


def _nearest_possible_remarks(problem: Problem, constraint: Constraint, ends: Ends) -> list[Remark]:
    """Return, in words, the nearest possible value for a requirement outside the possible range."""
    sentences: list[Remark] = []
    for word, bound in constraint.sides:
        nearest = min(max(bound, ends[0]), ends[1])
        is_beyond = {"min": bound > nearest, "max": bound < nearest, "equals": True}[word]
        item = relaxation_of_missed_bound(problem, constraint, word, bound, nearest) if is_beyond else None
        if item is not None:
            item = replace(item, alone=bool(is_constant(ends)))
            sentences.append(
                Remark(
                    item.sentence(other_requirements=_REST), _change_to_reachable_value(problem, constraint, word, item)
                )
            )
    return sentences


def _change_to_reachable_value(problem: Problem, constraint: Constraint, word: Word, item: Relaxation) -> Change:
    """Return the change that asks for the reachable value on one side of a requirement."""
    unit = problem.quantity(constraint.quantity).unit
    bounds = {side: bound * unit.factor for side, bound in constraint.sides} | {word: item.reachable_number}
    value = {side: f"{bound:.10g} {unit.symbol}" if unit.symbol else bound for side, bound in bounds.items()}
    return Change(f"constraints.{constraint.quantity}", value, f"Ask for {item.relation} {item.with_unit}")
