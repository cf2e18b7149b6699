"""Proof that no design meets all requirements of a job, because every box of designs violates one."""

import time
from collections.abc import Callable

import numpy as np

from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..search.elimination import EliminationBranch, elimination_branches
from ..search.evaluation import Evaluator
from .box_bounds import Boxes
from .box_conditions import can_rule_out_boxes
from .branch_and_bound import Tree, bounding_threads

SECONDS = 5.0
_BATCH = 2048
_MOST = 400_000  # bounded boxes; a count gives reproducible answers unless the machine is very slow


def prove_infeasible(problem: Problem, *, seconds: float = SECONDS, poll: Callable[[], None] = lambda: None) -> bool:
    """Return whether it is proven that no design within the job's bounds meets all its requirements.

    Requirements that cannot be bounded over a range of designs are ignored: the others must contradict each other.
    False if a design meets all of these, or if time runs out first: feasibility is then unknown. poll: called many
    times a second; any error it raises ends the search.
    """
    start = time.perf_counter()
    unit_span = np.ones(len(problem.objectives))
    tree = Tree.of_branches(
        [
            Boxes(_requirement_evaluator(problem, branch), unit_span, objectives=False)
            for branch in elimination_branches(problem)
        ]
    )
    with bounding_threads() as threads:
        fresh = [(index, *tree.initial_boxes(index)) for index in range(len(tree.branches))]
        while fresh:
            for index, lower, upper in fresh:
                poll()
                boxes = tree.bound_boxes(index, lower, upper, threads)
                n = len(boxes.lower)
                if (
                    n
                    and (
                        tree.branches[index].evaluator.screen_designs_objectives_violation(boxes.trial)[2] <= FEASIBLE
                    ).any()
                ):
                    return False
                tree.add_boxes(index, boxes, np.zeros((n, 0)), np.prod(boxes.upper - boxes.lower, axis=1), 0)
            if not len(tree):
                return True
            late = time.perf_counter() - start > seconds or tree.bounded > _MOST
            rows = tree.rows_of_largest_excess(_BATCH)
            if late or not len(rows):
                return False
            fresh = tree.split_boxes(rows)
    return not len(tree)


def _requirement_evaluator(problem: Problem, branch: EliminationBranch) -> Evaluator:
    """Return an evaluator of the requirements that rule out boxes; it never rules out a design that meets them."""
    evaluator = Evaluator(problem, branch)
    evaluator.constraints = tuple(item for item in evaluator.constraints if can_rule_out_boxes(problem, item))
    return evaluator
