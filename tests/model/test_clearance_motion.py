"""The sieve of the published case with 1 mm of clearance at the crank pin, and other properties of runs."""

from __future__ import annotations

import math
from dataclasses import fields, replace

import numpy as np
import pytest

from slidercrank.model.clearance.run import ClearanceProgress, ClearanceRun, simulate
from slidercrank.model.clearance.statistics import Estimate, clearance_statistics
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Clearance
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism

RPM = 2.0 * math.pi / 60.0
BAR = Bar(width=0.03, depth=0.02, density=7800.0)
LINKAGE = Linkage(0.14, 0.31, -0.06)
PIN = Clearance(joint="crank pin", radius=1e-3, journal_radius=0.01)
SOFT = replace(PIN, stiffness=1e8)
"""A contact of rubber: its vibrations are slow, so that long runs are quick."""


def sieve(rpm: float) -> Mechanism:
    return Mechanism(speed=rpm * RPM, crank=BAR, rod=BAR, slider_mass=1.95, gravity=(0.0, -9.81))


@pytest.fixture(scope="module")
def fast() -> ClearanceRun:
    return simulate(sieve(400.0), LINKAGE, PIN, cycles=8, discard=2, tolerance=1e-6)


def test_one_millimetre_hardly_moves_the_slider_but_shakes_it_the_more_the_faster_the_crank(fast: ClearanceRun) -> None:
    """ME748, "Offset-Slider Crank Mechanism", section 2.3: 1 mm at joint B, 30, 300 and 400 rpm.

    Displacement "remains the same"; the spikes of the acceleration grow. They also stand out from the ideal motion.
    """
    runs = [
        simulate(sieve(30.0), LINKAGE, PIN, cycles=1, discard=0, tolerance=1e-5),
        simulate(sieve(300.0), LINKAGE, PIN, cycles=2, discard=1, tolerance=1e-6),
        fast,
    ]
    found = [clearance_statistics(run) for run in runs]
    shares = [summary.displacement_deviation.value for summary in found]
    peaks = [summary.peak_acceleration.value for summary in found]
    # The gap moves the slider by 1 / cos(phi) of itself at most, the penetration (below 0.1 mm) added.
    assert all(0.5e-3 / 0.287 < share < 1.1e-3 / math.cos(math.asin(0.2 / 0.31)) / 0.2869 for share in shares)
    assert max(shares) < 0.01
    assert peaks[0] < 0.5 * peaks[1] < peaks[1] < peaks[2]
    assert all(summary.acceleration_ratio.value > 3.0 for summary in found)
    assert all(summary.impacts.value >= 1.0 for summary in found)


@pytest.mark.slow
def test_halving_the_tolerance_changes_the_statistics_by_less_than_their_uncertainty(fast: ClearanceRun) -> None:
    """The motion is chaotic: the two runs are two samples, whose means differ as their confidence intervals allow.

    Another processor rounds otherwise and draws other samples. So each difference must lie within both intervals taken
    together, and all but one in ten within the narrower promise of one interval, see `Estimate`.
    """
    finer = clearance_statistics(simulate(sieve(400.0), LINKAGE, PIN, cycles=8, discard=2, tolerance=5e-7))
    coarser = clearance_statistics(fast)
    within = []
    for item in fields(coarser):
        one, other = getattr(coarser, item.name), getattr(finer, item.name)
        if isinstance(one, Estimate) and item.name != "load_work":  # there are no loads
            assert one.uncertainty is not None
            assert other.uncertainty is not None
            assert abs(one.value - other.value) < one.uncertainty + other.uncertainty, item.name
            within.append(abs(one.value - other.value) < one.uncertainty)
    assert len(within) == 11
    assert sum(within) >= 10
    # Which says something only if they are known to better than a factor of two.
    for name in ("peak_acceleration", "displacement_deviation", "velocity_deviation", "contact_share"):
        estimate = getattr(coarser, name)
        assert estimate.uncertainty < 0.5 * estimate.value


def test_the_energy_balance_closes_over_every_turn(fast: ClearanceRun) -> None:
    summary = clearance_statistics(fast)
    assert summary.energy_residual < 1e-3 * summary.dissipated.value
    assert np.diff(fast.dissipated).min() >= -1e-8 * fast.dissipated[-1]
    gained = summary.input_work.value + summary.load_work.value - summary.dissipated.value
    assert summary.stored.value == pytest.approx(gained, abs=summary.energy_residual)
    finer = simulate(sieve(400.0), LINKAGE, SOFT, cycles=1, discard=0, tolerance=1e-9)
    assert np.abs(finer.energy_residual).max() < 1e-6 * finer.dissipated[-1]


