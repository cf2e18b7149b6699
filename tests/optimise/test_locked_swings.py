"""Swings that friction locks: no such design is feasible, and a job of none but these is refused."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.arrays import Array, Mask
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.swing.closure import swings_without_dead_point
from slidercrank.model.swing.forces import swing_curves
from slidercrank.model.swing.swing_batch import can_swing_despite_friction
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.constraint_violation import FEASIBLE
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve

WISHES = (
    {"actuator_travel": "minimise", "rod_to_crank": "maximise"},
    {"rod_mass": "minimise", "rod_to_crank": "maximise"},
    {"swing_transmission_angle": "maximise", "crank - offset": "minimise"},
)


def support(random: np.random.Generator, driver: str) -> dict[str, Any]:
    """Return the shipped support with random friction that locks a part of its designs, and geometric objectives."""
    job: dict[str, Any] = tomllib.loads(Path("runs/support.toml").read_text(encoding="utf-8"))
    if driver == "crank":
        job["motion"] |= {"driver": "crank"}
        del job["motion"]["actuator_tolerance"]
        job["friction"] = {"guide": float(random.uniform(1.5, 2.0))}
    else:
        job["friction"] = {
            name: {"radius": f"{random.uniform(200.0, 330.0):.4g} mm", "coefficient": float(random.uniform(0.7, 0.9))}
            for name in ("crank_pivot", "crank_pin")
        }
    job["constraints"] = {}
    job["objectives"] = WISHES[int(random.integers(len(WISHES)))]
    job["optimiser"] = {"method": "sobol", "evaluations": 200, "designs": 4, "seed": 1}
    return job


def sampled(given: Problem, count: int) -> tuple[Array, Mask]:
    """Return random designs that can swing as asked, and whether the search takes them for feasible."""
    found = []
    for branch in elimination_branches(given):
        evaluator = Evaluator(given, branch)
        dimensions, _, violation = evaluator.screen_designs_objectives_violation(
            np.random.default_rng(5).random((count, evaluator.dimension))
        )
        found.append(np.column_stack([dimensions, violation <= FEASIBLE]))
    every = np.concatenate(found)
    assert given.motion is not None
    every = every[swings_without_dead_point(given.mechanism, given.motion, every[:, :3])]
    return every[:, :3], every[:, 3] > 0.0


@pytest.mark.parametrize("driver", ["slider", "crank"])
def test_locked_designs_are_infeasible_whatever_the_objectives(driver: str) -> None:
    random, locked = np.random.default_rng(33), 0
    for _ in range(2):
        given = parse_job(support(random, driver))
        designs, feasible = sampled(given, 60)
        motion = given.motion
        assert motion is not None
        share = np.linspace(0.0, 1.0, 31)
        for design, fine in zip(designs[:30], feasible, strict=False):
            linkage = Linkage(design[0], design[1], design[2], given.mechanism.branch)
            ways = [swing_curves(given.mechanism, linkage, motion, share, back=back) for back in (False, True)]
            stuck = any(np.isnan(way.drive).any() for way in ways)
            locked += stuck
            assert not (fine and stuck)
        front = solve(given).designs
        assert len(front)
        drive = "peak_actuator_force_N" if driver == "slider" else "peak_actuator_torque_Nm"
        assert np.isfinite(front[[drive, "swing_energy_J", "swing_efficiency"]].to_numpy()).all()
    assert locked > 5


@pytest.mark.parametrize(("driver", "times"), [("slider", 3.0), ("crank", 1.0)])
def test_a_job_that_friction_locks_altogether_is_refused_with_how_much(driver: str, times: float) -> None:
    """With the share of the coefficients that is told some design runs, and with a little more none."""
    job = support(np.random.default_rng(7), driver)
    if driver == "slider":
        for pin in job["friction"].values():
            pin["radius"] = f"{times * float(pin['radius'].split()[0])} mm"
    else:
        job["friction"] = {"guide": 2.0}
        job["variables"] |= {"rod": ["1.55 m", "1.7 m"], "offset": ["-50 mm", "50 mm"]}
    with pytest.raises(InputError, match="friction may lock every design within the ranges that can make the") as told:
        parse_job(job)
    said = re.search(
        r"the first designs can move with (0\.\d+) of its coefficients; reduce the "
        r"friction",
        str(told.value),
    )
    assert said is not None
    share = float(said[1])
    runs = []
    for factor in (0.9 * share, min(1.0, 1.15 * share)):
        less = {**job, "friction": scaled(job["friction"], factor)}
        try:
            given = parse_job(less)
        except InputError as error:
            assert "friction may lock every design" in str(error)  # noqa: PT017
            runs.append(False)
            continue
        designs, _ = sampled(given, 4000)
        assert given.motion is not None
        runs.append(bool(can_swing_despite_friction(given.mechanism, given.motion, designs).any()))
    assert runs == [True, False]


def scaled(friction: dict[str, Any], factor: float) -> dict[str, Any]:
    """Return a table of friction with its coefficients times a factor."""
    return {
        name: {**of, "coefficient": factor * of["coefficient"]} if isinstance(of, dict) else factor * of
        for name, of in friction.items()
    }
