"""Section sizing: against hand calculation, against another solver on other formulas, and the bounds against beams."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import minimize

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Friction
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Branch, Material, Mechanism
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.optimise.problem.tolerance_costs import SectionLimits
from slidercrank.optimise.sizing.limit_states import joint_load_terms, rod_loads
from slidercrank.optimise.sizing.section_loads import greatest_rod_accelerations, joint_loads
from slidercrank.optimise.sizing.sections import Sections, size_sections

STEEL = Material(
    density=7850.0,
    elasticity=207e9,
    yield_strength=350e6,
    ultimate_strength=520e6,
    endurance=150e6,
    bearing_pressure=20e6,
)
LIMITS = SectionLimits(crank_pivot=0.012, crank_pin=0.010, slider_pin=0.008)
LINKAGE = Linkage(0.05, 0.2, 0.03)
MACHINE = Mechanism(
    speed=30.0, slider_mass=2.0, gravity=(0.0, -9.81), loads=(StrokeForce(outward=-600.0, inward=100.0),)
)


def random_task(seed: int) -> tuple[Mechanism, Linkage, Material, SectionLimits]:
    """Return a machine from slow and heavily loaded to fast, one in which the rod's own mass counts."""
    random = np.random.default_rng([seed, 11])
    crank = random.uniform(0.03, 0.1)
    offset = random.uniform(-0.5, 0.5) * crank
    mechanism = Mechanism(
        speed=random.uniform(5.0, 150.0) * random.choice([-1.0, 1.0]),
        acceleration=random.uniform(-50.0, 50.0),
        slider_mass=random.uniform(0.2, 3.0),
        gravity=(random.uniform(-9.0, 9.0), -5.0),
        loads=(StrokeForce(outward=random.uniform(-3000.0, 0.0), inward=random.uniform(-500.0, 500.0)),),
        branch="open" if random.random() < 0.5 else "crossed",
    )
    limits = SectionLimits(
        crank_pivot=random.uniform(0.01, 0.02),
        crank_pin=random.uniform(0.006, 0.015),
        slider_pin=random.uniform(0.006, 0.012),
        criterion="goodman" if random.random() < 0.5 else "soderberg",
        eye_concentration=random.uniform(1.0, 3.0),
    )
    material = replace(STEEL, endurance=random.uniform(40e6, 200e6), bearing_pressure=random.uniform(15e6, 120e6))
    rod = (crank + abs(offset)) * random.uniform(2.0, 6.0)
    return mechanism, Linkage(crank, rod, offset, mechanism.branch), material, limits


known_whip = cache(greatest_rod_accelerations)  # no section counts in it
sized = cache(size_sections)


