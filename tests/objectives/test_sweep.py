"""Sweeps over dimensions and speed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.sensitivity import Axis, sweep
from tests.model.cases import SMOOTH

DESIGN = np.array([0.04, 0.064, 0.0])
FEEDER = Mechanism(speed=251.0, crank=RigidLink(mass=0.2), rod=RigidLink(mass=0.5), slider_mass=0.8)


def test_sweep_of_case_five_has_its_exact_strokes_and_time_ratios() -> None:
    """Obaseki and Alfred: crank 40, rod 64 mm, offset 0, 10, 20 mm. Figures by the closed forms, not as printed."""
    table = sweep(FEEDER, DESIGN, [Axis("offset", (0.0, 0.01, 0.02))], ["stroke", "time_ratio", "peak_torque"])
    np.testing.assert_allclose(table["stroke_mm"], [80.0, 81.700690, 88.792308], atol=1.01e-6)
    np.testing.assert_allclose(table["time_ratio"], [1.0, 1.237506, 1.673701], atol=1e-6)
    assert table["peak_torque_Nm"].is_monotonic_increasing
    assert list(table["reason"]) == ["", "", ""]
    assert list(table["offset_mm"]) == [0.0, 10.0, 20.0]
    np.testing.assert_allclose(table["speed_rpm"], 251.0 * 30.0 / math.pi)


def test_every_row_is_the_quantity_of_that_machine_alone() -> None:
    axes = [Axis("speed", (-20.0, 5.0, 30.0)), Axis("rod", (0.2, 0.3))]
    names = ["peak_torque", "position_error", "peak_slider_speed", "stroke"]
    table = sweep(SMOOTH, np.array([0.04, 9.9, 0.03]), axes, names)
    assert len(table) == 6
    n = 0
    for speed in axes[0].values:
        for rod in axes[1].values:
            machine = replace(SMOOTH, speed=speed)
            for name in names:
                quantity = QUANTITIES[name]
                alone = quantity.evaluate(machine, np.array([[0.04, rod, 0.03]])).values[0] * quantity.unit.factor
                assert table[quantity.field][n] == pytest.approx(alone, rel=1e-14)
            assert table["rod_mm"][n] == pytest.approx(1e3 * rod)
            n += 1


def test_linkage_that_does_not_turn_has_no_value_but_a_reason() -> None:
    table = sweep(FEEDER, DESIGN, [Axis("offset", (0.02, 0.03, 0.2))], ["stroke", "peak_torque"])
    assert table["reason"][0] == ""
    assert "rod must exceed crank + |offset| for full rotation" in table["reason"][1]
    assert "linkage cannot close" in table["reason"][2]
    assert table.loc[1:, ["stroke_mm", "peak_torque_Nm"]].isna().all(axis=None)
    assert table["stroke_mm"][0] == pytest.approx(1e3 * Linkage(0.04, 0.064, 0.02).stroke)


def test_wrong_sweeps_are_refused() -> None:
    axis = Axis("offset", (0.0,))
    for over, of, message in (
        ([], ["stroke"], "needs a parameter"),
        ([axis], [], "needs a parameter and a quantity"),
        ([axis, axis], ["stroke"], "different parameters; got offset, offset"),
        ([axis], ["strok"], "did you mean stroke"),
        ([Axis("rod", tuple(np.linspace(0.1, 1.0, 2000))), Axis("crank", (0.1,) * 600)], ["stroke"], "1,200,000"),
    ):
        with pytest.raises(InputError, match=message):
            sweep(FEEDER, DESIGN, over, of)
    with pytest.raises(InputError, match="a sweep must be over one of crank, rod, offset, speed; got 'mass'"):
        Axis("mass", (1.0,))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="all finite"):
        Axis("rod", (1.0, math.nan))
