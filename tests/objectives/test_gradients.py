"""Complex-step gradients of every quantity against differences with Richardson extrapolation."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.peaks import STORED_PEAKS
from slidercrank.objectives.bar_pieces import BarPieces, BarQuantity
from slidercrank.objectives.closed_form import ClosedFormQuantity
from slidercrank.objectives.pins import PinRubbing
from slidercrank.objectives.quantity import Group, Pieces, Quantity
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import MACHINES, SMOOTH, Array, fitted, random_designs, random_friction, random_machine
from tests.model.test_averages_over_time import random_case
from tests.objectives.richardson import Function, derivatives, steps_to_the_nearest_edge

pytestmark = pytest.mark.usefixtures("shared_batches")
DESIGNS = random_designs(1000, seed=1)
"""Margins from 1e-3 to 3."""

# The rule is 1e-7 of the gradient's size. Measured: 99 % of the designs below 1e-9, the rest up to 5e-8 where the
# extrapolation takes an entry that agrees with its parents by chance.
CLOSE = 1e-7
_TWINS = 5e-3  # rad


def designs_for(quantity: Quantity, count: int) -> int:
    """Return how many designs are enough: twice as many say the same.

    Means of rubbing take a millisecond each. Wear is the mean of pv, whose gradient is tested, times another number.
    """
    if isinstance(quantity, PinRubbing):
        return 2 if quantity.name.startswith("wear") else 8
    return count


# A closed form does not depend on the machine.
CASES = [
    pytest.param(quantity, fitted(quantity, machine), id=f"{quantity.name}-{name}")
    for quantity in QUANTITIES.values()
    for name, machine in MACHINES.items()
    if name == "smooth" or not isinstance(quantity, ClosedFormQuantity)
]


def same_piece(quantity: Quantity, machine: Mechanism, designs: Array, which: Any = 0) -> tuple[Function, Array]:
    """Return the piece `which` of every design as a function of displaced designs, and its gradients here.

    A quantity is the greatest of smooth pieces, with kinks where two tie. Displaced designs within a hair of a kink
    have another greatest piece; followed by its label (a crank angle, or a number) the piece itself is smooth, so no
    design has to be left out.
    """
    pieces = quantity.pieces(machine, designs)
    rows = np.arange(len(designs))
    label, value = pieces.labels[rows, which], pieces.values[rows, which]

    def function(displaced: Array, index: NDArray[np.int64]) -> Array:
        if pieces.values.shape[1] == 1:
            return quantity.evaluate(machine, displaced).values
        there: Pieces | BarPieces
        if isinstance(quantity, BarQuantity):  # without gradients, which take most of the time
            there = quantity.join_parts(machine, displaced, STORED_PEAKS, False)
        else:
            there = quantity.pieces(machine, displaced)
        away = np.abs(there.labels - label[index, None])
        away = np.minimum(away, np.abs(away - 2.0 * np.pi))
        if quantity.group is Group.STRENGTH:  # pairs of crank angles may agree in their label by chance
            away = away + np.abs(there.values / value[index, None] - 1.0)
            # The end of a segment is listed besides the maximum next to it, which alone is active: the worse of both.
            near = away < np.nanmin(np.where(np.isfinite(there.values), away, np.nan), axis=1, keepdims=True) + _TWINS
            away = np.where(near, there.values if pieces.least else -there.values, np.inf)
        nearest = np.nanargmin(np.where(np.isfinite(there.values), away, np.nan), axis=1)
        found: Array = there.values[np.arange(len(displaced)), nearest]
        return found

    return function, pieces.gradients[rows, which]


def greatest_piece(quantity: Quantity, machine: Mechanism, designs: Array) -> NDArray[np.int64]:
    pieces = quantity.pieces(machine, designs)
    found: NDArray[np.int64] = (np.argmin if pieces.least else np.argmax)(pieces.values, axis=1)
    return found


def away(gradients: Array, expected: Array) -> Array:
    """Return the greatest error of each design's gradient over the size of the gradient."""
    size = np.abs(expected).max(axis=1)
    found: Array = np.abs(gradients - expected).max(axis=1) / np.where(size > 0.0, size, 1.0)
    return found


@pytest.mark.parametrize(("quantity", "machine"), CASES)
def test_gradient_is_that_of_extrapolated_differences(quantity: Quantity, machine: Mechanism) -> None:
    # A fifth of them within 0.3 % of locking.
    designs = DESIGNS[: designs_for(quantity, 75 if machine is SMOOTH else 30)]
    first = steps_to_the_nearest_edge(designs, kink_without_offset=True)
    function, _ = same_piece(quantity, machine, designs, greatest_piece(quantity, machine, designs))
    expected, _ = derivatives(function, designs, first)
    gradients = quantity.evaluate(machine, designs, gradients=True).gradients
    assert gradients is not None
    assert away(gradients, expected).max() < CLOSE


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize(
    "quantity",
    [
        QUANTITIES[name]
        for name in ("peak_torque", "position_error", "position_error_rss", "peak_guide_force", "footprint")
    ],
    ids=lambda quantity: quantity.name,
)
def test_gradient_of_the_second_piece_is_that_of_extrapolated_differences(quantity: Quantity, name: str) -> None:
    """A solver that meets a kink follows both pieces; the second one is not the greatest anywhere near."""
    machine = MACHINES[name]
    values = quantity.pieces(machine, DESIGNS).values
    second = np.argsort(-values, axis=1, kind="stable")[:, 1]
    exists = np.flatnonzero(np.isfinite(values[np.arange(len(DESIGNS)), second]))[:150]
    designs, second = DESIGNS[exists], second[exists]
    assert len(designs) > 100
    function, gradients = same_piece(quantity, machine, designs, second)
    first = steps_to_the_nearest_edge(designs, kink_without_offset=True)
    expected, _ = derivatives(function, designs, first)
    error = away(gradients, expected)
    # A low peak may merge with another one or leave over a breakpoint within any step of some designs.
    assert np.quantile(error, 0.97) < CLOSE


@pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=QUANTITIES)
def test_gradient_holds_for_random_machines(quantity: Quantity) -> None:
    random = np.random.default_rng(5)
    designs = random_designs(6, seed=6)[: 2 if isinstance(quantity, PinRubbing) else 6]
    first = steps_to_the_nearest_edge(designs, kink_without_offset=True)
    for _ in range(8):
        machine = fitted(quantity, random_machine(random))
        if quantity.name.startswith("position_error"):
            continue  # without tolerances zero; the machines above have them
        function, _ = same_piece(quantity, machine, designs, greatest_piece(quantity, machine, designs))
        expected, _ = derivatives(function, designs, first)
        gradients = quantity.evaluate(machine, designs, gradients=True).gradients
        assert gradients is not None
        error = away(gradients, expected)
        # A peak of stress may pass over a breakpoint within the first steps: its slope is continuous, its curvature is
        # not, and what is extrapolated is the slope on the far side. Steps that stay on the near side decide.
        again = np.flatnonzero(error >= CLOSE) if quantity.group is Group.STRENGTH else np.arange(0)
        if len(again):
            function, _ = same_piece(
                quantity, machine, designs[again], greatest_piece(quantity, machine, designs[again])
            )
            expected, _ = derivatives(function, designs[again], first[again] / 512.0)
            error[again] = away(gradients[again], expected)
        assert error.max() < CLOSE


# Rod to offset is infinite there.
@pytest.mark.parametrize(("quantity", "machine"), [case for case in CASES if "rod_to_offset" not in str(case.id)])
def test_gradient_without_offset_is_that_towards_positive_offsets(quantity: Quantity, machine: Mechanism) -> None:
    """At e = 0 lies a kink of all that depends on |e|, and symmetric machines tie there: one-sided differences."""
    designs = random_designs(designs_for(quantity, 15), seed=8) * [1.0, 1.0, 0.0]
    function, _ = same_piece(quantity, machine, designs, greatest_piece(quantity, machine, designs))
    first = steps_to_the_nearest_edge(designs, kink_without_offset=False)
    gradients = quantity.evaluate(machine, designs, gradients=True).gradients
    assert gradients is not None
    lengths, _ = derivatives(function, designs, first)
    offset, _ = derivatives(function, designs, 0.25 * first, one_sided=True)
    size = np.abs(gradients).max(axis=1, keepdims=True)
    size = np.where(size > 0.0, size, 1.0)
    assert np.max(np.abs(gradients - lengths)[:, :2] / size) < CLOSE
    # Forward differences gain a power of the step per extrapolation, not two.
    assert np.max(np.abs(gradients - offset)[:, 2:] / size) < 1e-6


# All that follows from joint forces, and the margin itself.
RUBBED = ("peak_torque", "rms_torque", "mean_torque", "peak_power", "mean_power", "self_locking_margin")


@pytest.mark.parametrize("name", [*RUBBED, "peak_pivot_force", "peak_crank_pin_force", "peak_guide_force"])
def test_gradient_with_friction_is_that_of_extrapolated_differences(name: str) -> None:
    """Torque jumps at breakpoints that move, and kinks where the guide's force changes sides."""
    random = np.random.default_rng(9)
    quantity = QUANTITIES[name]
    # Rods 30 % and more longer than crank + offset: none locks, nor do the displaced ones.
    designs = random_designs(8, seed=10, least_margin=0.3)
    first = 0.3 * steps_to_the_nearest_edge(designs, kink_without_offset=True)
    for _ in range(5):
        machine = dataclasses.replace(random_machine(random), friction=random_friction(random))
        function, _ = same_piece(quantity, machine, designs, greatest_piece(quantity, machine, designs))
        expected, _ = derivatives(function, designs, first)
        gradients = quantity.evaluate(machine, designs, gradients=True).gradients
        assert gradients is not None
        assert away(gradients, expected).max() < CLOSE


AVERAGES = ("rms_torque", "mean_torque", "torque_fluctuation", "mean_power", "rms_shaking_force", "rms_shaking_moment")


@pytest.mark.parametrize("seed", [1, 2, 3, 4, 10])  # harmonics, a table, several cylinders, two turns, friction
@pytest.mark.parametrize("name", AVERAGES)
def test_gradient_of_an_average_along_a_profile_is_that_of_extrapolated_differences(name: str, seed: int) -> None:
    """Averages over time as over the crank angle.

    A jump at a breakpoint that moves counts by the time per angle there.
    """
    quantity, case = QUANTITIES[name], random_case(seed)
    designs = random_designs(1, seed=10 + seed, least_margin=0.5)
    first = 0.3 * steps_to_the_nearest_edge(designs, kink_without_offset=True)
    function, gradients = same_piece(quantity, case.machine, designs)
    expected, _ = derivatives(function, designs, first)
    assert away(gradients, expected).max() < CLOSE