def demands(
    x: np.ndarray, mechanism: Mechanism, linkage: Linkage, material: Material, limits: SectionLimits
) -> np.ndarray:
    """Return margins that must be zero or more, in plain variables: millimetres, stresses over permitted ones.

    The same limit states written from the textbook's formulas, the loads taken from the dynamics of exactly these bars.
    """
    w, d, v, e = 1e-3 * x
    bars = [Bar(width=w, depth=d, density=material.density), Bar(width=v, depth=e, density=material.density)]
    joints = joint_loads(replace(mechanism, crank=bars[0], rod=bars[1]), linkage)
    whip = known_whip(mechanism, linkage)
    g, r, l = math.hypot(*mechanism.gravity), float(linkage.crank), float(linkage.rod)
    mean = material.ultimate_strength if limits.criterion == "goodman" else material.yield_strength
    found = []
    for part, width, depth, load, held in (
        ("crank", w, d, joints.crank, 2.0 * r),
        ("rod", v, e, joints.rod, l),
    ):
        line = material.density * width * depth  # mass per length
        disc = material.density * depth * math.pi * width**2 / 8.0  # half a disc
        lever, gyration = (
            material.density * depth * width**3 / 12.0,
            material.density * depth * math.pi * width**4 / 128.0,
        )
        if part == "rod":
            own = line * l**2 * whip.spinning / 8.0 + disc * whip.axial
            bend = line * whip.moment + lever * whip.lateral + gyration * whip.turning
            bend_a, bend_m, bend_peak = bend, 0.0, bend
            pins = [(joints.crank_pin, limits.crank_pin), (joints.slider_pin, limits.slider_pin)]
        else:
            static = line * r**2 / 2.0 + disc * r + lever
            polar = line * r**3 / 3.0 + disc * r**2 + 2.0 * r * lever + gyration
            own = mechanism.speed**2 * static + g * (line * r + disc)
            bend = g * static + abs(mechanism.acceleration) * polar
            bend_a, bend_m = joints.bending.amplitude + bend, joints.bending.mean
            bend_peak = joints.bending.greatest_magnitude + bend
            pins = [(joints.crank_pivot, limits.crank_pivot), (joints.crank_pin, limits.crank_pin)]
        area, modulus = width * depth, depth * width**2 / 6.0
        squash = max(0.0, -load.least) + own
        euler = [math.pi**2 * material.elasticity * i / held**2 for i in (depth * width**3 / 12, width * depth**3 / 12)]
        ratio = limits.static_safety * squash / euler[0]
        swell = 4.0 / math.pi * ratio / (1.0 - ratio) * bend_peak
        stress = (load.greatest_magnitude + own) / area + (bend_peak + swell) / modulus
        amplitude = (load.amplitude + own) / area + (bend_a + swell) / modulus
        middle = load.mean / area + bend_m / modulus
        found += [
            1.0 - limits.static_safety * stress / material.yield_strength,
            1.0 - limits.fatigue_safety * (amplitude / material.endurance + middle / mean),
            *(1.0 - limits.buckling_safety * squash / each for each in euler),
        ]
        for force, diameter in pins:
            net = (width - diameter) * depth
            raised = limits.eye_concentration
            found.append((net - limits.static_safety * raised * force / material.yield_strength) / area)
            found.append(1.0 - force / (diameter * depth * material.bearing_pressure))
            tired = ((load.amplitude + own) / material.endurance + load.mean / mean) * raised
            found.append((net - limits.fatigue_safety * tired) / area)
        if part == "crank":  # the eye of the pivot: area and second moment without the hole
            hole = limits.crank_pivot
            net, second = (width - hole) * depth, depth * (width**3 - hole**3) / 12.0
            for pulled, bent, y in ((raised, min(raised, 2.0), hole / 2.0), (1.0, 1.0, width / 2.0)):
                stress = pulled * (load.greatest_magnitude + own) / net + bent * (bend_peak + swell) * y / second
                amplitude = pulled * (load.amplitude + own) / net + bent * (bend_a + swell) * y / second
                middle = pulled * load.mean / net + bent * bend_m * y / second
                used = limits.static_safety * stress / material.yield_strength
                tired = limits.fatigue_safety * (amplitude / material.endurance + middle / mean)
                share = net * second / (area * modulus * width / 2.0)  # positive, and finite for every width
                found += [(1.0 - used) * share, (1.0 - tired) * share]
    return np.array(found)


def test_slsqp_in_plain_variables_finds_the_same_mass() -> None:
    """To 1e-6 from a start half as large again; SLSQP sees the loads of its own sections, not monomials."""
    task = random_task(0)
    _, linkage, material, limits = task
    found = size_sections(*task)
    assert found.is_converged

    def relative_mass(x: Any) -> Any:
        w, d, v, e = 1e-3 * x
        bars = [Bar(width=w, depth=d, density=material.density), Bar(width=v, depth=e, density=material.density)]
        return (bars[0].mass(float(linkage.crank)) + bars[1].mass(float(linkage.rod))) / found.mass

    mine = 1e3 * np.array([found.crank.width, found.crank.depth, found.rod.width, found.rod.depth])
    assert demands(mine, *task).min() >= -1e-6
    bounds = [(1e3 * ends[0], 1e3 * ends[1]) for ends in (limits.width, limits.depth) * 2]
    options: Any = {"ftol": 1e-12, "maxiter": 200, "eps": 1e-6}
    held: Any = {"type": "ineq", "fun": lambda x: demands(x, *task)}
    other = minimize(relative_mass, 1.5 * mine, method="SLSQP", bounds=bounds, constraints=held, options=options)
    assert demands(other.x, *task).min() >= -1e-8
    assert other.fun == pytest.approx(1.0, abs=1e-6)


