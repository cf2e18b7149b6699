"""Nothing feasible: which requirements contradict each other, and how near one can get."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .elimination import sheets
from .engine.engine import Engine
from .evaluation import FEASIBLE, Evaluator, Rows, constraints_of
from .ledger import Ledger, floats
from .problem import Constraint, Objective, Problem, Sense, Settings
from .recorded import polished
from .sampling import first_samples
from .stationarity import Array

_SAMPLES = 16384
_RANKED = 2048
_STARTS = 24


@dataclass(frozen=True)
class Relaxation:
    """One requirement that alone stands in the way, and what can be had when all others are kept (shown units)."""

    quantity: str
    relation: str
    asked: float
    reachable: float
    unit: str
    title: str

    def sentence(self) -> str:
        """Return the relaxation in words."""
        unit = f" {self.unit}" if self.unit else ""
        reach = {"at least": "at most", "at most": "at least", "exactly": "at the nearest"}[self.relation]
        return (
            f"{self.title} {self.relation} {self.asked:.6g}{unit} is asked, "
            f"{reach} {self.reachable:.6g}{unit} can be had with all else kept"
        )


@dataclass(frozen=True)
class Diagnosis:
    """What a search for feasible designs found.

    feasible: designs (n, 3 + v), SI, that are feasible if there are any after all. relaxations: requirements of which
    giving up any one is enough. message: the contradiction in words.
    """

    feasible: Array
    relaxations: tuple[Relaxation, ...]
    message: str


class _Violations:
    """Presents all constraint rows as the pieces of one objective, to be made as small as possible."""

    def __init__(self, evaluator: Evaluator) -> None:
        self.inner = evaluator

    def valid(self, u: Array) -> NDArray[np.bool_]:
        return self.inner.valid(u)

    def exact(self, u: Array) -> tuple[Rows, Rows]:
        _, limits = self.inner.exact(u)
        goals = Rows(limits.values, limits.gradients, limits.labels, np.zeros(len(limits.owner), np.int64))
        n, k = u.shape
        return goals, Rows(np.zeros((n, 0)), np.zeros((n, 0, k)), np.zeros((n, 0)), np.zeros(0, np.int64))


def diagnose(
    problem: Problem,
    best: Callable[[Problem], float | None],
    ledger: Ledger | None = None,
    engine: Engine | None = None,
) -> Diagnosis:
    """Return feasible designs after all, or which requirements contradict each other.

    best: gives the best value (SI) of a problem with one objective, None if it is infeasible too. ledger, engine: of
    the search that wants to know it. First the greatest relative violation is minimised from many starts, without
    eliminating anything. If it stays positive, each requirement in turn becomes the objective of the problem without
    it. Both searches are local from many starts: strong evidence; `certificate.infeasible` gives the proof where it
    can.
    """
    feasible, turning, nearest = _least_violation(problem, ledger, engine)
    if len(feasible):
        return Diagnosis(feasible, (), "")
    if not turning:
        message = "no rod in its range exceeds crank + |offset|, so no crank turns fully; lengthen the rod's range"
        return Diagnosis(feasible, (), message)
    relaxations = []
    for constraint in constraints_of(problem):
        others = tuple(item for item in constraints_of(problem) if item is not constraint)
        for relation, sense, bound in _sides(constraint):
            target = bound if sense == "target" else None
            wanted = Objective(quantity=constraint.quantity, sense=sense, target=target)
            reached = best(
                replace(
                    problem,
                    constraints=others,
                    objectives=(wanted,),
                    settings=Settings(designs=1, seed=problem.settings.seed),
                )
            )
            of = problem.quantity(constraint.quantity)
            unit = of.unit
            if reached is not None and not _meets(relation, reached, bound):
                relaxations.append(
                    Relaxation(
                        constraint.quantity, relation, bound * unit.factor, reached * unit.factor, unit.symbol, of.title
                    )
                )
    sentences = [item.sentence() for item in relaxations]
    if problem.slow_stroke is not None:
        loose = replace(
            problem,
            slow_stroke=None,
            objectives=problem.objectives[:1],
            settings=Settings(designs=1, seed=problem.settings.seed),
        )
        if best(loose) is not None:
            other = "inward" if problem.slow_stroke == "outward" else "outward"
            sentences.append(
                f"slow stroke {problem.slow_stroke} is asked, with the {other} one slow or neither all else can be kept"
            )
    if sentences:
        message = "no design meets all requirements: " + "; ".join(sentences)
    else:
        message = (
            "no design meets all requirements, and giving up any single one is not enough; "
            f"nearest to all of them is {nearest}; widen the ranges of crank, rod and offset or relax several"
        )
    return Diagnosis(feasible, tuple(relaxations), message)


def _least_violation(problem: Problem, ledger: Ledger | None, engine: Engine | None) -> tuple[Array, bool, str]:
    """Return feasible designs, whether any sampled design turns fully, and the design nearest to feasible in words."""
    feasible = []
    turning = False
    nearest, least = "", np.inf
    for index, sheet in enumerate(sheets(problem, eliminate=False)):
        evaluator = Evaluator(problem, sheet, ledger, engine)
        u = first_samples(_SAMPLES, evaluator.dimension, problem.settings.seed, 100 + index)
        u = u[evaluator.valid(u)]
        if not len(u):
            continue
        turning = True
        u = u[:: max(1, len(u) // _RANKED)]
        starts = u[np.argsort(_greatest(evaluator, u), kind="stable")[:_STARTS]]
        found = polished(evaluator, starts, np.ones(1), shown=_Violations(evaluator))
        dimensions = sheet.dimensions(found.u)
        feasible.append(dimensions[found.values[:, 0] <= FEASIBLE])
        row = int(np.argmin(found.values[:, 0]))
        if found.values[row, 0] < least:
            least = float(found.values[row, 0])
            nearest = "crank {:.6g} mm, rod {:.6g} mm, offset {:.6g} mm".format(*(1e3 * dimensions[row, :3]))
    return np.concatenate(feasible) if feasible else np.zeros((0, 3)), turning, nearest


def _greatest(evaluator: Evaluator, u: Array) -> Array:
    """Return the greatest relative violation (n,) of points."""

    def greatest() -> tuple[Array]:
        return (evaluator.exact(u)[1].values.max(axis=1, initial=0.0),)

    return floats(evaluator.ledger.step("violation", (u,), greatest, evaluator)[0])


def _sides(constraint: Constraint) -> list[tuple[str, Sense, float]]:
    """Return the sides of a constraint: relation, how to come nearest to it, bound (SI)."""
    if constraint.equality and constraint.lower is not None:
        return [("exactly", "target", constraint.lower)]
    sides: list[tuple[str, Sense, float]] = []
    if constraint.lower is not None:
        sides.append(("at least", "maximise", constraint.lower))
    if constraint.upper is not None:
        sides.append(("at most", "minimise", constraint.upper))
    return sides


def _meets(relation: str, reached: float, bound: float) -> bool:
    slack = FEASIBLE * (abs(bound) or 1.0)
    if relation == "at least":
        return reached >= bound - slack
    if relation == "at most":
        return reached <= bound + slack
    return abs(reached - bound) <= slack
