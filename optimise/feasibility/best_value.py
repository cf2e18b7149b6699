"""Best value of one quantity subject to all requirements."""

from dataclasses import dataclass, replace
from functools import partial

from ...model.arrays import Array
from ...model.cycle.stroke_times import massless_machine
from ..engine.engine import Engine
from ..methods.auto.auto import AUTO, search_front_by_method
from ..problem.problem import Problem, Settings, Variant
from ..problem.requirements import Constraint, Objective, Sense
from ..search.checkpoints import Checkpoints
from ..search.elimination import elimination_branches
from ..search.evaluation import Evaluator
from ..search.mirrored_branches import drop_mirrored_branches
from ..search.sample_and_zoom import (
    BANDS,
    ENOUGH,
    Archive,
    Callback,
    Run,
    descents_stay_infeasible,
    sample_and_zoom,
    samples_per_branch,
)
from ..search.sampling import first_samples

_SAMPLES = 2048
"""Samples per round if only the dimensions count."""
_FEW = 1024
"""Samples per round if all requirements count: evaluating cycles takes long, and descents from a few good samples
suffice."""


@dataclass(frozen=True)
class Best:
    """Best value (SI) of a quantity, and a design (3 + v,) that attains it."""

    value: float
    design: Array


def find_best_design(
    problem: Problem,
    checkpoints: Checkpoints | None = None,
    engine: Engine | None = None,
    report: Callback | None = None,
) -> Best | None:
    """Return the best value of a problem's only objective, None if nothing is feasible.

    checkpoints, engine: those of the calling search. report: receives the progress of this search.
    """
    combined = [
        Evaluator(problem, branch, checkpoints, engine)
        for branch in drop_mirrored_branches(problem, elimination_branches(problem))
    ]
    run = Run(problem, 1, report, checkpoints or Checkpoints(), stages=report)
    light = replace(problem, settings=replace(problem.settings, samples=problem.settings.samples or _FEW))
    front = search_front_by_method(replace(AUTO, search=partial(_search_in_stages, problem)), light, combined, run)
    if front is None:
        return None
    quantity = problem.quantity(problem.objectives[0].quantity)
    value = float(quantity.evaluate(front.part(0).mechanism, front.dimensions[:1]).values[0])
    return Best(value, front.dimensions[0])


def _search_in_stages(full: Problem, light: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the archive of a few samples if they suffice, otherwise that of a full search.

    A few samples suffice if enough are feasible, or if no design can be feasible.

    With one objective, descents from the best few samples reach the best value.
    """
    if not any(evaluator.loose for evaluator in evaluators):
        archive = run.archive = Archive.empty(1)
        count = samples_per_branch(light.settings.samples or _FEW, evaluators)
        found = archive.screen_all(
            (index, evaluator, first_samples(count, evaluator.dimension, light.settings.seed, index))
            for index, evaluator in enumerate(evaluators)
        )
        if found >= ENOUGH or (not found and descents_stay_infeasible(light, evaluators, BANDS[-2])):
            run.report_round("sampling", evaluators, archive)
            return archive
    return sample_and_zoom(full, evaluators, run)


def find_best_dimensions(problem: Problem) -> Best | None:
    """Return the best value of a problem's only objective: a stroke, time ratio or other closed form.

    The design meets the requirements on the dimensions and the transmission angle's floor; loads and masses are
    ignored. None if there is no such design. The search takes about a tenth of a second.
    """
    light = reduce_to_dimensions(problem)
    return find_best_design(replace(light, settings=replace(light.settings, samples=_SAMPLES)))


def with_single_objective(problem: Problem, name: str, sense: Sense, target: float | None = None) -> Problem:
    """Return the problem with one quantity as its only objective."""
    objective = Objective(quantity=name, sense=sense, target=target)
    return replace(problem, objectives=(objective,), settings=Settings(designs=1, seed=problem.settings.seed))


def reduce_to_dimensions(problem: Problem) -> Problem:
    """Return the problem for a massless machine, with only the requirements on the dimensions.

    The stroke times stay the same.

    Choices that affect neither the dimensions nor their requirements are merged.
    """
    parts = list(dict.fromkeys(_reduce_part_to_dimensions(part) for part in problem.parts()))
    if len(parts) == 1:
        return parts[0]
    variants = tuple(
        Variant(
            labels=(str(index),),
            mechanism=part.mechanism,
            crank=part.crank,
            rod=part.rod,
            offset=part.offset,
            limits=part.constraints,
        )
        for index, part in enumerate(parts)
    )
    return replace(parts[0], constraints=(), choices=("dimensions",), variants=variants)


def rules_on_dimensions(problem: Problem) -> tuple[Constraint, ...]:
    """Return the constraints on quantities that depend on crank, rod and offset alone."""
    return tuple(c for c in problem.constraints if problem.quantity(c.quantity).depends_only_on_dimensions)


def _reduce_part_to_dimensions(part: Problem) -> Problem:
    machine = massless_machine(part.mechanism)
    custom = tuple(quantity for quantity in part.own if quantity.depends_only_on_dimensions)
    return replace(part, mechanism=machine, constraints=rules_on_dimensions(part), own=custom, costs=None)
