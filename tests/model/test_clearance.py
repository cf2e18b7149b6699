"""The loose joint: contact law against its theory, equations of motion against two other formulations."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from slidercrank.model.clearance import equations
from slidercrank.model.clearance.phases import Integrator, build_system
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Clearance, Joint
from slidercrank.model.machine.mechanism import Mechanism
from tests.model.cases import Array, linkage_of, random_designs, random_machine
from tests.model.loose_joint import accelerations, state_of
from tests.model.virtual_work import load_force, outward_motion, path, slider_load, stroke_ends

JOINTS: tuple[Joint, ...] = ("crank pivot", "crank pin", "slider pin")
BAR = Bar(width=0.03, depth=0.02, density=7800.0)
SIEVE = Mechanism(speed=10.0 * math.pi, crank=BAR, rod=BAR, slider_mass=1.95, gravity=(0.0, -9.81))
LINKAGE = Linkage(0.14, 0.31, -0.06)
PIN = Clearance(joint="crank pin", radius=1e-3, journal_radius=0.01)


def integrator(mechanism: Mechanism, clearance: Clearance, state: Array, tolerance: float = 1e-11) -> Integrator:
    return Integrator(
        *build_system(mechanism, LINKAGE, clearance),
        hysteresis=clearance.hysteresis,
        slow_impact=clearance.slow_impact,
        tolerance=tolerance,
        state=state,
    )


def seen(run: Integrator) -> tuple[Array, Array, Array]:
    """Return times, states and observed quantities of an integration."""
    trace = run.trace
    times, states = np.concatenate(trace.times), np.ascontiguousarray(np.concatenate(trace.states, axis=1))
    rates, outward = np.concatenate(trace.rates), np.concatenate(trace.outward)
    return times, states, equations.reported_quantities(times, states, rates, outward, run.system, run.block, run.loads)


@pytest.mark.parametrize("joint", JOINTS)
def test_equations_of_motion_agree_with_newton_and_euler_of_every_body(joint: Joint) -> None:
    """Random machines, gaps in flight and in contact, with friction; the loads are the independent ones, too."""
    random = np.random.default_rng(41)
    for design in random_designs(40, seed=42, least_margin=0.1):
        machine = replace(random_machine(random), acceleration=0.0)
        linkage = linkage_of(design, machine.branch)
        room = design[1] - design[0] - abs(design[2])
        clearance = Clearance(
            joint=joint,
            radius=float(min(1e-3, 0.1 * room)),
            journal_radius=float(random.uniform(0.005, 0.02)),
            friction=float(random.uniform(0.0, 0.5)),
            stiffness=1e10,
        )
        start = float(random.uniform(0.0, 2.0 * math.pi))
        system, block, loads = build_system(machine, linkage, clearance, start=start)
        way = random.uniform(0.0, 2.0 * math.pi)
        share = random.choice([0.5, 1.0 + 1e-2])
        gap = share * clearance.radius * np.array([math.cos(way), math.sin(way)])
        gap_t = random.uniform(-0.3, 0.3, 2)
        state = state_of(linkage, joint, gap, gap_t, start, machine.speed)
        # The slider's loads once more: where it is and how fast, but the stroke by the crank angle.
        stroke = outward_motion(machine, path(design, np.array([start]), linkage.sign))[2]
        position, velocity = linkage.sign * state.points[2][:1], linkage.sign * state.velocities[2][:1]
        ends = stroke_ends(design)
        load = float(
            linkage.sign * sum(load_force(part, position, velocity, stroke, start, ends) for part in machine.loads)[0]
        )
        damping = 0.7
        y = np.array([*gap, *gap_t, 0.0, 0.0, 0.0])
        got = equations.state_rates(0.0, y, damping, bool(stroke[0]), system, block, loads)
        observed = equations.reported_quantities(
            np.zeros(1), y.reshape(-1, 1), np.array([damping]), stroke, system, block, loads
        )
        x_tt, rod_tt, torque, lost = accelerations(machine, linkage, clearance, state, damping, load)
        phi, phi_t = state.angles[1], state.spins[1]
        l, r, w = float(linkage.rod), float(linkage.crank), machine.speed
        expected = [
            x_tt + l * (rod_tt * math.sin(phi) + phi_t**2 * math.cos(phi)) + r * w * w * math.cos(start),
            -l * (rod_tt * math.cos(phi) - phi_t**2 * math.sin(phi)) + r * w * w * math.sin(start),
        ]
        scale = max(1.0, *np.abs(expected), abs(x_tt))
        np.testing.assert_allclose(got[2:4], expected, rtol=0, atol=1e-9 * scale)
        assert observed[2, 0] == pytest.approx(x_tt, rel=1e-9, abs=1e-9 * scale)
        assert observed[6, 0] == pytest.approx(torque, rel=1e-9, abs=1e-9 * scale)
        assert got[4] == pytest.approx(torque * w, rel=1e-9, abs=1e-9 * scale * abs(w))
        assert got[5] == pytest.approx(load * state.velocities[2][0], rel=1e-9, abs=1e-9)
        assert got[6] == pytest.approx(lost, rel=1e-8, abs=1e-9 * scale)
        assert lost >= 0.0
        assert (lost > 0.0) == (share > 1.0)


def test_loads_are_those_of_the_ideal_linkage_where_the_gap_is_closed() -> None:
    random = np.random.default_rng(43)
    for design in random_designs(20, seed=44, least_margin=0.1):
        machine = replace(random_machine(random), acceleration=0.0)
        linkage = linkage_of(design, machine.branch)
        clearance = replace(PIN, radius=1e-6, journal_radius=1e-5)
        system, block, loads = build_system(machine, linkage, clearance, start=1.1)
        at = path(design, np.array([1.1]), linkage.sign)
        load = linkage.sign * slider_load(machine, design, np.array([1.1]), at)[0]
        stroke = bool(outward_motion(machine, at)[2][0])
        got = equations.state_rates(0.0, np.zeros(7), -1.0, stroke, system, block, loads)
        x_t = at.x_1[0] * machine.speed
        assert got[5] == pytest.approx(load * x_t, rel=1e-11, abs=1e-12 * abs(x_t))


@pytest.mark.parametrize("joint", JOINTS)
def test_the_reaction_of_the_ideal_joint_keeps_the_gap_closed(joint: Joint) -> None:
    """Put into the contact's place, the joint force of the frictionless linkage gives its motion and its torque."""
    random = np.random.default_rng(45)
    for design in random_designs(20, seed=46, least_margin=0.1):
        machine = replace(random_machine(random, loads=False), acceleration=0.0)
        linkage = linkage_of(design, machine.branch)
        start = float(random.uniform(0.0, 2.0 * math.pi))
        ideal = cycle(machine, linkage, start)
        # What acts on the body that carries the gap: on the crank, on the rod's end, on the slider.
        force = {
            "crank pivot": complex(ideal.pivot_x[0], ideal.pivot_y[0]),
            "crank pin": complex(ideal.crank_pin_x[0], ideal.crank_pin_y[0]),
            "slider pin": complex(ideal.slider_pin_x[0], ideal.slider_pin_y[0]),
        }[joint]
        clearance = replace(PIN, joint=joint, radius=1e-6)
        system, _, _ = build_system(machine, linkage, clearance, start=start)
        place = equations.configuration_of(0.0, 0j, 0j, system)
        gap_tt, x_tt, torque = equations.solve_accelerations(place, force, 0.0, 0.0, 0.0, system)
        size = max(1.0, abs(float(ideal.slider_acceleration[0])), float(linkage.crank) * machine.speed**2)
        assert abs(gap_tt) < 1e-9 * size
        assert x_tt == pytest.approx(ideal.slider_acceleration[0], abs=1e-9 * size)
        assert torque == pytest.approx(ideal.torque[0], rel=1e-9, abs=1e-9 * size)


