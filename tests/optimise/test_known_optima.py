"""Optima derived by hand, or found by a search in one variable that shares nothing with the optimiser."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Sense
from slidercrank.optimise.solve import solve
from tests.optimise.independent import Array, footprint, stroke, time_ratio, transmission_angle
from tests.optimise.problems import Bounds, degrees, problem

RATIOS = [1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0]
STROKE = 0.1
DEGREE = math.degrees(1.0)


def wide(
    objectives: Mapping[str, Sense | float], held: Mapping[str, Bounds], offset: tuple[float, float] = (0.0, 0.8)
) -> Problem:
    """Return a problem whose ranges do not matter."""
    return problem(objectives, held, crank=(0.005, 0.3), rod=(0.02, 2.0), offset=offset)


def excess_angle(ratio: float) -> float:
    """Return b of Q = (180 deg + b) / (180 deg - b), rad."""
    return math.pi * (ratio - 1.0) / (ratio + 1.0)


def on_the_circle(x: float, b: float) -> tuple[float, float, float]:
    """Return crank, rod and offset of a stroke of one, from the place of the pivot on its circle.

    The pivot O sees the dead centres C and D, one stroke apart, under the angle b: by the inscribed-angle theorem it
    lies on a circle through C and D, and any place on that arc gives the wanted time ratio. In the triangle O C D the
    law of sines gives OD = S sin(beta) / sin(b) and OC = S sin(beta + b) / sin(b) with beta the angle at C. With
    OC = l + r, OD = l - r and x = beta + b / 2, the sum and the difference of the sines are

        l = S sin(x) / (2 sin(b / 2)),    r = S cos(x) / (2 cos(b / 2)),

    and the height of O over the line C D is the offset, e = OC sin(beta) = S (cos(b) - cos(2 x)) / (2 sin(b)). Both
    dead centres lie on the same side of O where the angle at D is obtuse: b / 2 < x < 90 deg - b / 2.
    """
    crank = math.cos(x) / (2.0 * math.cos(0.5 * b))
    rod = math.sin(x) / (2.0 * math.sin(0.5 * b))
    return crank, rod, (math.cos(b) - math.cos(2.0 * x)) / (2.0 * math.sin(b))


def best_transmission_angle(ratio: float) -> float:
    """Return the greatest least transmission angle of all linkages with a time ratio, deg; the stroke only scales.

    With `on_the_circle`, s = sin(b / 2) and c = cos(x):

        cos(mu) = (r + e) / l = (s c + 1 - c^2 - s^2) / (cos(b / 2) sin(x)).

    Its derivative with respect to x vanishes where c^3 - (1 + s^2) c + s = (c - s)(c^2 + s c - 1) = 0. The root c = s
    is the locked linkage, mu = 0; the other, c = (sqrt(s^2 + 4) - s) / 2, is the optimum, where sin(x)^2 = s c and

        cos(mu) = sqrt(s / c) (2 c - s) / cos(b / 2).
    """
    b = excess_angle(ratio)
    s = math.sin(0.5 * b)
    c = 0.5 * (math.sqrt(s * s + 4.0) - s)
    return math.degrees(math.acos(math.sqrt(s / c) * (2.0 * c - s) / math.cos(0.5 * b)))


def only(wanted: Problem) -> tuple[Array, float]:
    """Return the one design of a one-objective problem and its objective as minimised."""
    front = solve(wanted)
    assert front.status == "done", front.message
    assert len(front) == 1
    assert front.designs["residual"][0] <= 1e-6
    return front.dimensions, float(front.values[0, 0])


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_closed_form_of_the_best_transmission_angle_is_what_a_search_along_the_circle_finds(ratio: float) -> None:
    """The search knows the angle to half the digits: 1e-8 rad. The linkages on the circle have stroke and ratio."""
    b = excess_angle(ratio)
    ends = (0.5 * b, 0.5 * (math.pi - b))
    for x in np.linspace(*ends, 9)[1:-1]:
        design = np.array([on_the_circle(float(x), b)])
        assert stroke(design)[0] == pytest.approx(1.0, rel=1e-12)
        assert time_ratio(design)[0] == pytest.approx(ratio, rel=1e-12)

    def cosine(x: float) -> float:
        r, l, e = on_the_circle(x, b)
        return (r + e) / l

    found = minimize_scalar(cosine, bounds=ends, method="bounded", options={"xatol": 1e-12})
    assert math.degrees(math.acos(found.fun)) == pytest.approx(best_transmission_angle(ratio), abs=1e-6)


@pytest.mark.parametrize("ratio", RATIOS)
def test_best_transmission_angle_with_stroke_and_time_ratio_given(ratio: float) -> None:
    """Both are eliminated; one unknown is left."""
    design, value = only(wide({"transmission_angle": "maximise"}, {"stroke": STROKE, "time_ratio": ratio}))
    assert -value * DEGREE == pytest.approx(best_transmission_angle(ratio), abs=1e-6)
    assert transmission_angle(design)[0] * DEGREE == pytest.approx(best_transmission_angle(ratio), abs=1e-6)
    assert stroke(design)[0] == pytest.approx(STROKE, rel=1e-9)
    assert time_ratio(design)[0] == pytest.approx(ratio, rel=1e-9)


@pytest.mark.parametrize("ratio", [1.1, 1.5, 2.0])
@pytest.mark.parametrize("offset", [(0.0, 0.8), (-0.8, 0.0), (-0.8, 0.8)])
def test_best_transmission_angle_with_the_time_ratio_as_a_bound(ratio: float, offset: tuple[float, float]) -> None:
    """The angle falls with the ratio, so that the bound is met exactly. It is not eliminated but kept by the search."""
    held: dict[str, Bounds] = {"stroke": STROKE, "time_ratio": (ratio, None)}
    design, value = only(wide({"transmission_angle": "maximise"}, held, offset))
    assert -value * DEGREE == pytest.approx(best_transmission_angle(ratio), abs=1e-6)
    assert time_ratio(design)[0] == pytest.approx(ratio, rel=1e-8)


@pytest.mark.parametrize("ratio", [1.2, 1.6])
def test_best_transmission_angle_with_an_equality_that_cannot_be_eliminated(ratio: float) -> None:
    """The footprint fixes the scale as the stroke does, but no formula gives a dimension from it."""
    held: dict[str, Bounds] = {"time_ratio": ratio, "footprint": 0.03}
    design, value = only(wide({"transmission_angle": "maximise"}, held))
    assert -value * DEGREE == pytest.approx(best_transmission_angle(ratio), abs=1e-6)
    assert footprint(design)[0] == pytest.approx(0.03, rel=1e-8)
    assert time_ratio(design)[0] == pytest.approx(ratio, rel=1e-8)


@pytest.mark.parametrize("angle", [15.0, 25.0, 40.0, 55.0])
def test_greatest_time_ratio_with_a_least_transmission_angle(angle: float) -> None:
    """The same optimum from the other side: the ratio whose best angle is the one asked."""
    expected = brentq(lambda ratio: best_transmission_angle(ratio) - angle, 1.0 + 1e-9, 2.9, xtol=1e-14)
    held: dict[str, Bounds] = {"stroke": STROKE, "transmission_angle": (degrees(angle), None)}
    _, value = only(wide({"time_ratio": "maximise"}, held))
    assert -value == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("angle", [20.0, 40.0, 55.0])
def test_greatest_time_ratio_under_the_rule_rod_is_3_2_offset(angle: float) -> None:
    """With q = e/l = 1/3.2 and p = r/l: cos(mu) = p + q. The excess angle rises with p term by term,

        b = asin(q / (1 - p)) - asin(q / (1 + p)),

    so that the greatest lies at p = cos(mu) - q, whatever the size.
    """
    q = 1.0 / 3.2
    p = math.cos(degrees(angle)) - q
    b = math.asin(q / (1.0 - p)) - math.asin(q / (1.0 + p))
    held: dict[str, Bounds] = {"rod_to_offset": 3.2, "transmission_angle": (degrees(angle), None)}
    sizes: list[dict[str, Bounds]] = [{}, {"stroke": (0.08, 0.09)}, {"stroke": 0.085}]
    for size in sizes:
        design, value = only(wide({"time_ratio": "maximise"}, {**held, **size}))
        assert -value == pytest.approx((math.pi + b) / (math.pi - b), rel=1e-9)
        assert design[0, 1] / design[0, 2] == pytest.approx(3.2, rel=1e-9)


@pytest.mark.parametrize("ratio", [1.1, 1.3, 1.6, 2.0])
def test_transmission_angle_for_a_time_ratio_under_the_rule_rod_is_3_2_offset(ratio: float) -> None:
    """Rule and ratio leave only the size free: p solves b(p) = b and mu = acos(p + q)."""
    q, b = 1.0 / 3.2, excess_angle(ratio)
    p = brentq(lambda p: math.asin(q / (1.0 - p)) - math.asin(q / (1.0 + p)) - b, 1e-9, 1.0 - q - 1e-12, xtol=1e-15)
    sizes: list[dict[str, Bounds]] = [{}, {"stroke": 0.085}]
    for size in sizes:
        held: dict[str, Bounds] = {"rod_to_offset": 3.2, "time_ratio": ratio, **size}
        design, value = only(wide({"transmission_angle": "maximise"}, held))
        assert -value * DEGREE == pytest.approx(math.degrees(math.acos(p + q)), abs=1e-6)
        assert time_ratio(design)[0] == pytest.approx(ratio, rel=1e-8)


@pytest.mark.parametrize("offset", [(0.0, 0.1), (-0.1, 0.0), (-0.05, 0.1)])
def test_the_longest_rod_without_offset_transmits_best(offset: tuple[float, float]) -> None:
    """For a stroke S, r(e) is concave (an arc of an ellipse) and flat at e = 0. There r = S / 2 and r + |e| is least.

    Then cos(mu) = S / (2 l), least with the longest rod.
    """
    design, value = only(problem({"transmission_angle": "maximise"}, {"stroke": 0.28}, rod=(0.2, 0.6), offset=offset))
    assert math.cos(-value) == pytest.approx(0.14 / 0.6, rel=1e-12)
    assert design[0] == pytest.approx([0.14, 0.6, 0.0], abs=1e-9)


def test_the_smallest_footprint_without_offset_has_the_shortest_rod_that_transmits() -> None:
    """Crank r = S / 2 and rod l = r / cos(mu). The rectangle is (l + 2 r) by 2 r."""
    held: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(50.0), None)}
    _, value = only(problem({"footprint": "minimise"}, held, offset=0.0))
    rod = 0.1 / math.cos(degrees(50.0))
    assert value == pytest.approx(0.2 * (rod + 0.2), rel=1e-9)


def test_the_mean_torque_against_friction_is_least_with_the_shortest_stroke() -> None:
    """A force F against the motion takes the work 2 F S a turn. Mean torque F S / pi; S >= 2 r, with e = 0 equal."""
    rubbing = Mechanism(speed=10.0, loads=(StrokeForce(outward=-50.0, inward=50.0),))
    design, value = only(problem({"mean_torque": "minimise"}, crank=(0.03, 0.1), mechanism=rubbing, samples=2048))
    assert value == pytest.approx(50.0 * 0.06 / math.pi, rel=1e-9)
    assert design[0, 0] == pytest.approx(0.03, rel=1e-9)
    assert stroke(design)[0] == pytest.approx(0.06, rel=1e-9)


def test_the_peak_torque_of_a_static_force_is_least_with_the_longest_rod() -> None:
    """Without offset and masses T = F r (sin(theta) + cos(theta) tan(p)). Here sin(p) = r sin(theta) / l and r = S / 2.

    Its peak falls with l towards F r; that of the longest rod is found along theta.
    """
    pushing = Mechanism(loads=(StrokeForce(outward=-100.0, inward=0.0),))
    r, l = 0.05, 0.4

    def torque(theta: float) -> float:
        return -100.0 * r * (math.sin(theta) + math.cos(theta) * math.tan(math.asin(r * math.sin(theta) / l)))

    peak = minimize_scalar(torque, bounds=(0.5, 2.0), method="bounded", options={"xatol": 1e-10})
    wanted = problem({"peak_torque": "minimise"}, {"stroke": 0.1}, rod=(0.1, 0.4), offset=0.0, mechanism=pushing)
    design, value = only(wanted)
    assert value == pytest.approx(-peak.fun, rel=1e-9)
    assert design[0] == pytest.approx([0.05, 0.4, 0.0], rel=1e-9)


def test_a_target_that_can_be_met_is_met() -> None:
    design, value = only(problem({"time_ratio": 1.25}, {"stroke": 0.2, "rod_to_offset": 3.2}))
    assert value == pytest.approx(0.0, abs=1e-12)
    assert time_ratio(design)[0] == pytest.approx(1.25, rel=1e-12)


def test_a_target_out_of_reach_is_approached() -> None:
    """Under 40 deg the greatest ratio is that of `best_transmission_angle`; asked is 1.5."""
    expected = brentq(lambda ratio: best_transmission_angle(ratio) - 40.0, 1.01, 2.0, xtol=1e-14)
    held: dict[str, Bounds] = {"stroke": STROKE, "transmission_angle": (degrees(40.0), None)}
    _, value = only(wide({"time_ratio": 1.5}, held))
    assert value == pytest.approx(1.5 - expected, rel=1e-8)