def test_pure_tension_gives_force_over_stress() -> None:
    """A slow, light machine that is always pulled. The rod's area is n F / S_y, F the pull along it at its steepest.

    With the depth at its greatest and a pin of next to no diameter nothing else limits it.
    """
    pulling = Mechanism(speed=1e-3, loads=(StrokeForce(outward=100.0, inward=100.0),))
    linkage = Linkage(0.05, 0.2)
    material = replace(STEEL, density=1e-6, endurance=350e6, bearing_pressure=1e20)
    limits = replace(
        LIMITS, crank_pin=1e-12, slider_pin=1e-12, width=(1e-6, 0.5), depth=(1e-3, 0.004), fatigue_safety=1.0
    )
    found = size_sections(pulling, linkage, material, limits)
    force = 100.0 / math.sqrt(1.0 - (0.05 / 0.2) ** 2)
    assert found.rod.depth == pytest.approx(0.004, rel=1e-6)
    assert found.rod.width * found.rod.depth == pytest.approx(2.0 * force / 350e6, rel=1e-6)


def test_bearing_and_net_section_size_a_rod_by_hand() -> None:
    """A rod pulled with F: d = F / (D p) by the bearing. The net section: w = D + n F / (S_y d)."""
    pulling = Mechanism(speed=1e-3, loads=(StrokeForce(outward=5000.0, inward=5000.0),))
    material = replace(STEEL, density=1e-6, endurance=350e6)
    limits = replace(LIMITS, slider_pin=0.01, fatigue_safety=1.0)
    found = size_sections(pulling, Linkage(0.05, 0.2), material, limits)
    force = 5000.0 / math.sqrt(1.0 - (0.05 / 0.2) ** 2)
    depth = force / (0.01 * 20e6)
    assert found.rod.depth == pytest.approx(depth, rel=1e-6)
    assert found.rod.width == pytest.approx(0.01 + 2.0 * force / (350e6 * depth), rel=1e-6)
    assert found.utilisation["rod: bearing at the slider pin"] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("name", ["bearing_pressure", "endurance", "yield_strength"])
def test_sensitivities_predict_the_mass_of_a_better_material(name: str) -> None:
    """One percent of mass per percent of strength, by central difference; the limits of one strength add up.

    The dynamics count: a lighter rod loads pins and crank less. Differences of 0.1 % are good to their square.
    """
    fast = replace(MACHINE, speed=100.0)
    states = {"bearing_pressure": ("bearing",), "endurance": ("fatigue",), "yield_strength": ("net", "bore", "edge")}
    # Fatigue does not decide where the question is of the yield strength.
    steel = replace(STEEL, endurance=0.99 * STEEL.yield_strength) if name == "yield_strength" else STEEL
    found = sized(fast, LINKAGE, steel, LIMITS)
    up, down = (
        size_sections(fast, LINKAGE, replace(steel, **{name: share * getattr(steel, name)}), LIMITS).mass
        for share in (1.001, 0.999)
    )
    change = -math.log(up / down) / math.log(1.001 / 0.999)
    expected = sum(
        rate for state, rate in found.sensitivity.items() if state.partition(": ")[2].startswith(states[name])
    )
    if name == "bearing_pressure":
        assert change == pytest.approx(expected, rel=1e-4)
    else:  # part of these limits does not scale with the strength: the hole of the pin, the mean stress
        assert 0.0 < change < expected


