"""Proofs that nothing is feasible: given where requirements contradict each other, never where a design meets them."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.optimise.certificate.infeasibility_certificate import prove_infeasible
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from tests.optimise.problems import JOBS, Bounds, degrees, problem, shipped

pytestmark = pytest.mark.usefixtures("little")

CONTRADICTIONS: tuple[dict[str, Bounds], ...] = (
    {"time_ratio": 1.5, "transmission_angle": (degrees(40.0), None)},
    {"time_ratio": (1.5, None), "transmission_angle": (degrees(40.0), None)},
    {"time_ratio": (1.5, None), "transmission_angle": (degrees(28.0), None)},
    {"stroke": 0.2, "peak_torque": (None, 15.0)},
    {"stroke": 0.2, "peak_torque": (None, 0.5), "peak_slider_speed": (None, 0.5)},
    {"rod_to_offset": 3.2, "transmission_angle": (degrees(40.0), None), "time_ratio": (1.4, None)},
    {"stroke": 0.58},
)


@pytest.mark.parametrize("held", CONTRADICTIONS)
def test_a_contradiction_is_proven(held: dict[str, Bounds]) -> None:
    assert prove_infeasible(problem({"peak_torque": "minimise"}, held), seconds=60.0)


def test_a_rod_that_is_too_short_for_any_crank_is_proven() -> None:
    given = problem({"peak_torque": "minimise"}, {"stroke": 0.2}, crank=(0.15, 0.2), rod=(0.06, 0.1))
    assert prove_infeasible(given)


@pytest.mark.parametrize(("stroke", "infeasible"), [(0.3, True), (0.2053607, False)])
def test_given_dimensions_either_have_the_stroke_or_not(stroke: float, infeasible: bool) -> None:
    """sqrt(0.4^2 - 0.05^2) - sqrt(0.2^2 - 0.05^2) = 0.20321..., within half a per cent of the range below."""
    held: dict[str, Bounds] = {"stroke": (stroke * 0.98, stroke * 1.02)}
    given = problem({"peak_torque": "minimise"}, held, crank=0.1, rod=0.3, offset=0.05)
    assert prove_infeasible(given) is infeasible


def test_rules_that_leave_one_value_are_bounded_where_they_contradict_a_stroke_and_where_they_do_not() -> None:
    """Linear equalities fix one, two or all dimensions of a drawn design; the stroke is its own, or not."""
    random, told = np.random.default_rng(61), 0
    for fixed in (("crank",), ("offset",), ("crank", "offset"), ("crank + offset", "offset"), ("rod", "rod - 3*crank")):
        for _ in range(3):
            crank, offset = random.uniform(0.03, 0.045), random.uniform(0.0, 0.03)
            design = {"crank": crank, "rod": random.uniform(0.1, 0.2), "offset": offset}
            stroke = float(Linkage(crank, design["rod"], offset).stroke)
            rules = {rule: {"equals": f"{eval(rule, {}, design)!r} m"} for rule in fixed}
            for factor in (1.0, 1.2):
                job = parse_job(
                    {
                        "name": "one value",
                        "mechanism": {"speed": "100 rpm", "slider": {"mass": "2 kg"}},
                        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["80 mm", "250 mm"], "offset": [0, "40 mm"]},
                        "constraints": rules | {"stroke": {"equals": f"{factor * stroke!r} m"}},
                        "objectives": {"peak_torque": "minimise"},
                    }
                )
                assert not (factor == 1.0 and prove_infeasible(job))
                told += prove_infeasible(job, seconds=20.0)
    assert told == 9


@pytest.mark.parametrize("job", JOBS)
def test_a_feasible_job_is_never_proven_infeasible(job: str) -> None:
    assert not prove_infeasible(shipped(job))


@pytest.mark.parametrize("angle", [27.2, 27.4])
def test_what_is_just_possible_is_not_proven_impossible(angle: float) -> None:
    """A time ratio of 1.5 caps the transmission angle at 27.46 deg (see `test_infeasibility`)."""
    held: dict[str, Bounds] = {"time_ratio": 1.5, "transmission_angle": (degrees(angle), None)}
    assert not prove_infeasible(problem({"peak_torque": "minimise"}, held), seconds=1.0)


def test_the_message_of_an_infeasible_job_says_that_it_is_proven() -> None:
    front = solve(problem({"peak_torque": "minimise"}, CONTRADICTIONS[0]))
    assert front.status == "infeasible"
    assert front.message.endswith("proven: no design within the ranges meets them all")


def test_a_budget_that_ends_first_proves_nothing() -> None:
    held: dict[str, Bounds] = {"time_ratio": (1.5, None), "transmission_angle": (degrees(27.47), None)}
    assert not prove_infeasible(problem({"peak_torque": "minimise"}, held), seconds=1e-3)


def test_a_contradiction_is_proven_where_more_than_the_dimensions_varies() -> None:
    varying = Varying(name="mechanism.slider.mass", sets=(("slider_mass", 1.0),), lower=0.5, upper=2.0)
    for stroke, infeasible in ((10.0, True), (0.1, False)):
        given = problem({"peak_torque": "minimise"}, {"stroke": (stroke, None)})
        given = replace(given, mechanism=replace(given.mechanism, varying=(varying,)))
        assert prove_infeasible(given) is infeasible


@pytest.mark.parametrize(("travel", "infeasible"), [("4.0 m", True), ("1.9 m", False)])
def test_a_contradiction_of_a_swing_is_proven(travel: str, infeasible: bool) -> None:
    job = tomllib.loads(Path("runs/support.toml").read_text(encoding="utf-8"))
    job["constraints"] = {"actuator_travel": {"min": travel}}
    given = parse_job(job, require_feasible=False)
    designs = np.random.default_rng(8).uniform((1.2, 1.2, -0.6), (1.5, 3.0, 0.6), (20_000, 3))
    longest = float(np.nanmax(given.evaluate(designs, ["actuator_travel"])))
    assert (longest < float(travel.removesuffix(" m"))) is infeasible
    assert prove_infeasible(given, seconds=60.0) is infeasible
