"""Content of an incomplete job: ranges, requirements, and the machine as soon as it can be read."""

from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from ...model.cycle.stroke_times import massless_machine
from ...model.errors import InputError
from ...model.machine.mechanism import Branch, Mechanism
from ...objectives.registry import QUANTITIES
from ...objectives.units import Sign
from ...optimise.job.constraints_and_objectives import ConstraintsPart, constraints_of
from ...optimise.job.crank_speed import SPEED_KEYS, CrankSpeedPart
from ...optimise.job.named_files import table_in
from ...optimise.job.value_types import RangeOf
from ...optimise.job.variables_and_variants import range_of_dimension
from ...optimise.problem.problem import Problem
from ...optimise.problem.requirements import Constraint, Objective, Range
from ...optimise.search.elimination import require_offset_for_slow_stroke

_MOST_POINTS = 100
"""Maximum points of tabulated loads: each is a breakpoint of every curve, and adds to the cost of every sample."""


def problem_in_crank_rod_offset(tables: Mapping[str, Any], full_problem: Problem | None) -> Problem | None:
    """Return the problem in crank, rod and offset that a job states; None while there is none.

    None while their ranges cannot be read, for a swing, and for a cylinder that turns.

    full_problem: problem of the whole job, if it is valid; of several options the first is used. Requirements that need
    the machine are omitted without it; those too expensive for a preview are always omitted.
    """
    ranges, requirements = ranges_of(tables), table_in(tables, "constraints")
    stated = table_in(tables, "mechanism")
    if ranges is None or "inversion" in stated or table_in(tables, "motion").get("kind") == "swing":
        return None
    machine = _massless_machine(stated) if full_problem is None else full_problem.part(0).mechanism.nominal
    with_machine = full_problem is not None and sum(len(load.knots()[0]) for load in machine.loads) <= _MOST_POINTS
    problem = Problem(
        name="preview",
        mechanism=machine,
        crank=ranges["crank"],
        rod=ranges["rod"],
        offset=ranges["offset"],
        objectives=(Objective(quantity="stroke", sense="minimise"),),
    )
    readable = _checkable_constraints(requirements, with_machine=with_machine)
    constraints = tuple(c for c in readable if not problem.quantity(c.quantity).undefined_because([machine]))
    if not with_machine:
        problem = replace(problem, mechanism=massless_machine(machine))
    return _with_slow_stroke(replace(problem, constraints=constraints), requirements.get("slow_stroke"))


def omitted_requirements(tables: Mapping[str, Any], problem: Problem) -> list[str]:
    """Return the names of a job's requirements that are missing from its geometry problem."""
    return requirement_names(tables, {constraint.quantity for constraint in problem.constraints} | {"slow_stroke"})


def requirement_names(tables: Mapping[str, Any], without: Collection[str] = ()) -> list[str]:
    """Return at most 40 names of a job's requirements, shortened. without: names to omit."""
    return [str(name)[:60] for name in table_in(tables, "constraints") if name not in without][:40]


def _with_slow_stroke(problem: Problem, stroke: Any) -> Problem:
    """Return the problem with the slow stroke that a job requires, if its ranges allow one."""
    if stroke not in ("outward", "inward"):
        return problem
    try:
        with_stroke = replace(problem, slow_stroke=stroke)
        require_offset_for_slow_stroke(with_stroke, (with_stroke,))
    except InputError:
        return problem
    return with_stroke


def depends_on_dimensions_only(name: str) -> bool:
    """Whether a quantity depends only on the three dimensions."""
    return name in QUANTITIES and QUANTITIES[name].depends_only_on_dimensions


def _massless_machine(mechanism: Mapping[str, Any]) -> Mechanism:
    """Return a massless machine at the crank speed of a job, or at 1 rad/s."""
    branch: Branch = "crossed" if mechanism.get("branch") == "crossed" else "open"
    for keys in ((*SPEED_KEYS, "direction", "speed_profile"), (*SPEED_KEYS, "direction")):
        with suppress(InputError, ValidationError):
            part = CrankSpeedPart.model_validate({key: mechanism[key] for key in keys if key in mechanism})
            profile = None if part.speed_profile is None else part.speed_profile.build()
            return Mechanism(speed=part.crank_speed(turns=1) or 1.0, branch=branch, speed_profile=profile)
    return Mechanism(speed=1.0, branch=branch)


def ranges_of(tables: Mapping[str, Any]) -> dict[str, Range] | None:
    """Return the ranges of the dimensions of a job; None if any cannot be read."""
    stated = table_in(tables, "variables")
    signs: dict[str, Sign] = {"crank": "positive", "rod": "positive", "offset": "any"}
    try:
        return {name: range_of_dimension(RangeOf(sign).read(stated.get(name))) for name, sign in signs.items()}
    except InputError:
        return None


def _checkable_constraints(stated: Mapping[str, Any], *, with_machine: bool) -> Iterator[Constraint]:
    """Yield the requirements that can be read and checked quickly."""
    for name, bounds in stated.items():
        if name not in QUANTITIES or not (with_machine or depends_on_dimensions_only(name)):
            continue
        try:
            yield from constraints_of(ConstraintsPart.model_validate({name: bounds}))
        except (InputError, ValidationError):
            continue