def rebound(hysteresis: float) -> float:
    """Return the ratio of speeds from F = K d^n (1 + h d'/d'_0), whatever K, n and the mass.

    From m v dv/dd = -F: z - ln(1 + z) is the same for z = h before the impact and for z = -h e after it.
    """
    if hysteresis == 0.0:
        return 1.0

    def left(e: float) -> float:
        return -hysteresis * e - math.log1p(-hysteresis * e) - hysteresis + math.log1p(hysteresis)

    top = min(1.0, (1.0 - 1e-15) / hysteresis)
    return float(brentq(left, 1e-9, top, xtol=1e-14))


@pytest.mark.parametrize("law", ["flores", "lankarani-nikravesh"])
@pytest.mark.parametrize("restitution", [0.3, 0.7, 0.9, 1.0])
def test_a_bouncing_journal_rebounds_as_the_law_says(law: Any, restitution: float) -> None:
    """Crank held still, no gravity. The slider pin flies to and fro along the slider line, the rod does not turn.

    With a rod along the slider line and its mass centre on it, the gap opens along x and nothing turns.
    """
    machine = Mechanism(crank=BAR, rod=BAR, slider_mass=1.95)
    linkage = Linkage(0.14, 0.31, 0.0)
    clearance = replace(PIN, joint="slider pin", law=law, restitution=restitution, slow_impact=1e-6)
    system, block, loads = build_system(machine, linkage, clearance)
    run = Integrator(
        system, block, loads, clearance.hysteresis, 1e-6, 1e-11, np.array([0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0])
    )
    run.integrate_until(0.012 / restitution, outward=True)
    speeds = np.array(run.trace.impact_speeds)
    assert len(speeds) >= 2
    assert speeds[0] == pytest.approx(0.5, rel=1e-9)
    np.testing.assert_allclose(speeds[1:] / speeds[:-1], rebound(clearance.hysteresis), rtol=1e-7)
    _, _, out = seen(run)
    assert out[3].min() >= 0.0


