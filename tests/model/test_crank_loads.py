"""Torques on the crank: against virtual work, an inertia that they equal, energies and a crank by itself."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.clearance.run import simulate as simulate_clearance
from slidercrank.model.cycle.cycle import cycle, cycle_energies
from slidercrank.model.errors import InputError, JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive
from slidercrank.model.machine.links_and_joints import Clearance, Counterweight, Friction, Pin, RigidLink
from slidercrank.model.machine.loads.crank_torque import CrankTorque, CrankTorqueTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.machine.work_absorption import may_do_work_over_a_turn
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.swing.forces import swing_curves
from slidercrank.model.swing.swing import Swing
from slidercrank.model.transient.forward_dynamics import simulate
from slidercrank.optimise.job import parse_job
from tests.model.cases import SMOOTH, STROKES, TABLES
from tests.model.swing.swings import crank_loads
from tests.model.virtual_work import drive_torque

DESIGNS = np.array([[0.05, 0.2, 0.03], [0.08, 0.25, -0.1], [0.06, 0.19, 0.128]])
RUBBING = Friction(
    guide=0.1, crank_pivot=Pin(radius=0.01, coefficient=0.1), crank_pin=Pin(radius=0.01, coefficient=0.1)
)
TABLE = CrankTorqueTable(angles=(0.4, 1.1, 2.5, 5.0), forces=(0.0, -30.0, 12.0, 5.0))
TURN = 2.0 * math.pi


def loaded(machine: Mechanism, *loads: Any) -> Mechanism:
    return replace(machine, loads=(*machine.loads, *loads))


@pytest.mark.parametrize("machine", [SMOOTH, STROKES, replace(TABLES, branch="crossed")])
def test_torque_peaks_and_means_are_those_of_virtual_work(machine: Mechanism) -> None:
    """Forces of the joints stay; the peaks are those of a dense sweep, the means those of its sums."""
    dense = np.linspace(0.0, TURN, 20_001)[:-1] + 1e-5
    for seed in range(3):
        own = loaded(machine, *crank_loads(np.random.default_rng(seed), spring=False), TABLE)
        for design in DESIGNS:
            linkage = Linkage(design[0], design[1], design[2], machine.branch)
            found, bare = cycle(own, linkage, dense), cycle(machine, linkage, dense)
            wanted = np.array([drive_torque(own, design, angle) for angle in dense[::997]])
            assert np.abs(found.torque[::997] - wanted).max() <= 1e-11 * np.abs(found.torque).max()
            assert np.array_equal(found.pivot_x, bare.pivot_x)
            for kind, curve in ((Signal.TORQUE, found.torque), (Signal.POWER, found.torque * own.speed)):
                peak = find_peaks(own, kind, design[None]).values[0, 0]
                swept = float(np.abs(curve).max())
                assert swept * (1.0 - 1e-9) <= peak <= swept * (1.0 + 2e-3)
            averages = torque_averages(own, design[None])
            assert averages.mean[0] == pytest.approx(found.torque.mean(), abs=2e-3 * abs(averages.rms[0]))
            assert averages.rms[0] == pytest.approx(math.sqrt(np.mean(found.torque**2)), rel=2e-3)


@pytest.mark.parametrize("friction", [Friction(), RUBBING])
def test_a_constant_torque_is_as_an_inertia_at_constant_acceleration(friction: Friction) -> None:
    """Values and gradients: neither moves a joint force."""
    bare = replace(STROKES, friction=friction, acceleration=15.0)
    heavy = replace(bare, counterweight=Counterweight(mass=0.0, radius=0.0, inertia=0.4))
    pulled = loaded(bare, CrankTorque(torque=-0.4 * 15.0))
    first, second = (find_peaks(machine, Signal.TORQUE, DESIGNS, gradients=True) for machine in (heavy, pulled))
    assert first.values[:, 0] == pytest.approx(second.values[:, 0], rel=1e-12)
    assert first.gradients is not None
    assert second.gradients is not None
    assert np.abs(first.gradients[:, 0] - second.gradients[:, 0]).max() <= 1e-10 * np.abs(first.gradients[:, 0]).max()
    one, two = (torque_averages(machine, DESIGNS, gradients=True) for machine in (heavy, pulled))
    assert one.mean == pytest.approx(two.mean, rel=1e-11)
    assert one.rms_gradients is not None
    assert two.rms_gradients is not None
    assert np.abs(one.rms_gradients - two.rms_gradients).max() <= 1e-9 * np.abs(one.rms_gradients).max()


def test_a_spring_in_resonance_takes_the_inertia_of_a_harmonic_swing() -> None:
    """With theta - middle = -a cos(pi t / T) the acceleration is -(pi / T)^2 (theta - middle)."""
    swing = Swing(start=0.4, end=1.9, law="harmonic", duration=0.7)
    bare, linkage = replace(STROKES, loads=(), tolerances=SMOOTH.tolerances, friction=RUBBING), Linkage(0.05, 0.2, 0.03)
    heavy = replace(bare, counterweight=Counterweight(mass=0.0, radius=0.0, inertia=0.4))
    spring = CrankTorque(crank_stiffness=0.4 * (math.pi / 0.7) ** 2, free_angle=0.5 * (0.4 + 1.9))
    share = np.linspace(0.0, 1.0, 33)
    plain, sprung = (swing_curves(each, linkage, swing, share) for each in (bare, loaded(heavy, spring)))
    assert np.abs(plain.drive - sprung.drive).max() <= 1e-12 * np.abs(plain.drive).max()


def test_the_mean_torque_moves_with_a_torque_that_varies_by_minus_itself() -> None:
    own = loaded(SMOOTH, CrankTorque(torque=3.0, resistance=2.0))
    at = len(SMOOTH.loads)
    paths = [("torque", -8.0), ("resistance", 0.5)]
    varying = tuple(
        Varying(name=name, sets=((f"loads.{at}.{name}", 1.0),), lower=low, upper=9.0) for name, low in paths
    )
    designs = np.hstack([DESIGNS, np.tile([3.0, 2.0], (3, 1))])
    found = torque_averages(replace(own, varying=varying), designs, gradients=True)
    assert found.mean_gradients is not None
    assert found.mean == pytest.approx(torque_averages(own, DESIGNS).mean, rel=1e-13)
    assert found.mean_gradients[:, 3] == pytest.approx(-1.0, rel=1e-12)
    assert found.mean_gradients[:, 4] == pytest.approx(1.0, rel=1e-12)  # counter-clockwise


def test_work_over_a_turn() -> None:
    """A table of no mean torque takes exactly zero energy; a resistance takes 2 pi of it."""
    still = replace(STROKES, acceleration=0.0, loads=())
    even = CrankTorqueTable(angles=(0.0, 0.5 * math.pi, math.pi, 1.5 * math.pi), forces=(0.0, 7.0, 0.0, -7.0))
    assert not may_do_work_over_a_turn(loaded(still, even))
    assert torque_averages(loaded(still, even), DESIGNS).mean.tolist() == [0.0, 0.0, 0.0]
    for load in (TABLE, CrankTorque(torque=1.0), CrankTorque(resistance=1.0)):
        assert may_do_work_over_a_turn(loaded(still, load))
    own = loaded(still, CrankTorque(resistance=4.0), TABLE)
    found = cycle_energies(replace(own, friction=RUBBING), Linkage(*DESIGNS[0]))
    table = TABLE.turn_work_by_key(moving=True)[CrankTorqueTable]
    assert found.useful == pytest.approx(4.0 * TURN + math.fsum(table), rel=1e-12)  # it turns clockwise
    assert found.input == pytest.approx(found.useful + found.heat, rel=1e-12)


def test_a_table_of_two_turns_that_repeats_is_that_of_one() -> None:
    twice = CrankTorqueTable(
        angles=(*TABLE.angles, *(angle + TURN for angle in TABLE.angles)), forces=2 * TABLE.forces, cycle="720 deg"
    )
    one, two = loaded(SMOOTH, TABLE), loaded(SMOOTH, twice)
    angles = np.linspace(0.0, 2.0 * TURN, 97)
    assert cycle(two, Linkage(*DESIGNS[0]), angles).torque == pytest.approx(
        cycle(one, Linkage(*DESIGNS[0]), angles).torque, rel=1e-11
    )
    first, second = (find_peaks(machine, Signal.TORQUE, DESIGNS).values[:, 0] for machine in (one, two))
    assert first == pytest.approx(second, rel=1e-12)


def test_forward_dynamics_takes_them() -> None:
    """A crank alone speeds up by the sum of torques over its inertia; the energies of a linkage balance."""
    alone = Mechanism(
        speed=1.0, crank=RigidLink(mass=0.0, inertia=0.5), loads=(CrankTorque(torque=4.0, resistance=1.5),)
    )
    motor = Drive(motor=ConstantTorque(torque=10.0), flywheel=0.25)
    found = simulate(alone, Linkage(0.05, 0.2, 0.03), motor, duration=1.0)
    assert found.speed[-1] == pytest.approx((10.0 + 4.0 - 1.5) / 0.75, rel=1e-9)
    assert found.load_work[-1] == pytest.approx(-2.5 * found.angle[-1], rel=1e-8)
    whole = loaded(replace(STROKES, acceleration=0.0), CrankTorque(resistance=3.0), TABLE)
    run = simulate(
        whole, Linkage(0.05, 0.2, 0.03), Drive(motor=ConstantTorque(torque=40.0), flywheel=1.5), duration=1.0
    )
    assert run.energy_balance_error < 1e-8
    assert abs(run.turns) > 1.0


JOB: dict[str, Any] = {
    "name": "press",
    "mechanism": {"speed": "60 rpm", "slider": {"mass": "2 kg"}},
    "variables": {"crank": "50 mm", "rod": "200 mm", "offset": "30 mm"},
    "objectives": {"peak_torque": "minimise"},
}


def test_job_tables_say_them() -> None:
    table = {
        "torque_angles": ["0 deg", "90 deg"],
        "torques": ["-20 N m", "0 N m"],
        "measured_from": "outer dead centre",
    }
    tables: list[dict[str, Any]] = [{"crank_torque": "-50 N m"}, {"crank_resistance": "5 N m"}, table]
    loads = parse_job(JOB | {"load": tables}).mechanism.loads
    assert loads[:2] == (CrankTorque(torque=-50.0), CrankTorque(resistance=5.0))
    assert loads[2] == CrankTorqueTable(angles=(0.0, 0.5 * math.pi), forces=(-20.0, 0.0), datum="outer dead centre")


@pytest.mark.parametrize(
    ("load", "words"),
    [
        ({"torque_per_angle": "40 N m/rad", "free_angle": "10 deg"}, "would wind up with every turn"),
        ({"crank_resistance": "-5 N m"}, "must be positive"),
        ({"crank_torque": "5 N"}, "is a force"),
        ({"torque_angles": ["0 deg", "90 deg"], "torques": ["1 N m"]}, "at least 2 entries"),
        ({"torque_angles": ["0 deg", "90 deg", "91 deg"], "torques": ["1 N m", "2 N m"]}, "as many torques as angles"),
        ({"torque_angles": ["0 deg", "0 deg", "360 deg"], "torques": ["1 N m"] * 3}, "got three points there"),
        ({"torque_angles": ["90 deg", "80 deg"], "torques": ["1 N m", "2 N m"]}, "must increase"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(load: dict[str, Any], words: str) -> None:
    with pytest.raises(JobError, match=words):
        parse_job(JOB | {"load": [load]})


def test_analyses_of_a_turn_and_of_clearance_refuse_what_they_cannot_take() -> None:
    sprung = loaded(SMOOTH, CrankTorque(crank_stiffness=5.0))
    for call in (
        lambda: cycle(sprung, Linkage(*DESIGNS[0]), [0.0]),
        lambda: find_peaks(sprung, Signal.TORQUE, DESIGNS),
    ):
        with pytest.raises(InputError, match="would wind up with every turn"):
            call()
    machine = replace(loaded(SMOOTH, CrankTorque(torque=5.0)), acceleration=0.0)
    clearance = Clearance(joint="crank pin", radius=1e-4, journal_radius=0.01)
    with pytest.raises(InputError, match="accepts only loads on the slider"):
        simulate_clearance(machine, Linkage(*DESIGNS[0]), clearance)
    for bad in (math.nan, math.inf, -1.0):
        with pytest.raises(InputError, match="resistance"):
            CrankTorque(resistance=bad)
