"""Hypervolume of every method over time, on the shipped jobs, against peers; one figure.

The peers are NSGA-II and NSGA-III of pymoo and MOEA/D of pygmo.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.algorithms.moo.nsga3 import NSGA3
from pymoo.core.callback import Callback
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize
from pymoo.util.ref_dirs import get_reference_directions

from slidercrank.optimise.front.hypervolume import choose, hypervolume, nondominated, scaling
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.job import load_job
from slidercrank.optimise.methods.registry import methods as known
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import sheets
from slidercrank.optimise.search.evaluation import FEASIBLE, Evaluator
from slidercrank.optimise.solve import solve

from .machines import Array
from .report import Row

JOBS = ("feeder", "sieve", "support")
EVALUATIONS = 20_000
"""Of the peers; ours take their own budgets."""
FIGURE = Path(__file__).parent / "output" / "methods.png"
_PENALTY = 1e3  # of the objectives' range: MOEA/D takes no constraints, so that a violation is added to all objectives


@dataclass(frozen=True)
class Course:
    """Course of a method over time. seconds, hypervolumes: (rounds,), of the default's front."""

    method: str
    seconds: Array
    hypervolumes: Array


def compare(
    jobs: tuple[str, ...] = JOBS, *, evaluations: int | None = None, methods: tuple[str, ...] | None = None
) -> list[Row]:
    """Return every method's last hypervolume of 100 designs over the default's, and draw the courses.

    evaluations: budget of all, their own by default. methods: names; by default all that take several objectives.
    """
    names = methods or tuple(name for name, method in known().items() if method.takes(4) and not method.polishes)
    rows, courses = [], {}
    for job in jobs:
        given = load_job(f"runs/{job}.toml")
        best = solve(given)
        ideal, span = scaling(best.values)
        whole = best.hypervolume
        courses[given.name] = [
            Course(
                "auto",
                *_course(
                    [*((entry.seconds, entry.hypervolume / whole) for entry in best.history), (best.seconds, 1.0)]
                ),
            )
        ]
        for name in names:
            asked = replace(given, settings=replace(given.settings, method=name, evaluations=evaluations))
            courses[given.name].append(_ours(asked, ideal, span, whole))
        for title, make in _PEERS.items():
            courses[given.name].append(_peer(title, make, given, evaluations or EVALUATIONS, ideal, span, whole))
        rows += [
            Row(f"{given.name}: {course.method} ({course.seconds[-1]:.1f} s) / auto", [float(course.hypervolumes[-1])])
            for course in courses[given.name][1:]
        ]
    _draw(courses)
    return rows


def _course(points: list[tuple[float, float]]) -> tuple[Array, Array]:
    seconds, volumes = np.array(points).T
    return seconds, volumes


def _ours(problem: Problem, ideal: Array, span: Array, whole: float) -> Course:
    told: list[Progress] = []
    front = solve(problem, progress=told.append)
    # The history has the front's own scaling, which is all but the default's where the front is as wide.
    scale = hypervolume(front.values, ideal, span) / front.hypervolume if len(front) else 0.0
    points = [(entry.seconds, entry.hypervolume * scale / whole) for entry in front.history]
    points.append((front.seconds, hypervolume(front.values, ideal, span) / whole))
    return Course(problem.settings.method, *_course(points))


