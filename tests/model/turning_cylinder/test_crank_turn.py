"""A crank that rotates fully and turns an arm: against free bodies, energies, published numbers and the other drive."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError
from slidercrank.model.turning_cylinder.closed_forms import (
    arm_swing_angle,
    arm_time_ratio_at_constant_crank_speed,
    crank_work_per_turn,
    least_arm_transmission_angle,
    ram_stroke,
)
from slidercrank.model.turning_cylinder.crank_turn_state import PIECES, fast_stroke_ends, place_in_turn, turn_state
from slidercrank.model.turning_cylinder.lever_geometry import TurningCylinder, lever_angle_at, motion_at
from slidercrank.model.turning_cylinder.lever_state import lever_state
from tests.model.turning_cylinder.driven_bodies import DrivenBodies
from tests.model.turning_cylinder.turns import numbers_of, some_turn

GAUSS, WEIGHTS = (part * 0.5 for part in np.polynomial.legendre.leggauss(60))
PLACES = (np.arange(PIECES)[:, None] + 0.5 + GAUSS).ravel()


def test_torque_and_joint_forces_of_40_machines_are_those_of_free_bodies_with_constraints() -> None:
    random = np.random.default_rng(51)
    for _ in range(40):
        c = numbers_of(*some_turn(random))
        place = float(random.uniform(0.02, PIECES - 0.02))
        state = turn_state(c, place, place)
        angle, gamma = float(state.crank_angle) + c.pin_angle, math.atan2(state.line[1], state.line[0])
        line = np.array([math.cos(gamma), math.sin(gamma)])
        pivot = c.frame * np.array([math.cos(c.frame_angle), math.sin(c.frame_angle)])
        pin = c.crank * np.array([math.cos(angle), math.sin(angle)])
        guess = np.concatenate(
            [
                *([0.0, 0.0, state.crank_angle], *(([*(pivot + 0.1 * line), gamma]) for _ in range(2))),
                *([*(pin - 0.1 * line), gamma], [*(pivot + c.ram * line), 0.0]),
            ]
        )
        found = DrivenBodies(c).forces(guess, float(state.crank_angle), c.speed, slow=place > 2.0)
        assert math.cos(found.coordinates[5] - gamma) == pytest.approx(1.0, abs=1e-12)
        scale = abs(found.pin) + abs(found.pivot) + abs(found.cylinder_pivot)
        assert state.torque == pytest.approx(found.torque, abs=1e-8 * scale)
        for name in ("pin", "pivot", "cylinder_pivot"):
            force = complex(*getattr(state, name))
            assert force == pytest.approx(getattr(found, name), abs=1e-8 * scale), name


def test_the_work_of_a_turn_is_that_of_torque_force_and_friction() -> None:
    """Inertia and weight return over the turn what they took."""
    random = np.random.default_rng(52)
    for _ in range(40):
        c = numbers_of(*some_turn(random))
        state = turn_state(c, PLACES, PLACES)
        parts = state.torque * state.stretch * np.tile(WEIGHTS, PIECES)
        work = math.copysign(1.0, c.speed) * float(parts.sum())
        assert work == pytest.approx(float(np.real(crank_work_per_turn(c))), abs=1e-6 * float(np.abs(parts).sum()))


def test_the_cylinder_that_moves_the_lever_in_the_same_way_has_the_same_power() -> None:
    """Both drives are inverse to each other: angles of equal lengths, and P dL = T d(theta)."""
    random = np.random.default_rng(53)
    for _ in range(100):
        plain = numbers_of(*some_turn(random))
        c = plain._replace(**dict.fromkeys(("arm_mass", "arm_moment", "arm_inertia", "arm_torque", "ram_mass"), 0.0))
        c = c._replace(ram_force=0.0, rub=0.0)
        place = float(random.uniform(0.05, PIECES - 0.05))
        state = turn_state(c, place, place)
        angle = float(state.crank_angle)
        assert lever_angle_at(c, state.length, angle) == pytest.approx(angle, abs=1e-10)
        ends = c._replace(start=angle - 1e-3, end=angle + 1e-3, rate=0.0)
        slow = turn_state(c._replace(speed=0.0), place, place)
        first, last = ends.cylinder_end_lengths
        held = lever_state(ends, "slow", (slow.length - first) / (last - first), 0.5)
        assert held.lever_angle == pytest.approx(angle, abs=1e-10)
        sizes = abs(slow.torque) + abs(held.push * slow.length_1) + 1e-9
        assert held.push * slow.length_1 == pytest.approx(slow.torque, abs=1e-10 * sizes)


@pytest.mark.parametrize("rotates", [False, True])
def test_the_fast_stroke_is_between_reversals_or_normals_of_the_frame(rotates: bool) -> None:
    random = np.random.default_rng(54)
    for _ in range(8):
        mechanism, design = some_turn(random, rotates=rotates)
        c = numbers_of(mechanism, design)
        for psi in (-fast_stroke_ends(c)[0], fast_stroke_ends(c)[1]):
            motion = motion_at(c, psi + c.frame_angle - c.pin_angle)
            across = motion.line[0] * math.cos(c.frame_angle) + motion.line[1] * math.sin(c.frame_angle)
            assert (across if rotates else motion.turn_1) == pytest.approx(0.0, abs=1e-9)
        angles = np.linspace(0.0, 2.0 * math.pi, 4001)
        state = turn_state(c, place_in_turn(c, angles), place_in_turn(c, angles))
        assert np.mod(state.crank_angle - angles + 1.0, 2.0 * math.pi) == pytest.approx(np.ones(4001), abs=1e-9)
        gamma = np.unwrap(np.arctan2(state.line[1], state.line[0]))
        assert float(np.ptp(gamma)) == pytest.approx(float(np.real(arm_swing_angle(c))), rel=1e-5)
        ram = c.ram * np.sin(gamma - c.frame_angle)
        assert float(np.ptp(ram)) == pytest.approx(float(ram_stroke(c)), rel=1e-5)
        least = np.arccos(np.abs(c.offset) / np.hypot(state.length, c.offset)).min()
        assert float(least_arm_transmission_angle(c)) == pytest.approx(float(least), abs=1e-4)
        sizes = TurningCylinder(crank=c.crank, frame=c.frame, frame_angle=0.0, offset=c.offset)
        ratio = float(np.real(arm_time_ratio_at_constant_crank_speed(c)))
        assert ratio == pytest.approx(sizes.time_ratio_of_full_turn, rel=1e-12)


def test_a_shaper_and_a_whitworth_mechanism_have_the_numbers_of_their_triangles() -> None:
    """A crank half as long as the frame swings its arm by 60 deg. With 50 and 75 mm, the fast stroke is 2 acos(2/3)."""
    mechanism, _ = some_turn(np.random.default_rng(55))
    shaper = numbers_of(mechanism, np.array([[0.12, 0.24, 0.0]]))._replace(ram=0.45)
    assert float(np.real(arm_time_ratio_at_constant_crank_speed(shaper))) == pytest.approx(2.0, rel=1e-12)
    assert math.degrees(float(np.real(arm_swing_angle(shaper)))) == pytest.approx(60.0, rel=1e-12)
    assert 1e3 * float(ram_stroke(shaper)) == pytest.approx(450.0, rel=1e-12)
    whitworth = numbers_of(mechanism, np.array([[0.075, 0.05, 0.0]]))
    fast = 2.0 * math.acos(0.05 / 0.075)
    assert float(np.real(arm_time_ratio_at_constant_crank_speed(whitworth))) == pytest.approx(
        2.0 * math.pi / fast - 1.0, rel=1e-12
    )


def test_a_crank_that_locks_is_refused_with_its_sizes() -> None:
    sizes = TurningCylinder(crank=0.2, frame=0.25, frame_angle=0.0, offset=0.06)
    with pytest.raises(AssemblyError, match=r"\|frame - crank\|.*200 mm, a frame of 250 mm and an offset of 60 mm"):
        sizes.require_turn()
