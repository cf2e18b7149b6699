"""Promises of a worst case, against many machines within the tolerances and a local search among them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import qmc

from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.robust.quantity import RobustQuantity, Side
from slidercrank.objectives.robust.worst_points import tolerance_limits
from tests.model.cases import SMOOTH, STROKES

Array = NDArray[np.float64]
WIDE = Tolerances(crank=Tolerance(absolute=2e-4), rod=Tolerance(absolute=5e-4), offset=Tolerance(absolute=3e-3))
DESIGNS = np.array(
    [[0.05, 0.16, 0.0], [0.05, 0.16, 0.001], [0.04, 0.2, -0.0025], [0.05, 0.16, 0.04], [0.06, 0.15, -0.03]]
)


def worst_of_machines(
    name: str, side: Side, machine: Mechanism, design: Array, count: int, cube: Array
) -> tuple[float, Array]:
    """Return the worst value among machines within the limits, and it after shrinking the box around the worst ones."""
    reach = tolerance_limits(machine, design[None])[0]
    sign = 1.0 if side == "high" else -1.0

    def value(points: Array) -> Array:
        machines = design + np.clip(points, -1.0, 1.0) * reach
        return sign * QUANTITIES[name].evaluate(machine, machines).values

    points = 2.0 * cube[:count] - 1.0
    found = value(points)
    around, best = points[np.argmax(found)], float(found.max())
    for step in range(24):
        near = around + 0.6**step * (2.0 * cube[:64] - 1.0)
        found = value(near)
        if found.max() > best:
            around, best = np.clip(near[np.argmax(found)], -1.0, 1.0), float(found.max())
    return sign * best, around


@pytest.mark.parametrize("order", [1, 2])
def test_time_ratio_and_stroke_of_an_in_line_linkage_are_least_without_offset(order: int) -> None:
    machine = Mechanism(speed=30.0, tolerances=Tolerances(offset=Tolerance(absolute=3e-3)))
    design = np.array([[0.04, 0.16, 0.0], [0.04, 0.16, 0.002]])
    for name, least in (("time_ratio", 1.0), ("stroke", 0.08), ("transmission_angle", None)):
        quantity = RobustQuantity(inner=QUANTITIES[name], side="low", case="worst case", order=order)
        found = quantity.evaluate(machine, design, gradients=True)
        assert found.gradients is not None
        if least is not None:
            np.testing.assert_allclose(found.values, least, rtol=1e-14)
            assert (np.abs(found.gradients[:, 2]) < 1e-14).all()


@pytest.mark.parametrize("side", ["low", "high"])
@pytest.mark.parametrize("machine", [SMOOTH, STROKES], ids=["smooth", "strokes"])
def test_no_machine_within_the_tolerances_is_worse_than_promised(machine: Mechanism, side: Side) -> None:
    cube = qmc.Sobol(3, seed=5).random(1 << 17)
    machine = replace(machine, tolerances=WIDE)
    for name in (
        "time_ratio",
        "stroke",
        "transmission_angle",
        "footprint",
        "peak_torque",
        "rms_torque",
        "peak_guide_force",
    ):
        promised = (
            RobustQuantity(inner=QUANTITIES[name], side=side, case="worst case").evaluate(machine, DESIGNS).values
        )
        closed = name in ("time_ratio", "stroke", "transmission_angle", "footprint")
        for design, value in zip(DESIGNS, promised, strict=True):
            worst, _ = worst_of_machines(name, side, machine, design, 100_000 if closed else 1000, cube)
            bad = (worst - value) if side == "high" else (value - worst)
            assert bad <= 1e-9 * abs(value), (name, design)
            # And one machine is that bad.
            assert bad >= -1e-3 * abs(value), (name, design)
