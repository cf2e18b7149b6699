"""Screening gives what `find_peaks` gives, for smooth curves."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Branch, Mechanism, Tolerances, Window
from slidercrank.model.signals import fast_torque_and_error
from slidercrank.model.signals.fast_torque_and_error import LANES, Screened, supports_screening
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.cases import SMOOTH, STROKES, TABLES, TOLERANCES, Array, random_designs, random_machine

DESIGNS = random_designs(3000, seed=51)
SCREENED = (Signal.TORQUE, Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS)


def screen(machine: Mechanism, signal: Signal, designs: Array, *, gradients: bool = False) -> Screened:
    return fast_torque_and_error.screened_maxima(machine, (signal,), designs, gradients=gradients, places=True)[0]


@pytest.mark.parametrize("signal", SCREENED, ids=lambda signal: signal.name)
@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_screening_equals_peaks_where_the_curve_is_smooth(signal: Signal, branch: Branch) -> None:
    machine = dataclasses.replace(SMOOTH, branch=branch)
    assert supports_screening(machine, signal)
    exact = find_peaks(machine, signal, DESIGNS, gradients=True)
    fast = screen(machine, signal, DESIGNS, gradients=True)
    assert exact.gradients is not None
    assert fast.gradients is not None
    # Two ways to the same root of the slope; rounding near locking makes 1e-13.
    np.testing.assert_allclose(fast.values, exact.values[:, 0], rtol=1e-12)
    # Of two peaks that tie, either may be taken: the gradient is then that of the other one.
    clear = exact.values[:, 1] < (1.0 - 1e-9) * exact.values[:, 0]
    assert clear.mean() > 0.99
    scale = np.abs(exact.gradients[:, 0]).max(axis=1, keepdims=True)
    away = np.abs(fast.gradients - exact.gradients[:, 0]) / scale
    # Seven secant steps leave a root of the slope up to 1e-6 rad off, and the gradient turns with the angle.
    assert away[clear].max() < 2e-6
    turn = np.angle(np.exp(1j * (fast.angles - exact.angles[:, 0])))
    assert np.abs(turn[clear]).max() < 3e-6


def test_screening_holds_for_random_smooth_machines() -> None:
    random = np.random.default_rng(52)
    for designs in np.array_split(DESIGNS, 20):
        machine = random_machine(random, loads=False)
        machine = dataclasses.replace(
            machine,
            loads=(
                StrokeForce(outward=-90.0, inward=-90.0),
                Spring(stiffness=300.0, free_position=0.1, datum="outer dead centre"),
                Viscous(coefficient=30.0),
            ),
        )
        exact = find_peaks(machine, Signal.TORQUE, designs, limit=1).values[:, 0]
        np.testing.assert_allclose(screen(machine, Signal.TORQUE, designs).values, exact, rtol=1e-12)


def test_screening_is_never_above_and_hardly_below_where_a_load_changes_at_the_dead_centres() -> None:
    machine = dataclasses.replace(STROKES, tolerances=TOLERANCES)
    exact = find_peaks(machine, Signal.TORQUE, DESIGNS, limit=1).values[:, 0]
    fast = screen(machine, Signal.TORQUE, DESIGNS).values
    assert np.all(fast <= exact * (1.0 + 1e-12))
    # The spacing of 64 angles, to the first order of a kink.
    assert np.all(fast >= 0.9 * exact)


@pytest.mark.parametrize("count", [0, 1, LANES - 1, LANES, LANES + 1, 16 * LANES + 3])
def test_number_of_designs_does_not_matter(count: int) -> None:
    whole = screen(SMOOTH, Signal.TORQUE, DESIGNS, gradients=True)
    part = screen(SMOOTH, Signal.TORQUE, DESIGNS[:count], gradients=True)
    assert whole.gradients is not None
    assert part.gradients is not None
    np.testing.assert_array_equal(part.values, whole.values[:count])
    np.testing.assert_array_equal(part.gradients, whole.gradients[:count])


def test_what_screening_does_not_handle_it_says() -> None:
    windowed = Mechanism(tolerances=Tolerances(window=Window(end=0.5)))
    assert not supports_screening(TABLES, Signal.TORQUE)
    assert not supports_screening(windowed, Signal.POSITION_ERROR)
    assert not supports_screening(SMOOTH, Signal.TORQUE, during="inward stroke")
    assert not supports_screening(SMOOTH, Signal.GUIDE_FORCE)
    # The position error does not depend on loads.
    assert supports_screening(dataclasses.replace(TABLES, tolerances=TOLERANCES), Signal.POSITION_ERROR)


@pytest.mark.parametrize("gradients", [False, True])
def test_several_signals_together_are_what_each_is_alone(gradients: bool) -> None:
    together = fast_torque_and_error.screened_maxima(SMOOTH, SCREENED, DESIGNS, gradients=gradients)
    for signal, found in zip(SCREENED, together, strict=True):
        alone = screen(SMOOTH, signal, DESIGNS, gradients=gradients)
        np.testing.assert_allclose(found.values, alone.values, rtol=1e-13)