def test_the_bound_of_the_rods_moment_holds_and_is_close() -> None:
    """Against the moment integrated along the bar, round ends included, from the accelerations of its points."""
    mechanism, bar = replace(MACHINE, speed=80.0, acceleration=300.0), Bar(width=0.03, depth=0.01, density=7850.0)
    length, half = float(LINKAGE.rod), 0.5 * bar.width
    x = np.linspace(-half, length + half, 8001)
    beyond = np.maximum(np.maximum(-x, x - length), 0.0)
    line = (
        bar.density * bar.depth * np.where(beyond > 0.0, 2.0 * np.sqrt(np.maximum(half**2 - beyond**2, 0.0)), bar.width)
    )
    worst = 0.0
    for angle in np.linspace(0.0, 2.0 * np.pi, 73):
        ends = [
            LINKAGE.rod_point(angle, along=s, speed=mechanism.speed, acceleration=mechanism.acceleration).acceleration
            - np.array(mechanism.gravity)
            for s in (0.0, length)
        ]
        phi = float(LINKAGE.at(angle).rod_angle)
        across = [float(end @ np.array([-math.sin(phi), math.cos(phi)])) for end in ends]
        load = -line * (across[0] + (across[1] - across[0]) * x / length)
        # Pins at 0 and L hold it: the shear starts at zero at the free end.
        left = -np.trapezoid(load * (length - x), x) / length
        right = -np.trapezoid(load, x) - left
        shear = cumulative_trapezoid(load, x, initial=0) + left * (x >= 0.0) + right * (x >= length)
        worst = max(worst, float(np.abs(cumulative_trapezoid(shear, x, initial=0)).max()))
    joints = dict.fromkeys(("rod", "rod compression", "rod fatigue", "crank pin", "slider pin"), 0.0)
    bound = rod_loads(
        bar.width, bar.depth, length, joints, greatest_rod_accelerations(mechanism, LINKAGE), STEEL, LIMITS
    ).moment
    assert worst <= bound <= 1.1 * worst


def test_the_swelling_of_a_moment_under_compression_is_bounded() -> None:
    """Sec(pi sqrt(u) / 2) of the beam-column with end couples, and the bound that is a posynomial."""
    u = np.linspace(0.0, 0.999, 2000)
    exact = 1.0 / np.cos(0.5 * np.pi * np.sqrt(u))
    bound = 1.0 + 4.0 / np.pi * u / (1.0 - u)
    assert (bound >= exact * (1.0 - 1e-12)).all()
    assert (bound <= 1.02 * exact).all()


def test_sampled_pin_forces_are_within_what_the_peaks_say() -> None:
    """The axial force never exceeds the pin's; without mass in the rod both are the same force."""
    joints = joint_loads(MACHINE, LINKAGE)
    assert joints.rod.greatest_magnitude == pytest.approx(joints.slider_pin, rel=1e-5)
    heavy = joint_loads(replace(MACHINE, rod=Bar(width=0.03, depth=0.02, density=7850.0)), LINKAGE)
    assert heavy.rod.greatest_magnitude <= max(heavy.slider_pin, heavy.crank_pin) * (1.0 + 1e-9)
    torque = find_peaks(MACHINE, Signal.TORQUE, np.array([[0.05, 0.2, 0.03]]), limit=1).values[0, 0]
    assert joints.bending.greatest_magnitude == pytest.approx(
        torque, rel=1e-5
    )  # a massless crank's moment is the drive's torque


def test_tension_is_positive() -> None:
    """A slider pulled outward stretches the rod whatever the angle, on both branches."""
    branches: tuple[Branch, ...] = ("open", "crossed")
    for branch in branches:
        pulled = Mechanism(loads=(StrokeForce(outward=100.0, inward=100.0),), branch=branch)
        joints = joint_loads(pulled, Linkage(0.05, 0.2, 0.0, branch))
        assert joints.rod.least >= 100.0 - 1e-9
    curves = cycle(Mechanism(loads=(StrokeForce(outward=100.0, inward=100.0),)), Linkage(0.05, 0.2), [0.0])
    assert abs(curves.slider_pin_x[0]) == pytest.approx(100.0)


def test_a_rod_too_slender_for_its_compression_gets_what_euler_asks() -> None:
    """Pushed with F without mass, out of the plane. w d^3 = 12 n F l^2 / (pi^2 E) where buckling alone holds."""
    pushed = Mechanism(speed=1e-3, loads=(StrokeForce(outward=-2000.0, inward=-2000.0),))
    material = replace(STEEL, density=1e-6, yield_strength=350e7, ultimate_strength=520e7, endurance=350e7)
    material = replace(material, bearing_pressure=1e20)
    limits = replace(
        LIMITS, width=(0.03, 0.0300001), depth=(1e-3, 0.1), crank_pivot=1e-3, crank_pin=1e-3, slider_pin=1e-3
    )
    found = size_sections(pushed, Linkage(0.05, 1.0), material, limits)
    force = 2000.0 / math.sqrt(1.0 - 0.05**2)
    expected = (12.0 * 3.0 * force / (math.pi**2 * 207e9 * found.rod.width)) ** (1.0 / 3.0)
    assert found.rod.depth == pytest.approx(expected, rel=1e-6)
    assert found.utilisation["rod: buckling out of the plane"] == pytest.approx(1.0, abs=1e-6)