def test_the_motion_tends_to_the_ideal_one_as_the_clearance_closes() -> None:
    """First order in position, because the gap itself is. Order one half in velocity, v^2 = 2 a c across the gap."""
    gaps = np.array([1e-3, 1e-4, 1e-5])
    position, velocity = [], []
    for gap in gaps:
        # The stiffness lets the penetration shrink as the gap does.
        clearance = replace(PIN, radius=float(gap), restitution=0.5, stiffness=1e9 * (1e-3 / gap) ** 1.5)
        run = simulate(sieve(300.0), LINKAGE, clearance, cycles=1, discard=0, tolerance=1e-5)
        position.append(np.abs(run.slider_position - run.ideal_position).max())
        velocity.append(np.abs(run.slider_velocity - run.ideal_velocity).max())
    order = np.diff(np.log(position)) / np.diff(np.log(gaps))
    np.testing.assert_allclose(order, 1.0, atol=0.05)
    order = np.diff(np.log(velocity)) / np.diff(np.log(gaps))
    np.testing.assert_allclose(order, 0.5, atol=0.05)


@pytest.mark.parametrize("joint", ["crank pivot", "slider pin"])
def test_the_other_pins_can_be_loose_too(joint: str) -> None:
    """With loads and friction, clockwise and crossed: the journal stays in its bearing, and the energies balance."""
    machine = replace(
        sieve(-200.0), loads=(StrokeForce(outward=-50.0, inward=20.0), Viscous(coefficient=10.0)), branch="crossed"
    )
    clearance = replace(SOFT, joint=joint, friction=0.1)  # type: ignore[arg-type]
    run = simulate(machine, replace(LINKAGE, branch="crossed"), clearance, cycles=2, discard=1, tolerance=1e-8)
    depth = np.hypot(run.journal_x, run.journal_y) - 1e-3
    np.testing.assert_allclose(run.penetration, depth, rtol=0, atol=1e-15)
    assert depth.max() < 1e-3
    assert np.all(depth[run.in_contact] > -1e-6)
    assert np.all(run.contact_force[~run.in_contact] == 0.0)
    assert np.all(np.abs(run.friction_force) <= 0.1 * run.contact_force * (1.0 + 1e-12))
    assert np.abs(run.friction_force).max() > 1.0
    assert np.abs(run.energy_residual).max() < 1e-5 * run.dissipated[-1]
    share = np.abs(run.slider_position - run.ideal_position).max() / float(LINKAGE.stroke)
    assert 1e-4 < share < 0.02


def test_a_joint_that_is_always_pressed_carries_the_force_of_the_ideal_joint() -> None:
    """A strong steady pull, damped: the journal lies still against its bearing, which carries the load."""
    from slidercrank.model.cycle.cycle import cycle

    machine = replace(sieve(100.0), loads=(StrokeForce(outward=800.0, inward=800.0), Viscous(coefficient=200.0)))
    clearance = replace(SOFT, radius=2e-4, restitution=0.1, slow_impact=1e-3)
    run = simulate(machine, LINKAGE, clearance, cycles=1, discard=0, tolerance=1e-6)
    settled = run.times > 0.3 * run.turn_time
    assert run.in_contact[settled].all()
    ideal = cycle(machine, LINKAGE, np.mod(run.crank_angle[settled], 2.0 * math.pi))
    force = np.hypot(ideal.crank_pin_x, ideal.crank_pin_y)
    np.testing.assert_allclose(run.contact_force[settled], force, rtol=0.05)


def test_the_same_run_gives_the_same_motion() -> None:
    first, second = (simulate(sieve(300.0), LINKAGE, SOFT, cycles=1, discard=0) for _ in range(2))
    np.testing.assert_array_equal(first.slider_acceleration, second.slider_acceleration)


def test_a_run_tells_its_progress_and_can_be_cancelled() -> None:
    told: list[ClearanceProgress] = []
    run = simulate(
        sieve(300.0), LINKAGE, SOFT, cycles=5, discard=1, progress=told.append, cancelled=lambda: len(told) == 2
    )
    assert [(entry.cycle, entry.cycles) for entry in told] == [(1, 5), (2, 5)]
    assert told[1].impacts == np.count_nonzero(run.impact_times <= 2.0 * run.turn_time) > 0
    assert (run.status, run.cycles) == ("cancelled", 2)
    assert run.times[-1] == pytest.approx(2.0 * run.turn_time, rel=1e-12)
    summary = clearance_statistics(run)
    assert summary.turns == 1
    assert summary.peak_acceleration.uncertainty is None


def test_a_run_that_is_cancelled_within_the_first_turn_keeps_what_it_has() -> None:
    asked = iter([False, True])
    run = simulate(sieve(300.0), LINKAGE, SOFT, cycles=3, discard=0, cancelled=lambda: next(asked))
    assert (run.status, run.cycles) == ("cancelled", 0)
    assert 0.0 < run.times[-1] < run.turn_time
    with pytest.raises(InputError, match="complete turn"):
        clearance_statistics(run)


def test_the_uncertainty_is_the_confidence_interval_of_the_mean() -> None:
    """Student's t for 3 degrees of freedom at 99 % is 5.841 (any table)."""
    estimate = Estimate.from_turns(np.array([1.0, 2.0, 3.0, 6.0]))
    assert estimate.value == 3.0
    assert estimate.uncertainty == pytest.approx(5.841 * math.sqrt(14.0 / 3.0) / 2.0, rel=1e-4)
