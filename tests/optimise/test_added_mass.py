"""Jobs with an added mass: their fronts, proofs and refusals are those of a heavier slider."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.optimise.certificate.certify import certify_designs

JOB: dict[str, Any] = {
    "name": "feed pump",
    "mechanism": {"speed": "300 rpm", "slider": {"mass": "4 kg"}, "rod": {"mass": "1 kg"}},
    "load": [{"added_mass": "6 kg"}],
    "variables": {"crank": ["40 mm", "60 mm"], "rod": ["150 mm", "300 mm"], "offset": ["0 mm", "20 mm"]},
    "constraints": {"stroke": {"min": "90 mm", "max": "110 mm"}},
    "objectives": {"peak_torque": "minimise", "transmission_angle": "maximise"},
    "optimiser": {"designs": 20},
}


def heavier() -> dict[str, Any]:
    """Return the job with the mass on the slider."""
    job = copy.deepcopy(JOB)
    del job["load"]
    job["mechanism"]["slider"]["mass"] = "10 kg"
    return job


def test_the_front_and_its_certificate_are_those_of_a_heavier_slider() -> None:
    problems = [sc.problem(job) for job in (JOB, heavier())]
    fronts = [sc.solve(problem) for problem in problems]
    np.testing.assert_allclose(fronts[0].values, fronts[1].values, rtol=1e-6)
    proofs = [certify_designs(front.problem, front.dimensions, epsilon=0.05, seconds=60.0) for front in fronts]
    assert proofs[0].proven
    assert proofs[0].epsilon == pytest.approx(proofs[1].epsilon, rel=1e-3)


def test_an_added_mass_may_vary() -> None:
    job = copy.deepcopy(JOB)
    job["variables"]["load.1.added_mass"] = ["2 kg", "8 kg"]
    problem = sc.problem(job)
    designs = np.array([[0.05, 0.2, 0.01, 2.0], [0.05, 0.2, 0.01, 8.0]])
    values, jacobian = problem.evaluate(designs, ["peak_torque"], gradients=True)
    light, heavy = values[:, 0]
    # Torque is linear in the mass where the peak keeps its angle: both slopes enclose the difference.
    slope = (heavy - light) / 6.0
    assert min(jacobian[:, 0, 3]) - 1e-9 <= slope <= max(jacobian[:, 0, 3]) + 1e-9
