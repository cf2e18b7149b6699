"""Content of an incomplete job: ranges, requirements, and the machine once it can be read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from ...model.cycle.stroke_times import massless_machine
from ...model.errors import InputError
from ...model.machine.mechanism import Branch, Mechanism
from ...objectives.registry import QUANTITIES
from ...optimise.job.crank_speed import SPEED_KEYS, CrankSpeedPart
from ...optimise.job.quantities import ConstraintsPart, constraints_of
from ...optimise.job.values import RangeOf
from ...optimise.job.varying import ends_of
from ...optimise.problem.problem import Problem
from ...optimise.problem.requirements import Constraint, Objective, Range
from ...optimise.search.elimination import require_slow_side

_MOST_POINTS = 100
"""Points of tabulated loads; each is a breakpoint of every curve, and costs its share of every sampled design."""


def geometry(tables: Mapping[str, Any], full_problem: Problem | None) -> Problem | None:
    """Return the problem in crank, rod and offset that a job states; None while there is none.

    None while their ranges cannot be read, and for a swing.

    full_problem: problem of the whole job, if it is valid; the first of several options counts. Requirements that need
    the machine are omitted without it; those that only a search can afford are always omitted.
    """
    ranges, motion = ranges_of(tables.get("variables")), tables.get("motion")
    if ranges is None or (isinstance(motion, Mapping) and motion.get("kind") == "swing"):
        return None
    machine = _turning(tables.get("mechanism")) if full_problem is None else full_problem.part(0).mechanism.nominal
    with_machine = full_problem is not None and sum(len(load.knots()[0]) for load in machine.loads) <= _MOST_POINTS
    problem = Problem(
        name="preview",
        mechanism=machine,
        crank=ranges["crank"],
        rod=ranges["rod"],
        offset=ranges["offset"],
        objectives=(Objective(quantity="stroke", sense="minimise"),),
    )
    readable = _constraints(tables.get("constraints"), with_machine=with_machine)
    constraints = tuple(c for c in readable if not problem.quantity(c.quantity).undefined_because([machine]))
    if not with_machine:
        problem = replace(problem, mechanism=massless_machine(machine))
    return _with_slow_stroke(replace(problem, constraints=constraints), tables.get("constraints"))


def left_out(tables: Mapping[str, Any], problem: Problem) -> list[str]:
    """Return the names of a job's requirements that its geometry does not have."""
    stated = tables.get("constraints")
    used = {constraint.quantity for constraint in problem.constraints} | {"slow_stroke"}
    return [str(name)[:60] for name in stated if name not in used][:40] if isinstance(stated, Mapping) else []


def _with_slow_stroke(problem: Problem, part: object) -> Problem:
    """Return the problem with the slow stroke that a job requires, if its ranges allow one."""
    stroke = part.get("slow_stroke") if isinstance(part, Mapping) else None
    if stroke not in ("outward", "inward"):
        return problem
    try:
        with_stroke = replace(problem, slow_stroke=stroke)
        require_slow_side(with_stroke, (with_stroke,))
    except InputError:
        return problem
    return with_stroke


def is_closed(name: str) -> bool:
    """Whether a quantity follows from the three dimensions alone."""
    return name in QUANTITIES and QUANTITIES[name].of_dimensions


def _turning(part: object) -> Mechanism:
    """Return a massless machine with the crank speed that a job states, else 1 rad/s."""
    mechanism = part if isinstance(part, Mapping) else {}
    branch: Branch = "crossed" if mechanism.get("branch") == "crossed" else "open"
    for keys in ((*SPEED_KEYS, "direction", "speed_profile"), (*SPEED_KEYS, "direction")):
        with suppress(InputError, ValidationError):
            part = CrankSpeedPart.model_validate({key: mechanism[key] for key in keys if key in mechanism})
            profile = None if part.speed_profile is None else part.speed_profile.build()
            return Mechanism(speed=part.crank_speed(turns=1) or 1.0, branch=branch, speed_profile=profile)
    return Mechanism(speed=1.0, branch=branch)


def ranges_of(part: object) -> dict[str, Range] | None:
    """Return the ranges of the dimensions in a table of variables; None while one of them cannot be read."""
    if not isinstance(part, Mapping):
        return None
    ranges = {}
    for name in ("crank", "rod", "offset"):
        try:
            range_ = RangeOf("any" if name == "offset" else "positive").read(part.get(name))
        except InputError:
            return None
        ranges[name] = ends_of(range_)
    return ranges


def _constraints(part: object, *, with_machine: bool) -> Iterator[Constraint]:
    """Yield the requirements that can be read and checked within a moment."""
    for name, bounds in part.items() if isinstance(part, Mapping) else ():
        if name not in QUANTITIES or not (with_machine or is_closed(name)):
            continue
        try:
            yield from constraints_of(ConstraintsPart.model_validate({name: bounds}))
        except (InputError, ValidationError):
            continue
