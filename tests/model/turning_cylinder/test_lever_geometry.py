"""A lever and its turning cylinder: lengths, angles and turns against the slider-crank and independent formulas."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.turning_cylinder.lever_geometry import (
    DimensionErrors,
    TurningCylinder,
    angle_at_length,
    crank_and_frame_for_stroke,
    cylinder_length,
)
from tests.model.turning_cylinder.machines import some_ends, some_sizes

STEP = 1e-30


def lever(**changes: float) -> TurningCylinder:
    """Return a lever of 350 mm on a frame of 900 mm at -60 deg."""
    sizes = {"crank": 0.35, "frame": 0.9, "frame_angle": math.radians(-60.0), **changes}
    return TurningCylinder(**sizes)


def test_the_chain_of_300_levers_is_the_slider_crank_with_its_rod_fixed() -> None:
    """Slider position is length; from OA, OB is at theta + pi - phi, the line at pi - phi."""
    random = np.random.default_rng(1)
    for _ in range(300):
        sizes = some_sizes(random)
        angle = some_ends(sizes, random)[0]
        motion = sizes.motion_at(np.array([angle]))
        length = float(motion.length[0])
        theta = cmath.phase(complex(motion.radial[0] * motion.line[0].conj()))  # from B: between the ways to A and to O
        sine = (sizes.offset - sizes.crank * math.sin(theta)) / sizes.frame
        phi = math.atan2(sine * sizes.frame, length - sizes.crank * math.cos(theta))
        same = Linkage(sizes.crank, sizes.frame, sizes.offset, "open" if math.cos(phi) > 0.0 else "crossed")
        assert float(same.at(theta).slider_position) == pytest.approx(length, abs=1e-9)
        psi = float(sizes.angle_from_frame_to_crank(angle))
        assert math.remainder(theta + math.pi - phi - psi, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)
        turned = cmath.phase(complex(motion.line[0])) - sizes.frame_angle
        assert math.remainder(math.pi - phi - turned, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)


def test_length_and_lever_angle_are_inverse_to_each_other() -> None:
    random = np.random.default_rng(2)
    for _ in range(300):
        sizes = some_sizes(random)
        start, end = some_ends(sizes, random)
        angles = start + (end - start) * np.linspace(0.0, 1.0, 7)
        found = sizes.lever_angle_at_length(sizes.cylinder_length(angles), near=0.5 * (start + end))
        assert np.abs(found - angles).max() < 1e-10
        assert np.abs(sizes.cylinder_length(found) - sizes.cylinder_length(angles)).max() < 1e-10


def test_derivatives_of_length_and_turn_are_those_of_fine_steps() -> None:
    random, h = np.random.default_rng(3), 1e-5
    for _ in range(100):
        sizes = some_sizes(random)
        angle = some_ends(sizes, random)[0]
        low, here, high = (sizes.motion_at(np.array([angle + step])) for step in (-h, 0.0, h))
        assert (high.length - low.length) / (2.0 * h) == pytest.approx(here.length_1, rel=1e-6, abs=1e-7)
        assert (high.length_1 - low.length_1) / (2.0 * h) == pytest.approx(here.length_2, rel=1e-6, abs=1e-6)
        turn = np.angle(high.line / low.line) / (2.0 * h)
        assert turn == pytest.approx(here.turn_1, rel=1e-6, abs=1e-7)
        assert (high.turn_1 - low.turn_1) / (2.0 * h) == pytest.approx(here.turn_2, rel=1e-5, abs=1e-5)


def test_the_slope_of_the_length_by_complex_step_is_that_of_the_law_of_cosines() -> None:
    random = np.random.default_rng(4)
    for _ in range(100):
        sizes = some_sizes(random)
        angle = some_ends(sizes, random)[0]
        numbers = [sizes.crank, sizes.frame, sizes.offset, float(sizes.angle_from_frame_to_crank(angle))]
        moved = [complex(size, STEP if place == 3 else 0.0) for place, size in enumerate(numbers)]
        slope = complex(cylinder_length(*moved)).imag / STEP
        assert slope == pytest.approx(float(sizes.motion_at(np.array([angle])).length_1[0]), rel=1e-10)


def test_the_error_of_the_lever_angle_adds_the_slopes_by_every_dimension() -> None:
    """Slopes of the angle at a given length by complex steps, for all dimensions and the length."""
    random = np.random.default_rng(5)
    for _ in range(100):
        sizes = some_sizes(random)
        angle = some_ends(sizes, random)[0]
        limits = random.uniform(1e-4, 1e-3, 4).tolist()
        numbers: list[Any] = [sizes.crank, sizes.frame, sizes.offset, float(sizes.cylinder_length(angle))]
        total = 0.0
        for place, limit in enumerate(limits):
            moved = [complex(size, STEP if place == index else 0.0) for index, size in enumerate(numbers)]
            total += limit * abs(complex(angle_at_length(*moved)).imag) / STEP
        assert float(sizes.worst_lever_angle_error(np.array([angle]), DimensionErrors(*limits))[0]) == pytest.approx(
            total, rel=1e-9
        )


def test_transmission_angle_is_90_deg_where_the_pins_line_is_normal_to_the_lever() -> None:
    sizes = lever()
    right = math.acos(sizes.crank / sizes.frame)  # cos(psi) = r / f: AB is a tangent of the pin's circle
    angles = right - float(sizes.angle_from_frame_to_crank(0.0)) + np.array([0.0, 1e-3])
    transmission = sizes.motion_at(angles).transmission
    assert math.degrees(transmission[0]) == pytest.approx(90.0, abs=1e-5)
    assert transmission[1] < transmission[0]


def test_dead_points_are_where_both_pivots_and_the_pin_are_in_line() -> None:
    sizes = lever()
    assert [math.degrees(angle) for angle in sizes.dead_points(-2.0, 3.0)] == pytest.approx([-60.0, 120.0])
    assert sizes.dead_point_margin(-2.0, 3.0) == 0.0
    assert math.degrees(sizes.dead_point_margin(math.radians(-20.0), math.radians(50.0))) == pytest.approx(40.0)
    assert math.degrees(sizes.dead_point_margin(math.radians(0.0), math.radians(110.0))) == pytest.approx(10.0)


def test_a_swing_across_a_dead_point_or_to_where_the_line_does_not_reach_is_refused() -> None:
    with pytest.raises(InputError, match=r"has one at -60 deg; swing on one side of it, or turn the frame"):
        lever().require_swing(math.radians(-80.0), math.radians(10.0))
    with pytest.raises(InputError, match=r"two different lever angles; got 10 deg and 10 deg; change one"):
        lever().require_swing(math.radians(10.0), math.radians(10.0))
    with pytest.raises(InputError, match=r"two different lever angles; got nan deg"):
        lever().require_swing(math.nan, 1.0)
    with pytest.raises(AssemblyError, match=r"an offset of 700 mm and \d+\.?\d* mm at -20 deg; reduce the offset"):
        lever(offset=0.7).require_swing(math.radians(-20.0), math.radians(50.0))
    with pytest.raises(InputError, match="pivots 0 mm apart; move one of them"):
        lever(frame=0.0)
    with pytest.raises(InputError, match=r"the crank OB of a lever must be positive and finite; got -0\.35 m"):
        lever(crank=-0.35)


@pytest.mark.parametrize(
    ("start", "end", "remedy"),
    [
        (
            340.0,
            50.0,
            "got 340 deg to 50 deg; angles must be written without wrapping at a full turn: write -20 deg for 340 deg",
        ),
        (-20.0, 410.0, "write 50 deg for 410 deg"),
        (-40.0, 140.0, "less than 180 deg, .*; got -40 deg to 140 deg; reduce the swing"),
        (0.0, 360.0, "got 0 deg to 360 deg; reduce the swing"),
    ],
)
def test_no_frame_allows_half_a_turn_but_other_angles_may_state_the_same_ends(
    start: float, end: float, remedy: str
) -> None:
    with pytest.raises(InputError, match=remedy):
        lever().require_swing(math.radians(start), math.radians(end))


def test_a_length_out_of_reach_has_no_lever_angle() -> None:
    sizes = lever(offset=0.1)
    least, greatest = sizes.closable_length_range
    assert np.isnan(sizes.lever_angle_at_length(np.array([least - 1e-3, greatest + 1e-3, math.nan]), near=0.5)).all()
    assert not np.isnan(sizes.lever_angle_at_length(np.array([least + 1e-3, greatest - 1e-3]), near=0.5)).any()


@pytest.mark.parametrize("lesser", [0.12, 0.3])
@pytest.mark.parametrize("whitworth", [False, True])
def test_time_ratios_of_shaper_and_whitworth_are_the_published_closed_forms(lesser: float, whitworth: bool) -> None:
    """Q = (pi + 2 a) / (pi - 2 a), sin(a) = shorter / longer of crank and frame."""
    sizes = lever(crank=0.5, frame=lesser) if whitworth else lever(crank=lesser, frame=0.5)
    a = math.asin(lesser / 0.5)
    assert sizes.time_ratio_of_full_turn == pytest.approx((math.pi + 2.0 * a) / (math.pi - 2.0 * a), rel=1e-12)


def test_time_ratios_with_an_offset_are_those_of_the_turning_line() -> None:
    """Reversals of the line, or its crossings of the normal of OA, counted on a fine turn of the crank."""
    random = np.random.default_rng(6)
    turn = np.linspace(0.0, 2.0 * math.pi, 200_001)
    for _ in range(12):
        crank, frame = random.uniform(0.2, 1.0, 2).tolist()
        offset = float(random.uniform(-0.8, 0.8)) * abs(crank - frame)
        sizes = TurningCylinder(crank=crank, frame=frame, frame_angle=0.0, offset=offset)
        motion = sizes.motion_at(turn)
        side = motion.turn_1 if crank < frame else motion.line.real
        share = float(np.mean(side[:-1] > 0.0))
        ratio = max(share, 1.0 - share) / min(share, 1.0 - share)
        assert sizes.time_ratio_of_full_turn == pytest.approx(ratio, rel=1e-3)
    assert lever(offset=0.56).time_ratio_of_full_turn is None


def test_the_sizes_for_a_stroke_give_both_lengths_at_both_angles() -> None:
    random = np.random.default_rng(7)
    for _ in range(200):
        sizes = some_sizes(random)
        ends = sorted(some_ends(sizes, random), key=sizes.cylinder_length)
        lengths = float(sizes.cylinder_length(ends[0])), float(sizes.cylinder_length(ends[1]))
        psi = float(sizes.angle_from_frame_to_crank(ends[0])), float(sizes.angle_from_frame_to_crank(ends[1]))
        found = crank_and_frame_for_stroke(lengths, psi, sizes.offset)
        assert found == pytest.approx(tuple(sorted((sizes.crank, sizes.frame))), rel=1e-6)


def test_no_sizes_give_a_stroke_without_turning_or_against_the_law_of_cosines() -> None:
    assert crank_and_frame_for_stroke((0.5, 0.8), (1.0, 1.0)) is None
    assert crank_and_frame_for_stroke((0.8, 0.5), (1.0, 2.0)) is None  # longer at the smaller angle
    assert crank_and_frame_for_stroke((0.1, 0.8), (1.0, 1.1)) is None  # so long a stroke for so little turn
