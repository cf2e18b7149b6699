"""Quantities of a crank that rotates fully and turns an arm: against dense curves, differences and closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.swing.swing import CRANK_TURN
from slidercrank.model.turning_cylinder.crank_turn_state import PIECES, turn_state
from slidercrank.objectives.swing_quantity import SwingQuantity
from slidercrank.objectives.tables.swing_columns import swing_quantities
from tests.model.turning_cylinder.turns import numbers_of, some_turn
from tests.objectives.richardson import derivatives

QUANTITIES = swing_quantities(CRANK_TURN)


def test_quantities_are_those_of_dense_curves() -> None:
    random = np.random.default_rng(61)
    places = np.linspace(0.0, PIECES, 20_001)
    for _ in range(12):
        mechanism, design = some_turn(random)
        c = numbers_of(mechanism, design)
        found = {of.name: float(of.evaluate(mechanism, design).values[0]) for of in QUANTITIES}
        state = turn_state(c, places, places)
        peaks = {
            "arm_speed_ratio": state.turn_1,
            "arm_acceleration_ratio": state.turn_2,
            "peak_arm_speed": state.turn_1 * c.speed,
            "peak_arm_acceleration": state.turn_2 * c.speed**2,
            "peak_sliding_speed": state.length_1 * c.speed,
            "peak_ram_speed": state.ram_1 * c.speed,
            "peak_crank_torque": state.torque,
            "lever_pin_force": np.hypot(*state.pin),
            "lever_pivot_force": np.hypot(*state.pivot),
            "cylinder_pivot_force": np.hypot(*state.cylinder_pivot),
            "greatest_cylinder_length": state.length,
        }
        for name, curve in peaks.items():
            assert found[name] == pytest.approx(float(np.abs(curve).max()), rel=1e-6), name
        assert found["least_cylinder_length"] == pytest.approx(float(state.length.min()), rel=1e-6)
        assert found["cylinder_travel"] == pytest.approx(float(np.ptp(state.length)), rel=1e-6)
        middle = places[:-1] + 0.5 * (places[1] - places[0])
        square = turn_state(c, middle, middle)
        mean = float((square.torque**2 * square.stretch).sum() / square.stretch.sum())
        assert found["rms_crank_torque"] == pytest.approx(mean**0.5, rel=1e-6)


def test_without_an_offset_the_greatest_speed_is_where_the_pin_is_nearest() -> None:
    (speed,) = (of for of in QUANTITIES if of.name == "arm_speed_ratio")
    mechanism, _ = some_turn(np.random.default_rng(62))
    found = speed.evaluate(mechanism, np.array([[0.1, 0.3, 0.0], [0.3, 0.1, 0.0], [0.1, 0.3, 0.25]])).values
    assert found[:2] == pytest.approx([0.1 / 0.2, 0.3 / 0.2], rel=1e-12)
    assert np.isnan(found[2])  # it locks


VARYING = (
    Varying(name="speed", sets=(("speed", 1.0),), lower=2.0, upper=9.0),
    Varying(name="ram", sets=(("lever.arm.ram", 1.0),), lower=0.2, upper=1.0),
    Varying(name="torque", sets=(("lever.arm.torque", 1.0),), lower=0.0, upper=50.0),
    Varying(name="centre", sets=(("lever.arm.centre", 1.0),), lower=-0.5, upper=0.5),
    Varying(name="frame angle", sets=(("lever.frame_angle", 1.0),), lower=-3.2, upper=3.2),
    Varying(name="mass", sets=(("crank.mass", 1.0),), lower=1.0, upper=90.0),
    Varying(name="friction", sets=(("lever.cylinder.seal_friction", 1.0),), lower=0.0, upper=90.0),
)


def _varied(mechanism: Mechanism, design: Array) -> tuple[Mechanism, Array]:
    """Return a machine with further numbers in its designs, at its own values."""
    lever = mechanism.lever
    assert lever is not None
    assert lever.arm.ram is not None
    assert isinstance(mechanism.crank, RigidLink)
    numbers = [abs(mechanism.speed), lever.arm.ram, lever.arm.torque, lever.arm.centre, lever.frame_angle]
    numbers += [mechanism.crank.mass, lever.cylinder.seal_friction]
    return replace(mechanism, speed=abs(mechanism.speed), varying=VARYING), np.array([[*design[0], *numbers]])


@pytest.mark.slow
def test_gradients_are_those_of_extrapolated_differences() -> None:
    random, misses, compared = np.random.default_rng(63), [], 0
    for _ in range(4):
        mechanism, design = _varied(*some_turn(random))
        step = 1e-3 * np.maximum(np.abs(design), 0.02)
        for of in QUANTITIES:
            found = of.evaluate(mechanism, design, gradients=True)
            assert found.gradients is not None

            def function(displaced: Array, _: object, of: SwingQuantity = of, case: Mechanism = mechanism) -> Array:
                return of.evaluate(case, displaced).values

            expected, estimate = derivatives(function, design, step)
            size = np.abs(expected).max() + 1e-9
            if estimate.max() > 1e-8 * size:  # a kink within the steps
                continue
            compared += 1
            misses.append((float(np.abs(found.gradients - expected).max() / size), of.name))
    assert compared > 60
    assert max(misses)[0] < 1e-7, max(misses)


def test_pieces_hold_the_quantity_and_its_gradient() -> None:
    random = np.random.default_rng(64)
    for _ in range(4):
        mechanism, design = some_turn(random)
        for of in QUANTITIES:
            found, pieces = of.evaluate(mechanism, design, gradients=True), of.pieces(mechanism, design)
            best = int((np.argmin if pieces.least else np.argmax)(pieces.values[0]))
            assert pieces.values[0, best] == pytest.approx(found.values[0], rel=1e-12), of.name
            assert found.gradients is not None
            assert pieces.gradients[0, best] == pytest.approx(found.gradients[0], rel=1e-7, abs=1e-7), of.name