def test_what_no_section_carries_is_refused_with_what_fails() -> None:
    with pytest.raises(
        InputError, match=r"no section within the ranges carries the loads; (rod|crank): .* reaches at best \d"
    ):
        size_sections(replace(MACHINE, speed=3000.0), LINKAGE, STEEL, LIMITS)


def test_wrong_input_is_refused_in_words() -> None:
    with pytest.raises(InputError, match="section sizing only takes joints and guide without friction"):
        size_sections(replace(MACHINE, friction=Friction(guide=0.1)), LINKAGE, STEEL, LIMITS)
    with pytest.raises(InputError, match="one linkage is possible at a time"):
        size_sections(MACHINE, Linkage(np.array([0.05, 0.06]), 0.2), STEEL, LIMITS)
    with pytest.raises(InputError, match="endurance strength <= yield strength <= ultimate strength"):
        replace(STEEL, endurance=400e6)
    with pytest.raises(InputError, match="a material's density must be positive"):
        replace(STEEL, density=0.0)
    with pytest.raises(InputError, match="the width must have 0 < least < greatest"):
        replace(LIMITS, width=(0.02, 0.01))
    with pytest.raises(InputError, match="static_safety must be at least 1"):
        replace(LIMITS, static_safety=0.5)
    with pytest.raises(InputError, match="'goodman' or 'soderberg'; got 'gerber'"):
        replace(LIMITS, criterion="gerber")


def test_sections_know_whether_they_have_settled() -> None:
    found: Sections = size_sections(MACHINE, LINKAGE, STEEL, LIMITS)
    assert found.is_converged
    assert max(found.utilisation.values()) <= 1.0 + 1e-6
    assert found.mass == pytest.approx(found.crank.mass(0.05) + found.rod.mass(0.2), rel=1e-12)
    assert all(found.utilisation[name] >= 1.0 - 1e-5 for name, rate in found.sensitivity.items() if rate > 1e-3)


@pytest.mark.parametrize("seed", [94, 99, 12, 22])
def test_eyes_of_a_few_micrometres_carry_what_they_must(seed: int) -> None:
    machine, linkage, material, limits = random_task(seed)
    random = np.random.default_rng(seed)
    machine = replace(
        machine,
        loads=(),
        speed=machine.speed * 10.0 ** random.uniform(-2.0, -0.5),
        acceleration=0.0,
        slider_mass=10.0 ** random.uniform(-5.0, 0.0),
        gravity=(0.0, 0.0) if random.random() < 0.5 else machine.gravity,
    )
    found = size_sections(machine, linkage, material, limits)
    joints = joint_loads(replace(machine, crank=found.crank, rod=found.rod), linkage)
    terms = joint_load_terms(joints, material, limits)
    width, depth = found.rod.width, found.rod.depth
    own = rod_loads(
        width, depth, float(linkage.rod), terms, greatest_rod_accelerations(machine, linkage), material, limits
    )
    for pin, diameter in (("crank pin", limits.crank_pin), ("slider pin", limits.slider_pin)):
        raised = limits.eye_concentration / ((width - diameter) * depth)
        for name, used in (
            ("net section", limits.static_safety * raised * terms[pin] / material.yield_strength),
            ("fatigue of the eye", limits.fatigue_safety * raised * own.fatigue_axial),
        ):
            assert 0.0 < used <= 1.0 + 1e-6
            assert found.utilisation[f"rod: {name} at the {pin}"] == pytest.approx(used, rel=1e-9)
    assert max(found.utilisation.values()) <= 1.0 + 1e-6
