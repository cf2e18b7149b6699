"""Hypervolume of every method over time, on the shipped jobs, against peers; one figure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

import numpy as np

from slidercrank.optimise.front.dominance import nondominated
from slidercrank.optimise.front.hypervolume import choose_designs_by_hypervolume, hypervolume, ideal_and_range
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.job import load_job
from slidercrank.optimise.methods.registry import methods_by_name as known
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.solve import solve

from .machines import Array
from .peers import EVALUATIONS, PEERS, run_peer
from .report import Row

JOBS = ("feeder", "sieve", "turning_support")
FOLDERS = {"turning_support": "tests/data"}
FIGURE = Path(__file__).parent / "output" / "methods.png"


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
    names = methods or tuple(
        name for name, method in known().items() if method.supports_objective_count(4) and not method.polishes
    )
    rows, courses = [], {}
    for job in jobs:
        given = load_job(FOLDERS.get(job, "runs") + f"/{job}.toml")
        best = solve(given)
        ideal, span = ideal_and_range(best.values)
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
        for title in PEERS:
            courses[given.name].append(_peer(title, given, evaluations or EVALUATIONS, ideal, span, whole))
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


class _Watch:
    """Notes time and feasible non-dominated designs of the population after every generation."""

    def __init__(self, measure: Callable[[Array], float], worst: Array) -> None:
        self.measure, self.worst = measure, worst
        self.begin, self.watching = perf_counter(), 0.0
        self.points: list[tuple[float, float]] = []

    def note(self, values: Array) -> None:
        now = perf_counter()
        values = values[(values < self.worst).all(axis=1)]
        self.points.append((now - self.begin - self.watching, self.measure(values)))
        self.watching += perf_counter() - now


def _peer(
    title: str,
    problem: Problem,
    evaluations: int,
    ideal: Array,
    span: Array,
    whole: float,
) -> Course:
    """Return the course of a peer; of larger populations the best 100 count."""

    def measure(values: Array) -> float:
        values = values[nondominated(values)]
        return hypervolume(values[choose_designs_by_hypervolume(values, problem.settings.designs)], ideal, span) / whole

    watch = _Watch(measure, ideal + 100.0 * span)
    run_peer(title, problem, span, watch.note, seed=problem.settings.seed, evaluations=evaluations)
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
