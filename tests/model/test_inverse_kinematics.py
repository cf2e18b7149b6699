"""The crank motion found from the slider motion is the one that made it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.inverse_kinematics import Solution, crank_angle_at, crank_from_stroke, crank_motion
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch
from tests.model.cases import Array, linkage_of, random_designs

SPEED, ACCELERATION = -7.0, 90.0
SOLUTIONS: tuple[Solution, ...] = ("outward", "inward")


def there_and_back(designs: Array, theta: Array, branch: Branch) -> dict[Solution, int]:
    """Check the inverse of the forward motion where the slider's speed is at least a tenth of the crank pin's."""
    linkage = linkage_of(designs, branch)
    per_speed = linkage.at(theta, speed=1.0).slider_velocity
    counts: dict[Solution, int] = {}
    for solution, sign in zip(SOLUTIONS, (1.0, -1.0), strict=True):
        there = sign * linkage.sign * per_speed > 0.1 * linkage.crank
        part, angle = linkage_of(designs[there], branch), theta[there]
        at = part.at(angle, speed=SPEED, acceleration=ACCELERATION)
        found = crank_motion(
            part,
            at.slider_position,
            velocity=at.slider_velocity,
            acceleration=at.slider_acceleration,
            solution=solution,
        )
        assert np.all((found.crank_angle >= 0.0) & (found.crank_angle < 2.0 * math.pi))
        turns = np.angle(np.exp(1j * (found.crank_angle - angle)))
        np.testing.assert_allclose(turns, 0.0, atol=1e-10)
        np.testing.assert_allclose(found.speed, SPEED, rtol=1e-10)
        np.testing.assert_allclose(found.acceleration, ACCELERATION, rtol=1e-10)
        counts[solution] = int(there.sum())
    return counts


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_inverse_of_forward_kinematics_is_the_crank_motion(branch: Branch) -> None:
    # Closer to locking than 1 % the slider acceleration itself is known to 1e-10 only: 1e-16 / cos(phi)^3.
    designs = random_designs(5000, seed=31, least_margin=0.01)
    theta = np.random.default_rng(32).uniform(0.0, 2.0 * math.pi, 5000)
    counts = there_and_back(designs, theta, branch)
    assert min(counts.values()) > 1500


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_inverse_holds_for_linkages_that_do_not_turn_fully(branch: Branch) -> None:
    random = np.random.default_rng(33)
    crank, theta = random.uniform(0.02, 0.15, 4000), random.uniform(0.0, 2.0 * math.pi, 4000)
    rod, offset = crank * random.uniform(0.3, 1.5, 4000), crank * random.uniform(-1.0, 1.0, 4000)
    cosine_of_rod = 1.0 - ((offset - crank * np.sin(theta)) / rod) ** 2
    kept = (cosine_of_rod > 0.02) & (rod < crank + np.abs(offset))
    designs = np.stack([crank, rod, offset], axis=1)[kept]
    counts = there_and_back(designs, theta[kept], branch)
    assert min(counts.values()) > 300


def test_both_solutions_have_the_same_slider_motion() -> None:
    linkage = Linkage(3.0, 8.0, 2.0)  # Norton, table P7-2 row c, as quoted by Boyle and Liu
    found = [
        crank_motion(linkage, 9.791823496, velocity=-41.460771862, acceleration=-709.098870834, solution=solution)
        for solution in SOLUTIONS
    ]
    assert np.degrees(found[0].crank_angle) == pytest.approx(330.0, abs=1e-7)  # the figures have ten digits
    assert found[0].speed == pytest.approx(-15.0, rel=1e-8)
    assert found[0].acceleration == pytest.approx(-10.0, rel=1e-6)
    assert abs(found[1].crank_angle - found[0].crank_angle) > 1.0
    for motion in found:
        at = linkage.at(motion.crank_angle, speed=motion.speed, acceleration=motion.acceleration)
        assert at.slider_position == pytest.approx(9.791823496, rel=1e-13)
        assert at.slider_velocity == pytest.approx(-41.460771862, rel=1e-13)
        assert at.slider_acceleration == pytest.approx(-709.098870834, rel=1e-12)


def test_inverse_broadcasts_positions_with_linkages() -> None:
    linkage = Linkage(0.05, [[0.2], [0.3]], 0.01)
    found = crank_motion(linkage, [[0.19, 0.2], [0.29, 0.3]], velocity=[1.0, 2.0], acceleration=0.0, solution="inward")
    assert found.crank_angle.shape == found.speed.shape == found.acceleration.shape == (2, 2)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_crank_angle_at_a_dead_centre_is_that_of_the_closed_form(branch: Branch) -> None:
    linkage = Linkage(0.04, 0.064, 0.02, branch)
    for position, angle in zip(linkage.dead_centres, linkage.dead_centre_angles, strict=True):
        for solution in SOLUTIONS:
            found = crank_angle_at(linkage, position, solution=solution)
            # A rounding of the position turns the crank by its square root.
            assert abs(math.remainder(float(found) - float(angle), 2.0 * math.pi)) < 1e-7


def test_crank_angles_are_less_than_a_whole_turn() -> None:
    # An offset so small that the angle rounds to a whole turn: -1e-17 rad modulo 2 pi.
    found = crank_angle_at(Linkage(1.0, 3.0, -1e-17), 4.0, solution="outward")
    assert found == 0.0


def test_a_dead_centre_is_refused_because_the_crank_motion_is_undetermined() -> None:
    linkage = Linkage(0.04, 0.064, 0.02)
    for position in linkage.dead_centres:
        with pytest.raises(InputError, match=r"dead centres, where the crank motion is undetermined; got position \d"):
            crank_motion(linkage, position, velocity=0.0, acceleration=1.0, solution="outward")
    with pytest.raises(InputError, match=r"got position 13\.26"):
        crank_motion(
            linkage, [0.05, float(linkage.dead_centres[0])], velocity=0.0, acceleration=1.0, solution="outward"
        )


@pytest.mark.parametrize("position", [0.2, 0.013, -0.05])
def test_a_position_out_of_reach_is_refused_with_its_value(position: float) -> None:
    for solution in SOLUTIONS:
        with pytest.raises(AssemblyError, match=f"got position {1e3 * position:g} mm"):
            crank_motion(Linkage(0.04, 0.064, 0.02), position, velocity=1.0, acceleration=0.0, solution=solution)


def test_a_solution_on_the_other_branch_is_refused() -> None:
    linkage = Linkage(0.10, 0.08, 0.05)  # rod shorter than crank + offset
    found = crank_angle_at(linkage, 0.05, solution="inward")
    assert linkage.at(found).slider_position == pytest.approx(0.05, rel=1e-13)
    with pytest.raises(AssemblyError, match=r"the outward solution must lie on the open branch; got position 50 mm"):
        crank_angle_at(linkage, 0.05, solution="outward")
    crossed = Linkage(0.10, 0.08, 0.05, "crossed")
    found = crank_angle_at(crossed, 0.05, solution="outward")
    assert crossed.at(found).slider_position == pytest.approx(0.05, rel=1e-13)


@pytest.mark.parametrize("value", [math.nan, math.inf, "far"])
def test_motion_that_is_no_number_is_refused(value: float) -> None:
    linkage = Linkage(0.04, 0.064, 0.02)
    with pytest.raises(InputError, match="slider position must be"):
        crank_angle_at(linkage, value, solution="outward")
    for name in ("velocity", "acceleration"):
        motion = {"velocity": 0.0, "acceleration": 0.0, name: value}
        with pytest.raises(InputError, match=f"{name} must be"):
            crank_motion(linkage, 0.05, **motion, solution="outward")
    with pytest.raises(InputError, match="solution must be 'outward' or 'inward'"):
        crank_angle_at(linkage, 0.05, solution="upper")  # type: ignore[arg-type]


@pytest.mark.parametrize(("stroke", "remedy"), [(0.0, "give a stroke above 0"), (0.15, "lengthen the rod")])
def test_the_remedy_for_a_stroke_that_no_crank_gives_is_one(stroke: float, remedy: str) -> None:
    with pytest.raises(AssemblyError, match=remedy):
        crank_from_stroke(stroke, rod=0.07, offset=0.02)
    longer = crank_from_stroke(stroke or 0.1, rod=0.3, offset=0.02)
    assert Linkage(longer, 0.3, 0.02).stroke == pytest.approx(stroke or 0.1, rel=1e-12)