class _Peer(PymooProblem):  # type: ignore[misc]
    """The reduced problem as pymoo wants it, of the first sheet: the shipped jobs have one."""

    def __init__(self, problem: Problem, *, penalised: Array | None) -> None:
        self.evaluator = Evaluator(problem, sheets(problem)[0])
        self.penalised = penalised
        limits = 0 if penalised is not None else 1
        super().__init__(
            n_var=self.evaluator.dimension, n_obj=len(problem.objectives), n_ieq_constr=limits, xl=0.0, xu=1.0
        )

    def _evaluate(self, x: Array, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
        _, objectives, violation = self.evaluator.screen(x)
        violation = np.where(np.isfinite(violation), np.maximum(violation, 0.0), 1e3)
        if self.penalised is None:
            out["F"] = np.where(np.isfinite(objectives), objectives, 1e9)
            out["G"] = (violation - FEASIBLE)[:, None]
        else:
            worse = (1.0 + violation)[:, None] * _PENALTY * self.penalised
            out["F"] = np.where((violation <= FEASIBLE)[:, None], objectives, worse)


class _Watch(Callback):  # type: ignore[misc]
    """Notes time and feasible non-dominated designs of the population after every generation."""

    def __init__(self, measure: Callable[[Array], float], worst: Array) -> None:
        super().__init__()
        self.measure, self.worst = measure, worst
        self.begin, self.watching = perf_counter(), 0.0
        self.points: list[tuple[float, float]] = []

    def notify(self, algorithm: Any) -> None:
        self.note(algorithm.pop.get("F")[algorithm.pop.get("CV")[:, 0] <= 0.0])

    def note(self, values: Array) -> None:
        now = perf_counter()
        values = values[(values < self.worst).all(axis=1)]
        self.points.append((now - self.begin - self.watching, self.measure(values)))
        self.watching += perf_counter() - now


def _directions(objectives: int, partitions: int = 7) -> Array:
    return np.asarray(get_reference_directions("das-dennis", objectives, n_partitions=partitions))


_MOEAD = "pygmo MOEA/D"
_PEERS: dict[str, Callable[[int], Any]] = {
    "pymoo NSGA-II": lambda m: NSGA2(pop_size=100),
    "pymoo NSGA-III": lambda m: NSGA3(_directions(m)),
    _MOEAD: lambda m: None,
}


class _Pygmo:
    """The reduced problem as pygmo wants it, penalised, and a generation at once."""

    def __init__(self, reduced: _Peer) -> None:
        self.reduced = reduced

    def fitness(self, x: Array) -> Array:
        return self.batch_fitness(x)

    def batch_fitness(self, x: Array) -> Array:
        out: dict[str, Any] = {}
        self.reduced._evaluate(np.asarray(x).reshape(-1, self.reduced.n_var), out)
        return np.asarray(out["F"]).ravel()

    def get_nobj(self) -> int:
        return int(self.reduced.n_obj)

    def get_bounds(self) -> tuple[list[float], list[float]]:
        return [0.0] * self.reduced.n_var, [1.0] * self.reduced.n_var


def _pygmo(reduced: _Peer, evaluations: int, seed: int, watch: _Watch) -> None:
    """Run MOEA/D of pygmo."""
    import pygmo

    size = len(_directions(reduced.n_obj))
    population = pygmo.population(pygmo.problem(_Pygmo(reduced)), size=size, seed=seed, b=pygmo.bfe())
    method = pygmo.moead_gen(gen=1, seed=seed)
    method.set_bfe(pygmo.bfe())
    algorithm = pygmo.algorithm(method)
    while population.problem.get_fevals() < evaluations:
        population = algorithm.evolve(population)
        watch.note(population.get_f())


def _peer(
    title: str,
    make: Callable[[int], Any],
    problem: Problem,
    evaluations: int,
    ideal: Array,
    span: Array,
    whole: float,
) -> Course:
    """Return the course of a peer; of larger populations the best 100 count."""

    def measure(values: Array) -> float:
        values = values[nondominated(values)]
        return hypervolume(values[choose(values, problem.settings.designs)], ideal, span) / whole

    reduced = _Peer(problem, penalised=span if title == _MOEAD else None)
    watch = _Watch(measure, ideal + 100.0 * span)
    seed = problem.settings.seed
    if title == _MOEAD:
        _pygmo(reduced, evaluations, seed, watch)
    else:
        minimize(
            reduced, make(len(problem.objectives)), ("n_eval", evaluations), seed=seed, callback=watch, verbose=False
        )
    return Course(title, *_course(watch.points))


def _draw(courses: dict[str, list[Course]]) -> None:
    """Write the figure: a panel for each job, a line for each method."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.0 * len(courses), 4.5), layout="constrained")
    panels = figure.subplots(1, len(courses), squeeze=False)[0]
    for panel, (title, lines) in zip(panels, courses.items(), strict=True):
        for index, course in enumerate(lines):
            style = "--" if course.method.startswith("py") else "-"
            panel.plot(course.seconds, course.hypervolumes, style, color=f"C{index % 10}", label=course.method)
            panel.plot(course.seconds[-1], course.hypervolumes[-1], ".", color=f"C{index % 10}")
        panel.set(xscale="log", xlabel="time, s", title=title, ylim=(0.7, 1.01))
        panel.grid(visible=True, alpha=0.3)
    panels[0].set_ylabel("hypervolume / that of the default's front")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    FIGURE.parent.mkdir(exist_ok=True)
    figure.savefig(FIGURE, dpi=150)
    print(f"figure: {FIGURE}")
