"""Quantities of a swing: against single designs, dense sweeps and extrapolated differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Friction, Pin, RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.crank_torque import CrankTorque, CrankTorqueTable
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.swing.forces import swing_curves
from slidercrank.model.swing.request_and_summary import summarise_swing
from slidercrank.model.swing.swing import Swing, slow_swing
from slidercrank.objectives.swing_quantity import SwingQuantity
from slidercrank.objectives.tables.swing_columns import quantities_for_swing, swing_quantities, swing_quantity_facts
from tests.model.cases import Array
from tests.model.swing.swings import Case, random_swings
from tests.objectives.richardson import derivatives

TOLERANCES = Tolerances(
    crank=Tolerance(fraction=1e-3), rod=Tolerance(absolute=2e-4), crank_angle=Tolerance(absolute=1e-3)
)


def cases(count: int, *, seed: int, friction: bool) -> list[Case]:
    """Return random swings whose loads are counted from the crank pivot, with tolerances."""
    found = []
    for machine, linkage, swing in random_swings(6 * count, seed=seed, friction=friction):
        if not any(getattr(load, "datum", "").endswith("dead centre") for load in machine.loads):
            actuator = 1e-3 if swing.driver == "slider" else 0.0
            found.append(
                (replace(machine, tolerances=TOLERANCES), linkage, replace(swing, actuator_tolerance=actuator))
            )
    assert len(found) >= count
    return found[:count]


def design_of(linkage: Linkage) -> Array:
    return np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])


def values(machine: Mechanism, swing: Swing, design: Array) -> dict[str, float]:
    own = swing_quantities(swing)
    return {of.name: float(of.evaluate(machine, design).values[0]) for of in own if not of.unmet_need(machine, "equal")}


@pytest.mark.slow
@pytest.mark.parametrize("friction", [False, True])
def test_quantities_are_those_of_a_single_design(friction: bool) -> None:
    for machine, linkage, swing in cases(14, seed=71, friction=friction):
        one = summarise_swing(machine, linkage, swing)
        found = values(machine, swing, design_of(linkage))
        kind = "force" if swing.driver == "slider" else "torque"
        error = "swing_angle_error" if swing.driver == "slider" else "swing_position_error"
        assert one.position_error is not None
        expected = {
            f"peak_actuator_{kind}": abs(one.peak_drive.value),
            f"holding_{kind}": max(map(abs, one.drive_start + one.drive_end)),
            error: one.position_error.value,
            "swing_energy": one.energy_forward,
            "swing_transmission_angle": one.least_transmission.value,
            "actuator_travel": one.travel,
        }
        if one.peak_power is not None:
            expected["peak_actuator_power"] = abs(one.peak_power.value)
        if friction and one.efficiency is not None:
            expected["swing_efficiency"] = one.efficiency
        for name, value in expected.items():
            assert found.pop(name) == pytest.approx(value, rel=1e-9, abs=1e-9 * abs(one.energy_forward)), name
        if friction:
            slow = summarise_swing(replace(machine, friction=Friction()), linkage, slow_swing(swing))
            held = max(map(abs, slow.drive_start + slow.drive_end))
            assert found.pop(f"holding_{kind}_without_friction") == pytest.approx(held, rel=1e-9)
        assert not set(found) - {"swing_efficiency", f"least_{kind}_forth", f"least_{kind}_back"}


@pytest.mark.parametrize("friction", [False, True])
def test_peaks_are_not_below_a_dense_sweep(friction: bool) -> None:
    share = np.linspace(0.0, 1.0, 20_001)
    for machine, linkage, swing in cases(20, seed=72, friction=friction):
        found = values(machine, swing, design_of(linkage))
        peak = found["peak_actuator_force" if swing.driver == "slider" else "peak_actuator_torque"]
        curves = [swing_curves(machine, linkage, swing, share, back=back) for back in (False, True)]
        swept = max(np.abs(curve.drive).max() for curve in curves)
        assert swept <= peak * (1.0 + 1e-12)
        assert swept == pytest.approx(peak, rel=1e-3)


@pytest.mark.parametrize("friction", [False, True])
def test_least_drives_are_those_of_a_dense_sweep(friction: bool) -> None:
    """Signed along the motion of each way; a linkage that both ways must drive holds itself."""
    share, held = np.linspace(0.0, 1.0, 20_001), set()
    for machine, linkage, swing in cases(6, seed=74, friction=friction):
        found, slow = values(machine, swing, design_of(linkage)), slow_swing(swing)
        least = []
        for back, way in ((False, "forth"), (True, "back")):
            curves = swing_curves(machine, linkage, slow, share, back=back)
            along = np.sign(curves.rate[10_000]) * curves.drive
            value = found[f"least_{'force' if swing.driver == 'slider' else 'torque'}_{way}"]
            assert value <= along.min() + 1e-12 * np.abs(along).max()
            assert value == pytest.approx(along.min(), abs=1e-3 * np.abs(along).max())
            least.append(value)
        assert summarise_swing(machine, linkage, slow).holds == (friction and min(least) >= 0.0)
        held.add(min(least) > 0.0)
    assert False in held


@pytest.mark.slow
@pytest.mark.parametrize("friction", [False, True])
def test_gradients_are_those_of_extrapolated_differences(friction: bool) -> None:
    """Cuts move with the design: knots, sides of friction, dead points that a crank passes."""
    misses = []
    for machine, linkage, swing in cases(7, seed=73, friction=friction):
        design = design_of(linkage)
        for of in swing_quantities(swing):
            if of.unmet_need(machine, "equal"):
                continue

            def function(displaced: Array, _: object, of: SwingQuantity = of, machine: Mechanism = machine) -> Array:
                return of.evaluate(machine, displaced).values

            expected, _ = derivatives(function, design, np.full((1, 3), 2e-3 * float(linkage.crank)))
            found = of.evaluate(machine, design, gradients=True)
            slopes = found.gradients
            if not np.isfinite(found.values).all():
                continue
            assert slopes is not None
            size = np.abs(expected).max() + 1e-9
            misses.append((float(np.abs(slopes - expected).max() / size), of.name, swing.driver, swing.law))
    assert max(misses)[0] < 1e-7, max(misses)


PIN = Pin(radius=0.1, coefficient=0.5)
ANGLES, FORCES = tuple(np.radians([60.0, 90.0, 120.0]).tolist()), (0.0, 100.0, 0.0)
TORQUE, FORCE = CrankTorqueTable(angles=ANGLES, forces=FORCES), AngleTable(angles=ANGLES, forces=FORCES)
JUMPS = [  # the rod turns back at 90 deg; it overtakes the crank where the slider passes the pivot, 2.25 rad
    (TORQUE, Swing(start=np.radians(60.0), end=np.radians(120.0), driver="slider"), [1.0, 2.0, -0.3]),
    (TORQUE, Swing(start=np.radians(120.0), end=np.radians(60.0), driver="slider"), [1.0, 2.0, 0.3]),
    (FORCE, Swing(start=np.radians(60.0), end=np.radians(120.0), driver="crank"), [1.0, 2.0, -0.3]),
    (CrankTorque(torque=100.0), Swing(start=1.6, end=2.8, driver="slider"), [1.0, 0.8, 0.3]),
    (CrankTorque(torque=100.0), Swing(start=1.6, end=2.8, driver="crank"), [1.0, 0.9, 0.3]),
]


@pytest.mark.parametrize(("load", "swing", "design"), JUMPS)
def test_a_peak_on_a_jump_of_friction_is_of_the_greater_side(load: Load, swing: Swing, design: list[float]) -> None:
    machine = Mechanism(
        slider_mass=1.0, gravity=(40.0, 10.0), friction=Friction(slider_pin=PIN, crank_pin=PIN), loads=(load,)
    )
    share = np.linspace(0.0, 1.0, 40_001)
    curves = [
        swing_curves(machine, Linkage(design[0], design[1], design[2]), swing, share, back=back)
        for back in (False, True)
    ]
    swept = max(np.abs(curve.drive).max() for curve in curves)
    found = values(machine, swing, np.array([design]))
    peak = found["peak_actuator_force" if swing.driver == "slider" else "peak_actuator_torque"]
    assert peak == pytest.approx(swept, rel=1e-4)
    assert peak >= swept * (1.0 - 1e-12)


def test_what_cannot_swing_has_no_value_and_every_fact_has_a_place() -> None:
    closing, opening = [0.1, 0.25, 0.02], [0.1, 0.05, 0.2]
    for driver in ("crank", "slider"):
        swing = Swing(start=0.5, end=1.5, driver=driver)
        machine = Mechanism(slider_mass=1.0, gravity=(-9.81, 0.0), tolerances=TOLERANCES)
        for of in swing_quantities(swing):
            if of.unmet_need(machine, "equal"):
                continue
            found = of.evaluate(machine, np.array([closing, opening, [np.nan, 0.2, 0.0]])).values
            assert np.isfinite(found).tolist() == [True, False, False], of.name
            assert np.isnan(of.pieces(machine, np.array([opening])).values[0, 0]), of.name
    assert len({of.place for of in swing_quantity_facts()}) == len(swing_quantity_facts())


def test_numbers_that_vary_change_nothing_but_the_count_of_derivatives() -> None:
    """Values with and without derivatives are those of the machine that has these numbers; a spring's too."""
    spring = CrankTorque(crank_stiffness=20.0, free_angle=1.2)
    for driver in ("crank", "slider"):
        swing = Swing(start=0.5, end=1.5, driver=driver)
        machine = Mechanism(slider_mass=1.0, gravity=(-9.81, 0.0), tolerances=TOLERANCES, loads=(spring,))
        sets = (("loads.0.crank_stiffness", 1.0),)
        free = replace(machine, varying=(Varying(name="spring", sets=sets, lower=1.0, upper=30.0),))
        designs = np.array([[0.1, 0.25, 0.02, 20.0]])
        for of in swing_quantities(swing):
            if of.unmet_need(machine, "equal"):
                continue
            value = of.evaluate(free, designs).values
            found = of.evaluate(free, designs, gradients=True)
            assert value == pytest.approx(of.evaluate(machine, designs[:, :3]).values, rel=1e-13), of.name
            assert found.values == pytest.approx(value, rel=1e-13)
            assert found.gradients is not None
            step = np.array([[0.0, 0.0, 0.0, 1e-3]])
            up, down = (of.evaluate(free, design).values for design in (designs + step, designs - step))
            slope = (up - down) / 2e-3
            assert found.gradients[:, 3] == pytest.approx(slope, rel=1e-7, abs=1e-9 * abs(value[0])), of.name


def test_masses_are_of_a_swing_too() -> None:
    """A bar's mass follows its length; the exact slope is rho d w."""
    rod = Bar(width=0.05, depth=0.02, density=7800.0)
    machine = Mechanism(crank=RigidLink(mass=3.0), rod=rod, slider_mass=2.0)
    swing = Swing(start=0.2, end=1.4, driver="slider")
    names = {of.name: of for of in quantities_for_swing(swing_quantities(swing))}
    design = np.array([[0.4, 1.3, 0.05], [0.5, 0.9, -0.1]])
    found = names["moving_mass"].evaluate(machine, design, gradients=True)
    bar = 7800.0 * 0.02 * (0.05 * design[:, 1] + 0.25 * np.pi * 0.05**2)
    assert names["crank_mass"].evaluate(machine, design).values == pytest.approx(3.0)
    assert names["rod_mass"].evaluate(machine, design).values == pytest.approx(bar, rel=1e-14)
    assert found.values == pytest.approx(5.0 + bar, rel=1e-14)
    assert found.gradients == pytest.approx(np.array([[0.0, 7.8, 0.0]] * 2), rel=1e-14)
