"""The table of all numbers of designs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError
from slidercrank.model.machine.mechanism import Clearances, Mechanism, Tolerances
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analyse
from tests.model.cases import MACHINES, SMOOTH, random_designs
from tests.model.virtual_work import drive_torque

DESIGNS = random_designs(30, seed=15)

# Keys of tables and JSON are promises: they never change, and come in this order.
PROMISED = [
    *("crank_mm", "rod_mm", "offset_mm", "stroke_mm", "time_ratio", "slow_stroke"),
    *("outer_dead_centre_deg", "inner_dead_centre_deg", "least_transmission_angle_deg"),
    *("peak_torque_Nm", "peak_torque_angle_deg", "rms_torque_Nm", "mean_torque_Nm"),
    *("position_error_mm", "position_error_rss_mm"),
    *("peak_pivot_force_N", "peak_crank_pin_force_N", "peak_slider_pin_force_N", "peak_guide_force_N"),
    *("peak_slider_speed_m_s", "peak_slider_acceleration_m_s2"),
    *("self_locking_margin_deg", "peak_power_W", "mean_power_W", "peak_reflected_inertia_kg_m2"),
    *("peak_shaking_force_N", "rms_shaking_force_N", "peak_shaking_moment_Nm", "rms_shaking_moment_Nm"),
]


def test_table_has_the_promised_columns_and_every_quantity() -> None:
    table = analyse(SMOOTH, DESIGNS)
    assert set(PROMISED) <= set(table.columns)
    assert {quantity.field for quantity in QUANTITIES.values()} <= set(table.columns)
    assert len(table) == 30


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_columns_are_the_quantities_in_the_units_they_name(machine: Mechanism) -> None:
    table = analyse(machine, DESIGNS)
    for quantity in QUANTITIES.values():
        expected = quantity.evaluate(machine, DESIGNS).values * quantity.unit.factor
        if quantity.undefined_because([machine]):
            expected = np.full(len(DESIGNS), np.nan)
        # The closed forms come from arrays here, from compiled loops there.
        np.testing.assert_allclose(table[quantity.field], expected, rtol=1e-12, err_msg=quantity.field)
    np.testing.assert_allclose(table["crank_mm"], 1e3 * DESIGNS[:, 0], rtol=1e-15)
    torque = np.abs(drive_torque(machine, DESIGNS, np.radians(table["peak_torque_angle_deg"].to_numpy())))
    np.testing.assert_allclose(torque, table["peak_torque_Nm"], rtol=1e-10)
    for end in ("outer", "inner"):
        assert table[f"{end}_dead_centre_deg"].between(0.0, 360.0, inclusive="left").all()


def test_one_design_is_one_row() -> None:
    table = analyse(Mechanism(speed=1.0), np.array([0.04, 0.064, -0.02]))
    assert len(table) == 1
    row = table.iloc[0]
    assert row["stroke_mm"] == pytest.approx(88.792307416, rel=1e-10)
    assert row["slow_stroke"] == "outward"
    assert row["least_transmission_angle_deg"] == pytest.approx(math.degrees(math.acos(60.0 / 64.0)), rel=1e-12)
    assert row["peak_torque_Nm"] == 0.0


def test_without_tolerances_a_position_error_is_not_defined_rather_than_zero() -> None:
    errors = ["position_error_mm", "position_error_rss_mm"]
    machine = Mechanism(speed=1.0)
    table = analyse(machine, DESIGNS)
    undefined = [quantity.field for quantity in QUANTITIES.values() if quantity.undefined_because([machine])]
    assert {*errors} < {*undefined}
    assert table[undefined].isna().all(axis=None)
    assert table.drop(columns=undefined).notna().all(axis=None)
    one = Tolerances(clearances=Clearances(guide=1e-5))
    assert (analyse(Mechanism(speed=1.0, tolerances=one), DESIGNS)[errors] > 0.0).all(axis=None)
    # A design that varies its tolerance down to none has an error of zero: the machine has tolerances.
    varying = Mechanism(
        speed=1.0, varying=(Varying(name="crank", sets=(("tolerances.crank.absolute", 1.0),), lower=0.0, upper=1e-4),)
    )
    designs = np.column_stack([DESIGNS, np.linspace(0.0, 1e-4, len(DESIGNS))])
    found = analyse(varying, designs)["position_error_mm"]
    assert found[0] == 0.0
    assert (found[1:] > 0.0).all()


def test_slow_stroke_is_that_at_the_direction_of_rotation() -> None:
    design = np.array([[0.04, 0.2, 0.02]])
    assert analyse(Mechanism(speed=3.0), design)["slow_stroke"][0] == "inward"
    assert analyse(Mechanism(speed=-3.0), design)["slow_stroke"][0] == "outward"
    assert analyse(Mechanism(speed=0.0), design)["slow_stroke"][0] == "inward"


def test_linkage_that_does_not_turn_fully_is_refused() -> None:
    with pytest.raises(AssemblyError, match="for full rotation; got rod 300 mm, crank 250 mm, offset 100 mm"):
        analyse(SMOOTH, np.array([[0.1, 0.3, 0.05], [0.25, 0.3, 0.1]]))
