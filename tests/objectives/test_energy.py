"""Energy of a cycle: balance, the analysis of one design, closed forms, derivatives with friction in all joints."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import Energies, cycle_energies
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction, Pin
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.crank_torque import CrankTorque
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import Array, linkage_of, random_designs, random_friction, random_machine
from tests.model.swing.swings import crank_loads
from tests.objectives.richardson import derivatives, steps_to_the_nearest_edge

# None of them locks, nor do displaced ones.
DESIGNS = random_designs(6, seed=81, least_margin=0.3)
EFFICIENCY, ENERGY, LOSS = (QUANTITIES[name] for name in ("efficiency", "energy_per_cycle", "friction_loss"))
NAMES = ("efficiency", "energy_per_cycle", "friction_loss")


def rubbing_machines(count: int, *, seed: int) -> list[Mechanism]:
    random = np.random.default_rng(seed)
    return [replace(random_machine(random), friction=random_friction(random), acceleration=0.0) for _ in range(count)]


def _values_of(quantity: Quantity, machine: Mechanism, designs: Array, _: object) -> Array:
    return quantity.evaluate(machine, designs).values


def values(name: str, machine: Mechanism, designs: Array = DESIGNS) -> Array:
    return QUANTITIES[name].evaluate(machine, designs).values


def balances(found: Energies, efficiency: float, energy: float, loss: float) -> bool:
    """Check an efficiency and the balance of a cycle by the analysis of one design; return whether it is driven."""
    assert energy == pytest.approx(found.useful + loss, abs=1e-11 * found.throughput)
    assert efficiency == pytest.approx(found.efficiency, rel=1e-10)
    return found.useful > 0.0


def test_they_are_those_of_the_analysis_of_one_design_and_balance() -> None:
    driven = 0
    for machine in rubbing_machines(6, seed=82):
        efficiency, energy, loss = (values(name, machine) for name in NAMES)
        for n, design in enumerate(DESIGNS):
            found = cycle_energies(machine, linkage_of(design, machine.branch))
            assert energy[n] == pytest.approx(found.input, abs=1e-11 * found.throughput)
            assert loss[n] == pytest.approx(found.heat, rel=1e-11)
            driven += balances(found, efficiency[n], energy[n], loss[n])
    assert 0 < driven < 36


def test_what_torques_on_the_crank_take_is_useful_too() -> None:
    random, driven = np.random.default_rng(85), 0
    for machine in rubbing_machines(4, seed=85):
        torques = crank_loads(random, spring=False)
        for loads in ((*machine.loads, *torques), torques):
            own = replace(machine, loads=loads)
            efficiency, energy, loss = (values(name, own) for name in NAMES)
            for n, design in enumerate(DESIGNS):
                found = cycle_energies(own, linkage_of(design, machine.branch))
                driven += balances(found, efficiency[n], energy[n], loss[n])
    assert 0 < driven < 48


def test_a_guide_that_rubs_under_its_own_weight_loses_the_path_times_its_friction() -> None:
    """A rod without mass and next to no load: the guide carries the slider's weight over twice the stroke."""
    machine = Mechanism(
        speed=1e-4,
        slider_mass=3.0,
        gravity=(0.0, -9.81),
        friction=Friction(guide=1e-9),
        loads=(StrokeForce(outward=-1e-9, inward=1e-9),),
    )
    stroke = np.asarray(Linkage(*DESIGNS.T).stroke)
    assert values("friction_loss", machine) == pytest.approx(1e-9 * 3.0 * 9.81 * 2.0 * stroke, rel=1e-6)


def test_a_pivot_under_a_steady_force_turns_through_a_whole_circle() -> None:
    # A crank that weighs, and nothing else: |P| = m g, rho |P| over a turn.
    machine = Mechanism(
        speed=0.0,
        gravity=(0.0, -9.81),
        friction=Friction(crank_pivot=Pin(radius=0.02, coefficient=0.1)),
        crank=replace(random_machine(np.random.default_rng(1)).crank),
    )
    mass = values("crank_mass", machine)
    assert values("friction_loss", machine) == pytest.approx(2.0 * math.pi * 0.002 * mass * 9.81, rel=1e-12)
    assert values("energy_per_cycle", machine) == pytest.approx(values("friction_loss", machine), rel=1e-12)


