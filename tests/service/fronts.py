"""Fronts made without a search, and a small job: what the tests of the service show, store and read."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analysis_columns
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Constraint, Objective, Range, Sense

FOUR = ("time_ratio", "peak_torque", "transmission_angle", "position_error")
_SENSES: dict[str, Sense] = {"time_ratio": "maximise", "transmission_angle": "maximise"}
BAR = Bar(width=0.03, depth=0.02, density=7800.0)
MACHINE = Mechanism(
    speed=10.0 * math.pi,
    crank=BAR,
    rod=BAR,
    slider_mass=1.95,
    gravity=(0.0, -9.81),
    loads=(StrokeForce(outward=-200.0, inward=0.0),),
    tolerances=Tolerances(
        crank=Tolerance(absolute=5e-5), rod=Tolerance(absolute=1e-4), crank_angle=Tolerance(absolute=math.radians(0.1))
    ),
)

JOB = """
name = "Short test [job]"
[mechanism]
speed = "300 rpm"
slider = { mass = "2 kg" }
[variables]
crank = ["20 mm", "200 mm"]
rod = ["60 mm", "600 mm"]
offset = ["0 mm", "200 mm"]
[constraints]
stroke = { equals = "280 mm" }
transmission_angle = { min = "40 deg" }
[objectives]
time_ratio = "maximise"
transmission_angle = "maximise"
[optimiser]
designs = 8
samples = 512
"""

BARS = '{ width = "30 mm", depth = "20 mm", density = "7800 kg/m^3" }'
VARIED = (
    JOB.replace("slider =", f"crank = {BARS}\nrod = {BARS}\nslider =")
    .replace("[variables]", '[variables]\nmechanism.rod.width = ["20 mm", "40 mm"]')
    .replace("[objectives]", '[objectives]\npeak_torque = "minimise"')
)
"""The small job with the width of the rod as a variable."""


def problem(names: tuple[str, ...] = FOUR, mechanism: Mechanism = MACHINE) -> Problem:
    """Return a problem of a vibrating sieve with these objectives."""
    return Problem(
        name="Vibrating sieve",
        mechanism=mechanism,
        crank=Range(lower=0.08, upper=0.16),
        rod=Range(lower=0.2, upper=0.6),
        offset=Range(lower=0.0, upper=0.15),
        objectives=tuple(Objective(quantity=name, sense=_SENSES.get(name, "minimise")) for name in names),
        constraints=(Constraint(quantity="transmission_angle", lower=math.radians(30.0)),),
    )


def front(names: tuple[str, ...] = FOUR, *, designs: int = 20, mechanism: Mechanism = MACHINE) -> ParetoFront:
    """Return the non-dominated ones of random designs that turn fully, `designs` at most."""
    known = _front(names, designs, mechanism)
    return replace(known, columns=dict(known.columns), dimensions=known.dimensions.copy(), values=known.values.copy())


@cache
def _front(names: tuple[str, ...], designs: int, mechanism: Mechanism) -> ParetoFront:
    asked = problem(names, mechanism)
    random = np.random.default_rng(7)
    box = np.array([[0.08, 0.2, 0.0], [0.16, 0.6, 0.15]])
    dimensions = box[0] + (box[1] - box[0]) * random.random((400, 3))
    dimensions = dimensions[dimensions[:, 1] * math.cos(math.radians(30.0)) > dimensions[:, 0] + dimensions[:, 2]]
    dimensions *= (0.28 / Linkage(*dimensions.T).stroke)[:, None]
    signs = [-1.0 if objective.sense == "maximise" else 1.0 for objective in asked.objectives]
    values = np.stack(
        [
            sign * QUANTITIES[objective.quantity].evaluate(mechanism, dimensions).values
            for sign, objective in zip(signs, asked.objectives, strict=True)
        ],
        axis=1,
    )
    better = np.all(values[:, None] <= values, axis=2) & np.any(values[:, None] < values, axis=2)
    rows = np.flatnonzero(~better.any(axis=0))[:designs]
    rows = rows[np.argsort(values[rows, 0])]
    columns = analysis_columns(mechanism, dimensions[rows])
    columns["slack_least_transmission_angle_deg"] = columns["least_transmission_angle_deg"] - 30.0
    columns["residual"] = np.full(len(rows), 1e-9)
    columns["status"] = np.full(len(rows), "stationary")
    m = len(names)
    slopes = np.concatenate([np.eye(m - 1), -np.ones((1, m - 1))])
    return ParetoFront(
        problem=asked,
        status="done",
        message=f"{len(rows)} designs, 400 evaluated",
        columns=columns,
        dimensions=dimensions[rows],
        values=values[rows],
        goals=tuple((np.arange(m, dtype=np.float64), slopes) for _ in rows),
        active=tuple(np.zeros((0, m - 1)) for _ in rows),
        hypervolume=0.5,
        history=(Progress("sampling", 1, 1, 400, len(dimensions), 0.5, 0.1),),
        evaluations=400,
        seconds=0.1,
        seed=1,
        versions={"slidercrank": "0"},
    )


def empty_front(status: str, message: str) -> ParetoFront:
    """Return a front without designs."""
    full = front(designs=1)
    return replace(
        full,
        status=status,  # type: ignore[arg-type]
        message=message,
        columns={},
        dimensions=np.zeros((0, 3)),
        values=np.zeros((0, 4)),
        goals=(),
        active=(),
        hypervolume=0.0,
    )


def job_file(folder: Path) -> Path:
    """Return the small job as a file."""
    file = folder / "short.toml"
    file.write_text(JOB, encoding="utf-8")
    return file


def replace_solve(monkeypatch: pytest.MonkeyPatch, result: ParetoFront) -> None:
    """Let `solve` give a front without a search, after telling of its rounds."""

    def solve(_: Problem, *, progress: object = None, **_more: object) -> ParetoFront:
        for at in result.history:
            progress(at)  # type: ignore[operator]
        return result

    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
