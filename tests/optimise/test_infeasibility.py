"""Nothing feasible: the message names what contradicts what, with numbers that a derivation confirms."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from scipy.optimize import brentq

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.feasibility.relaxation import Relaxation
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.solve import solve
from tests.optimise.problems import MACHINE, Bounds, degrees, problem
from tests.optimise.test_known_optima import best_transmission_angle, excess_angle

pytestmark = pytest.mark.usefixtures("little")


def reachable(front: ParetoFront, quantity: str) -> float:
    """Return the reachable value of a quantity that the message states, in its shown unit."""
    found = re.search(
        rf"{QUANTITIES[quantity].title} (?:at|exactly)[^;]*?at (?:most|least|the nearest) (\S+)", front.message
    )
    assert found is not None, front.message
    return float(found[1])


def refused(held: dict[str, Bounds], **ranges: tuple[float, float]) -> ParetoFront:
    """Return the front of a problem that has no feasible design."""
    front = solve(problem({"peak_torque": "minimise"}, held, **ranges))  # type: ignore[arg-type]
    assert front.status == "infeasible"
    assert len(front) == 0
    assert front.hypervolume == 0.0
    return front


@pytest.mark.parametrize("equal", [True, False])
def test_a_time_ratio_of_one_and_a_half_caps_the_transmission_angle_at_27_46_degrees(equal: bool) -> None:
    """Either requirement alone gives way: the other side is the ratio whose best angle is 40 deg. Six digits shown."""
    front = refused({"time_ratio": 1.5 if equal else (1.5, None), "transmission_angle": (degrees(40.0), None)})
    assert "no design meets all requirements" in front.message
    assert "least transmission angle at least 40 deg is asked" in front.message
    assert reachable(front, "transmission_angle") == pytest.approx(best_transmission_angle(1.5), rel=1e-5)
    assert f"{best_transmission_angle(1.5):.2f}" == "27.46"
    assert f"time ratio {'exactly' if equal else 'at least'} 1.5 is asked" in front.message
    ratio = brentq(lambda ratio: best_transmission_angle(ratio) - 40.0, 1.01, 2.0)
    assert reachable(front, "time_ratio") == pytest.approx(ratio, rel=1e-5)


def test_the_rule_rod_is_3_2_offset_caps_the_time_ratio() -> None:
    """With q = 1 / 3.2, p = cos(mu) - q: see `test_known_optima`."""
    q = 1.0 / 3.2
    p = math.cos(degrees(40.0)) - q
    b = math.asin(q / (1.0 - p)) - math.asin(q / (1.0 + p))
    held: dict[str, Bounds] = {
        "rod_to_offset": 3.2,
        "transmission_angle": (degrees(40.0), None),
        "time_ratio": (1.4, None),
    }
    front = refused(held)
    assert reachable(front, "time_ratio") == pytest.approx((math.pi + b) / (math.pi - b), rel=1e-5)
    # Without the angle, the rule and the ratio leave one angle.
    wanted = excess_angle(1.4)
    p = brentq(lambda p: math.asin(q / (1.0 - p)) - math.asin(q / (1.0 + p)) - wanted, 1e-6, 1.0 - q - 1e-9)
    assert reachable(front, "transmission_angle") == pytest.approx(math.degrees(math.acos(p + q)), rel=1e-5)


def test_a_stroke_beyond_the_longest_crank_is_named() -> None:
    """Without offset the stroke is twice the crank."""
    front = refused({"stroke": 0.3}, crank=(0.05, 0.12), offset=(0.0, 0.0))
    assert "stroke exactly 300 mm is asked" in front.message
    assert reachable(front, "stroke") == pytest.approx(240.0, rel=1e-5)


def test_a_peak_that_cannot_be_held_is_named_with_the_least_one() -> None:
    held: dict[str, Bounds] = {"stroke": 0.2, "peak_torque": (None, 5.0)}
    front = refused(held)
    least = solve(problem({"peak_torque": "minimise"}, {"stroke": 0.2})).values[0, 0]
    assert reachable(front, "peak_torque") == pytest.approx(least, rel=1e-5)
    assert "transmission angle" not in front.message, "a floor that nobody asked for is not blamed"


def test_reachable_values_can_be_reached() -> None:
    """Asking for what is said to be possible gives designs; a little more does not."""
    held: dict[str, Bounds] = {"stroke": 0.2, "time_ratio": (1.3, None), "transmission_angle": (degrees(45.0), None)}
    angle = reachable(refused(held), "transmission_angle")
    for factor, status in ((1.0, "done"), (1.0 + 1e-4, "infeasible")):
        asked: dict[str, Bounds] = {**held, "transmission_angle": (degrees(angle * factor), None)}
        assert solve(problem({"peak_torque": "minimise"}, asked)).status == status


def test_several_requirements_that_must_give_way_together_are_said_so() -> None:
    """Neither limit alone is the trouble: torque far too low, rod far too long for any crank."""
    held: dict[str, Bounds] = {"stroke": 0.2, "peak_torque": (None, 0.5), "rod_to_crank": (50.0, None)}
    front = refused(held)
    assert "dropping any single one is not enough" in front.message
    named = re.search(r"crank (\S+) mm, rod (\S+) mm, offset (\S+) mm", front.message)
    assert named is not None
    r, l, e = (float(size) for size in named.groups())
    assert l > r + abs(e)
    found = QUANTITIES["peak_torque"].evaluate(MACHINE, np.array([[r, l, e]]) / 1e3).values[0]
    told = re.findall(r"(?:exactly|at most|at least) (\S+)(?: mm| N m)? instead of", front.message)
    stroke, torque, ratio = (float(number) for number in told)
    assert found == pytest.approx(torque, rel=1e-5)
    assert l / r == pytest.approx(ratio, rel=1e-5)
    held = {"stroke": stroke / 1e3, "peak_torque": (None, torque), "rod_to_crank": (ratio, None)}
    assert solve(problem({"time_ratio": "maximise"}, held)).status == "done"


def test_a_floor_that_nobody_asked_for_is_named_where_it_alone_stands_in_the_way() -> None:
    """Next to locking the time ratio goes on towards 3, which the floor of 10 deg cuts off."""
    front = refused({"time_ratio": (2.3, None)}, offset=(0.0, 0.5))
    assert "least transmission angle at least 10 deg applies if a job sets none, at most" in front.message
    angle = reachable(front, "transmission_angle")
    held: dict[str, Bounds] = {"time_ratio": (2.3, None), "transmission_angle": (degrees(angle), None)}
    assert solve(problem({"peak_torque": "minimise"}, held, offset=(0.0, 0.5))).status == "done"


def test_a_proportion_that_grows_without_bound_is_diagnosed_too() -> None:
    front = refused({"rod_to_offset": (30.0, None), "time_ratio": (1.9, None)}, offset=(-0.2, 0.2))
    assert reachable(front, "rod_to_offset") < 30.0


def test_where_no_crank_turns_fully_nothing_else_is_blamed() -> None:
    front = refused({"stroke": 0.2}, crank=(0.15, 0.2), rod=(0.06, 0.1))
    assert "no crank rotates fully" in front.message
    assert "allow a longer rod" in front.message


def test_given_dimensions_that_miss_a_requirement_say_what_they_have() -> None:
    front = solve(problem({"peak_torque": "minimise"}, {"stroke": 0.3}, crank=0.1, rod=0.3, offset=0.05))
    assert front.status == "infeasible"
    stroke = 1e3 * (math.sqrt(0.4**2 - 0.05**2) - math.sqrt(0.2**2 - 0.05**2))
    assert reachable(front, "stroke") == pytest.approx(stroke, rel=1e-5)


def test_relaxations_are_sentences() -> None:
    lower = Relaxation("transmission_angle", "at least", 40.0, 27.4576, "deg", "least transmission angle")
    assert lower.sentence() == (
        "least transmission angle at least 40 deg is asked, at most 27.4576 deg is possible with all else met"
    )
    upper = Relaxation("peak_torque", "at most", 5.0, 20.25, "N m", "peak torque")
    assert upper.sentence() == "peak torque at most 5 N m is asked, at least 20.25 N m is possible with all else met"
    value = Relaxation("time_ratio", "exactly", 1.5, 1.3, "", "time ratio")
    assert value.sentence() == "time ratio exactly 1.5 is asked, at the nearest 1.3 is possible with all else met"
