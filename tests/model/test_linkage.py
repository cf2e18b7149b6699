"""Closed forms of the linkage against limits, symmetries and simulation."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch
from tests.model.cases import Array, linkage_of, random_designs
from tests.model.virtual_work import path

DESIGNS = random_designs(300, seed=11)
BRANCHES: tuple[Branch, ...] = ("open", "crossed")


def linkage(designs: Array = DESIGNS, branch: Branch = "open") -> Linkage:
    return linkage_of(designs, branch)


def extremes(designs: Array, branch: Branch) -> tuple[Array, Array]:
    """Return the least and greatest slider position over the cycle and nothing else, by nested sweeps."""
    sign = 1.0 if branch == "open" else -1.0
    ends = []
    for side in (-1.0, 1.0):
        at, half = np.full(len(designs), math.pi), math.pi
        for _ in range(12):  # an extreme is flat: 1e-8 rad give the position to rounding
            angles = at[:, None] + half * np.linspace(-1.0, 1.0, 401)
            x = path(designs[:, None, :], angles, sign).x
            at = angles[np.arange(len(designs)), np.argmax(side * x, axis=1)]
            half /= 20.0
        ends.append(path(designs, at, sign).x)
    return ends[0], ends[1]


def test_stroke_is_two_cranks_without_offset() -> None:
    centred = DESIGNS * [1.0, 1.0, 0.0]
    # A few roundings of sums and roots.
    np.testing.assert_allclose(linkage(centred).stroke, 2.0 * DESIGNS[:, 0], rtol=1e-14)


def test_time_ratio_is_one_without_offset() -> None:
    assert np.all(linkage(DESIGNS * [1.0, 1.0, 0.0]).time_ratio == 1.0)


def test_stroke_with_offset_is_longer_than_two_cranks() -> None:
    offset = DESIGNS[np.abs(DESIGNS[:, 2]) > 0.1 * DESIGNS[:, 0]]
    assert np.all(linkage(offset).stroke > 2.0 * offset[:, 0])


def test_long_rod_gives_harmonic_motion() -> None:
    crank, rod = 0.1, 1e5
    theta = np.linspace(0.0, 2.0 * math.pi, 50)
    motion = Linkage(crank, rod).at(theta, speed=2.0)
    # The rod's tilt takes off at most r^2 / (2 l) = 5e-8 m, and 2 w that in speed.
    np.testing.assert_allclose(motion.slider_position - rod, crank * np.cos(theta), rtol=0, atol=6e-8)
    np.testing.assert_allclose(motion.slider_velocity, -2.0 * crank * np.sin(theta), rtol=0, atol=3e-7)
    np.testing.assert_allclose(Linkage(crank, rod, 0.05).time_ratio, 1.0, atol=1e-9)
    np.testing.assert_allclose(Linkage(crank, rod).least_transmission_angle, math.pi / 2.0, atol=2e-6)


@pytest.mark.parametrize("branch", BRANCHES)
def test_mirrored_offset_mirrors_the_motion(branch: Branch) -> None:
    mirrored = linkage(DESIGNS * [1.0, 1.0, -1.0], branch)
    original = linkage(branch=branch)
    for name in ("stroke", "time_ratio", "least_transmission_angle"):
        np.testing.assert_array_equal(getattr(mirrored, name), getattr(original, name))
    a, b = original.at(0.7, speed=3.0, acceleration=2.0), mirrored.at(-0.7, speed=-3.0, acceleration=-2.0)
    np.testing.assert_array_equal(a.slider_position, b.slider_position)
    np.testing.assert_array_equal(a.slider_velocity, b.slider_velocity)
    np.testing.assert_array_equal(a.slider_acceleration, b.slider_acceleration)
    np.testing.assert_array_equal(a.rod_angle, -b.rod_angle)
    np.testing.assert_array_equal(a.rod_velocity, -b.rod_velocity)
    np.testing.assert_array_equal(a.rod_acceleration, -b.rod_acceleration)


def test_twice_the_size_has_twice_the_lengths_and_the_same_angles() -> None:
    small, large = linkage(), linkage(2.0 * DESIGNS)  # a power of two: exact
    np.testing.assert_array_equal(large.stroke, 2.0 * small.stroke)
    np.testing.assert_array_equal(large.time_ratio, small.time_ratio)
    np.testing.assert_array_equal(large.least_transmission_angle, small.least_transmission_angle)
    a, b = small.at(2.1, speed=3.0, acceleration=-1.0), large.at(2.1, speed=3.0, acceleration=-1.0)
    np.testing.assert_array_equal(b.slider_acceleration, 2.0 * a.slider_acceleration)
    np.testing.assert_array_equal(b.rod_acceleration, a.rod_acceleration)


def test_crossed_branch_is_the_open_one_mirrored() -> None:
    opened = linkage().at(0.4, speed=2.0, acceleration=1.0)
    crossed = linkage(branch="crossed").at(math.pi - 0.4, speed=-2.0, acceleration=-1.0)
    # sin(pi - x) and sin(x) differ by an ulp, which a margin of 1e-3 amplifies some thousand times.
    np.testing.assert_allclose(crossed.slider_position, -opened.slider_position, rtol=1e-12)
    np.testing.assert_allclose(crossed.slider_velocity, -opened.slider_velocity, rtol=1e-10)
    np.testing.assert_allclose(crossed.rod_velocity, -opened.rod_velocity, rtol=1e-10)
    np.testing.assert_allclose(crossed.transmission_angle, opened.transmission_angle, rtol=1e-11)
    # Mirrored angles are pi - phi; arctan2 gives them in (-pi, pi].
    np.testing.assert_allclose(np.sin(crossed.rod_angle), np.sin(opened.rod_angle), atol=1e-14)
    np.testing.assert_allclose(np.cos(crossed.rod_angle), -np.cos(opened.rod_angle), atol=1e-12)


@pytest.mark.parametrize("branch", BRANCHES)
def test_dead_centres_are_the_extremes_of_the_slider_position(branch: Branch) -> None:
    least, greatest = extremes(DESIGNS, branch)
    inner, outer = linkage(branch=branch).dead_centres
    if branch == "crossed":
        least, greatest = greatest, least
    # Near locking the inner dead centre comes close to zero: compared by the size of the linkage.
    np.testing.assert_allclose(inner / DESIGNS[:, 1], least / DESIGNS[:, 1], rtol=0, atol=1e-13)
    np.testing.assert_allclose(outer, greatest, rtol=1e-13)
    np.testing.assert_allclose(linkage(branch=branch).stroke, np.abs(outer - inner), rtol=1e-11)


@pytest.mark.parametrize("branch", BRANCHES)
def test_slider_stands_still_at_the_dead_centre_angles(branch: Branch) -> None:
    machine = linkage(branch=branch)
    for angle, position in zip(machine.dead_centre_angles, machine.dead_centres, strict=True):
        assert np.all((angle >= 0.0) & (angle < 2.0 * math.pi))
        motion = machine.at(angle, speed=1.0)
        np.testing.assert_allclose(motion.slider_position / machine.rod, position / machine.rod, rtol=0, atol=1e-13)
        # An ulp of the angle times x'', which at a margin of 1e-3 reaches 1e3 cranks.
        np.testing.assert_allclose(motion.slider_velocity / machine.crank, 0.0, atol=1e-10)


@pytest.mark.parametrize("branch", BRANCHES)
def test_time_ratio_follows_from_the_dead_centre_angles(branch: Branch) -> None:
    machine = linkage(branch=branch)
    inner, outer = machine.dead_centre_angles
    inward = (inner - outer) % (2.0 * math.pi)
    ratio = np.maximum(inward, 2.0 * math.pi - inward) / np.minimum(inward, 2.0 * math.pi - inward)
    np.testing.assert_allclose(machine.time_ratio, ratio, rtol=1e-13)


@cache
def outward_shares(branch: Branch) -> dict[float, Array]:
    """Return the share of 20,000 angles at which the slider of each design moves outwards, by direction."""
    theta = 2.0 * math.pi * (np.arange(20_000) + 0.5) / 20_000
    sign = 1.0 if branch == "open" else -1.0
    slopes = (sign * path(design, theta, sign).x_1 for design in DESIGNS)  # one by one: small arrays are quicker
    shares = np.array([[np.mean(slope > 0.0), np.mean(-slope > 0.0)] for slope in slopes])
    return {1.0: shares[:, 0], -1.0: shares[:, 1]}


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_slow_stroke_is_the_one_that_takes_longer_in_simulation(branch: Branch, direction: float) -> None:
    machine = linkage(branch=branch)
    outward = outward_shares(branch)[direction]
    # 20,000 angles do not tell strokes apart whose time ratio is within 1e-3 of one.
    clear = machine.time_ratio > 1.001
    assert clear.sum() > 200
    expected = np.where(outward > 0.5, "outward", "inward")
    np.testing.assert_array_equal(machine.slow_stroke(direction=direction)[clear], expected[clear])
    share = np.maximum(outward, 1.0 - outward)
    np.testing.assert_allclose(machine.time_ratio, share / (1.0 - share), atol=1e-3)


def test_strokes_are_equal_without_offset() -> None:
    assert Linkage(1.0, 3.0).slow_stroke() == "equal"
    assert list(Linkage(1.0, 3.0, [0.0, 0.5]).slow_stroke()) == ["equal", "inward"]


@pytest.mark.parametrize("branch", BRANCHES)
def test_least_transmission_angle_is_the_least_over_the_cycle(branch: Branch) -> None:
    machine = linkage(branch=branch)
    # It is least at 90 or 270 deg, which are on this grid.
    angles = linkage_of(DESIGNS[:, None, :], branch).at(np.linspace(0.0, 2.0 * math.pi, 3601)).transmission_angle
    # The closed form takes an arcsine near one: at a margin of 1e-3 its rounding is 1e-16 / 0.045.
    np.testing.assert_allclose(angles.min(axis=1), machine.least_transmission_angle, rtol=1e-12)
    cosine = (DESIGNS[:, 0] + np.abs(DESIGNS[:, 2])) / DESIGNS[:, 1]
    np.testing.assert_allclose(np.cos(machine.least_transmission_angle), cosine, rtol=1e-14)