def test_slow_impacts_lose_less_as_hunt_and_crossley_found() -> None:
    """Below the slow impact, ten times faster than this one, the damping stays: h is a tenth."""
    machine = Mechanism(crank=BAR, rod=BAR, slider_mass=1.95)
    clearance = replace(PIN, joint="slider pin", restitution=0.5, slow_impact=0.1)
    system, block, loads = build_system(machine, Linkage(0.14, 0.31, 0.0), clearance)
    start = np.array([0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0])
    run = Integrator(system, block, loads, clearance.hysteresis, 0.1, 1e-11, start)
    run.integrate_until(0.5, outward=True)
    assert run.trace.impact_speeds[1] == pytest.approx(0.01 * rebound(0.16), rel=1e-7)


def test_damping_is_that_of_the_two_papers() -> None:
    """Damping for e = 1/2: 8 (1/2) / (5/2) = 1.6. The other law: 3 (3/4) / 4 = 0.5625. None for e = 1."""
    assert replace(PIN, restitution=0.5).hysteresis == pytest.approx(1.6, rel=1e-15)
    assert replace(PIN, restitution=0.5, law="lankarani-nikravesh").hysteresis == 0.5625
    assert (
        replace(PIN, restitution=1.0).hysteresis
        == replace(PIN, restitution=1.0, law="lankarani-nikravesh").hysteresis
        == 0.0
    )


def test_flores_rebounds_nearer_to_the_asked_restitution_than_lankarani_and_nikravesh() -> None:
    for restitution in (0.2, 0.5, 0.8):
        got = {
            law: rebound(replace(PIN, restitution=restitution, law=law).hysteresis)
            for law in ("flores", "lankarani-nikravesh")
        }
        assert abs(got["flores"] - restitution) < abs(got["lankarani-nikravesh"] - restitution)
    for law in ("flores", "lankarani-nikravesh"):
        assert rebound(replace(PIN, restitution=0.99, law=law).hysteresis) == pytest.approx(0.99, abs=5e-3)


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_energy_never_grows_while_the_crank_is_held_still(joint: Joint, friction: float) -> None:
    """Gravity alone moves the rod and the slider; every contact takes energy, friction too."""
    clearance = replace(PIN, joint=joint, friction=friction, restitution=0.6)
    run = integrator(replace(SIEVE, speed=0.0), clearance, np.array([2e-4, 0.0, 0.4, 0.3, 0.0, 0.0, 0.0]), 1e-9)
    run.integrate_until(0.03, outward=True)
    _, states, out = seen(run)
    total = out[7] + out[8] + out[9]
    size = float(np.ptp(out[7]))
    assert len(run.trace.impact_times) >= 3
    assert np.diff(states[6]).min() >= -1e-12 * size
    assert np.diff(total).max() <= 1e-8 * size
    assert total[-1] < total[0] - 0.1 * size
    np.testing.assert_allclose(total - total[0], -states[6], rtol=0, atol=1e-7 * size)
    np.testing.assert_array_equal(states[4], 0.0)


def test_free_flight_keeps_momentum_and_energy() -> None:
    """A loose crank pin, no gravity: rod and slider keep their momentum along the guide and their kinetic energy."""
    machine = replace(SIEVE, gravity=(0.0, 0.0))
    clearance = replace(PIN, radius=5e-3)
    run = integrator(machine, clearance, np.array([0.0, 0.0, 0.2, -0.1, 0.0, 0.0, 0.0]))
    run.integrate_until(0.004, outward=True)
    assert not run.trace.impact_times
    times, states, out = seen(run)
    r, l, e, w = 0.14, 0.31, -0.06, machine.speed
    sine = (e - r * np.sin(w * times) - states[1]) / l
    cosine = np.sqrt(1.0 - sine**2)
    turn = -(states[3] + r * w * np.cos(w * times)) / (l * cosine)
    rod_mass = BAR.mass(l)
    momentum = (rod_mass + 1.95) * out[1] + 0.5 * rod_mass * l * sine * turn
    np.testing.assert_allclose(momentum, momentum[0], rtol=1e-10)
    np.testing.assert_allclose(out[7], out[7][0], rtol=1e-10)


def test_the_contact_never_pulls() -> None:
    """Not even where the surfaces part at many times the speed of the impact."""
    system, block, loads = build_system(SIEVE, LINKAGE, PIN)
    y = np.array([1.01e-3, 0.0, -5.0, 0.0, 0.0, 0.0, 0.0])
    out = equations.reported_quantities(
        np.zeros(1), y.reshape(-1, 1), np.array([100.0]), np.array([True]), system, block, loads
    )
    assert out[3, 0] == 0.0
    assert equations.state_rates(0.0, y, 100.0, True, system, block, loads)[6] > 0.0


def test_stiffness_is_that_of_hertz() -> None:
    """A sphere in a sphere of much larger radius is a sphere on a plane. K = 4/3 E* sqrt(R), 1/E* = 2 (1 - nu^2)/E."""
    clearance = Clearance(joint="crank pin", radius=1e-9, journal_radius=1e-3, elastic_modulus=2e11, poisson=0.25)
    reduced = 1e-3 * (1e-3 + 1e-9) / 1e-9
    modulus = 2e11 / (2.0 * (1.0 - 0.0625))
    assert clearance.contact_stiffness == pytest.approx(4.0 / 3.0 * modulus * math.sqrt(reduced), rel=1e-12)
    assert replace(clearance, stiffness=5e9).contact_stiffness == 5e9