def test_a_cycle_of_two_turns_counts_both() -> None:
    angles = tuple(np.linspace(0.0, 4.0 * math.pi, 9)[:-1])
    forces = (0.0, -300.0, 200.0, 50.0, 0.0, 80.0, -40.0, -90.0)
    table = AngleTable(angles=angles, forces=forces, cycle="720 deg")
    machine = Mechanism(speed=5.0, slider_mass=1.0, loads=(table,), friction=Friction(guide=0.05))
    design = np.array([[0.05, 0.2, 0.02]])
    found = cycle_energies(machine, linkage_of(design[0]))
    assert values("friction_loss", machine, design)[0] == pytest.approx(found.heat, rel=1e-10)
    assert values("energy_per_cycle", machine, design)[0] == pytest.approx(found.input, rel=1e-9)
    assert values("delivered_work", machine, design)[0] == pytest.approx(-found.input, rel=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_gradients_with_friction_in_all_joints_are_those_of_extrapolated_differences(name: str) -> None:
    quantity = QUANTITIES[name]
    more = (
        Varying(name="guide", sets=(("friction.guide", 1.0),), lower=0.05, upper=0.2),
        Varying(name="pin", sets=(("friction.crank_pin.radius", 1.0),), lower=0.002, upper=0.01),
        Varying(name="speed", sets=(("speed", 1.0),), lower=2.0, upper=30.0),
    )
    resistance = StrokeForce(outward=-2000.0, inward=2000.0)
    for machine in rubbing_machines(3, seed=84):
        loads = (*machine.loads, resistance, CrankTorque(torque=-150.0, resistance=20.0))
        machine = replace(machine, loads=loads, speed=10.0, varying=more)
        designs = np.column_stack([DESIGNS, np.tile([0.1, 0.005, 10.0], (len(DESIGNS), 1))])
        lengths = 0.3 * steps_to_the_nearest_edge(DESIGNS, kink_without_offset=True)
        first = np.column_stack([lengths, np.tile([0.01, 0.0005, 1.0], (len(DESIGNS), 1))])
        expected, _ = derivatives(partial(_values_of, quantity, machine), designs, first)
        gradients = quantity.evaluate(machine, designs, gradients=True).gradients
        assert gradients is not None
        size = np.abs(expected).max(axis=1, keepdims=True)
        assert np.max(np.abs(gradients - expected) / size) < 1e-7


def test_friction_that_locks_makes_every_design_the_worst() -> None:
    machine = Mechanism(
        speed=3.0, friction=Friction(guide=5.0), loads=(StrokeForce(outward=-100.0, inward=100.0),), slider_mass=1.0
    )
    design = np.array([[0.1, 0.15, 0.03]])
    assert values("efficiency", machine, design)[0] == -math.inf
    assert values("friction_loss", machine, design)[0] == values("energy_per_cycle", machine, design)[0] == math.inf
    for name in NAMES:
        gradients = QUANTITIES[name].evaluate(machine, design, gradients=True).gradients
        assert gradients is not None
        assert np.all(gradients == 0.0)


def test_what_is_undefined_or_always_the_same_is_told() -> None:
    inert = Mechanism(speed=9.0, slider_mass=2.0, friction=Friction(guide=0.1))
    for machine in (inert, replace(inert, loads=(Spring(stiffness=500.0),))):
        assert "needs a load that absorbs or supplies net work" in str(EFFICIENCY.undefined_because([machine]))
        assert np.isnan(EFFICIENCY.evaluate(machine, DESIGNS, gradients=True).values).all()
        assert np.all(LOSS.evaluate(machine, DESIGNS).values > 0.0)
    resists = (StrokeForce(outward=-50.0, inward=50.0),)
    smooth = replace(inert, friction=Friction(), loads=resists)
    assert "of every design is 1" in str(EFFICIENCY.undefined_because([smooth]))
    assert EFFICIENCY.evaluate(smooth, DESIGNS).values == pytest.approx(np.ones(6), abs=1e-15)
    assert "friction" in str(LOSS.undefined_because([smooth]))
    assert np.all(LOSS.evaluate(smooth, DESIGNS).values == 0.0)
    assert EFFICIENCY.undefined_because([replace(inert, loads=resists)]) is None
    driving = replace(inert, loads=(StrokeForce(outward=50.0, inward=-50.0),))
    assert EFFICIENCY.evaluate(driving, DESIGNS).values == pytest.approx(
        1.0 - LOSS.evaluate(driving, DESIGNS).values / (100.0 * np.asarray(Linkage(*DESIGNS.T).stroke)), rel=1e-12
    )
    assert np.all(ENERGY.evaluate(driving, DESIGNS).values < 0.0)
