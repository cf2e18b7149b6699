"""The default method: sampling, zooming and polish by SQP, for any number of objectives."""

from __future__ import annotations

from ...problem.problem import Problem
from ...search.evaluation import Evaluator
from ...search.search import WIDTHS, Archive, Run, explore
from ..method import Method
from .deliver import planned


def auto(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the archive of what sampling and zooming find, which the polish starts from."""
    run.rounds = len(run.told) + 1 + len(WIDTHS) + planned(problem)
    return explore(problem, evaluators, run)


AUTO = Method(
    name="auto",
    title="Default",
    help="Exact elimination, sampling, zooming, polish by SQP, choice by hypervolume.",
    family="default",
    objectives="any",
    search=auto,
    budget=None,
    uses=("scipy", "moocore"),
    polishes=True,
)
