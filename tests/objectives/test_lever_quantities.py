"""Quantities of a lever moved by a cylinder that turns: against dense curves, differences and given numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.lever import Lever
from slidercrank.model.machine.lever_cylinder import Cylinder
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.swing.swing import Swing
from slidercrank.model.turning_cylinder.cylinder_and_pin_forces import lever_curves
from slidercrank.model.turning_cylinder.lever_of_design import lever_machine, lever_swing
from slidercrank.objectives.registry import FACTS
from slidercrank.objectives.swing_quantity import SwingQuantity
from slidercrank.objectives.tables.evaluate_quantities import evaluate
from slidercrank.objectives.tables.swing_columns import swing_quantities
from tests.case_count import case_count
from tests.model.turning_cylinder.machines import some_machine, some_spring
from tests.objectives.richardson import derivatives

CYLINDER = Cylinder(
    closed_length=0.6,
    stroke=0.5,
    bore=0.08,
    rod=0.04,
    supply_pressure=2e7,
    seal_friction=35.0,
    barrel_mass=9.0,
    piston_rod_mass=4.0,
    length_tolerance=1e-3,
)
ANGLES: dict[str, Any] = {"start": math.radians(-20.0), "end": math.radians(50.0)}
TIPPER = Mechanism(
    crank=RigidLink(mass=80.0, centre=0.7),
    gravity=(0.0, -9.81),
    lever=Lever(frame_angle=math.radians(-60.0), cylinder=Cylinder(bore=0.04, rod=0.022)),
)
Case = tuple[Mechanism, Swing, Array]


def some_case(random: np.random.Generator) -> Case:
    """Return a random lever with all numbers of its cylinder, its swing, and its design (1, 3)."""
    drawn, placed = some_machine(random)
    sizes = drawn.sizes
    mass, centre, across, inertia = random.uniform((1.0, 0.1, -0.3, 0.1), (90.0, 1.0, 0.3, 6.0)).tolist()
    mechanism = Mechanism(
        crank=RigidLink(mass=mass, centre=centre, centre_across=across, inertia=inertia),
        gravity=drawn.gravity,
        tolerances=Tolerances(crank=Tolerance(absolute=1e-3), rod=Tolerance(fraction=1e-3)),
        lever=Lever(
            frame_angle=sizes.frame_angle, pin_angle=sizes.pin_angle, cylinder=CYLINDER, spring=some_spring(random)
        ),
    )
    swing = Swing(start=placed.start, end=placed.end, driver="cylinder", law=placed.law, duration=placed.duration)
    return mechanism, swing, np.array([[sizes.crank, sizes.frame, sizes.offset]])


def values(mechanism: Mechanism, swing: Swing, designs: Array) -> dict[str, Array]:
    """Return all quantities that a lever has."""
    own = swing_quantities(swing)
    return {of.name: of.evaluate(mechanism, designs).values for of in own if not of.undefined_because([mechanism])}


@pytest.mark.parametrize(
    ("design", "expected"),
    [
        ((0.40, 0.60), {"least_cylinder_length": 0.390255, "greatest_cylinder_length": 0.827145}),
        ((0.35, 0.90), {"least_cylinder_length": 0.670740, "greatest_cylinder_length": 1.071435}),
        ((0.35, 0.90), {"peak_cylinder_force": 1710.09, "peak_cylinder_push": 1710.09, "peak_cylinder_pull": 0.0}),
        ((0.35, 0.90), {"lever_work": 608.726, "extension_ratio": 1071.435 / 670.740}),
        ((0.35, 0.90), {"dead_point_margin": math.radians(40.0), "cylinder_travel": 0.400695}),
        ((0.35, 0.90), {"cylinder_pressure": 1710.09 / (math.pi * 4e-4)}),
    ],
)
def test_a_lever_that_lifts_80_kg_has_the_numbers_of_the_law_of_cosines(
    design: tuple[float, float], expected: dict[str, float]
) -> None:
    found = evaluate(TIPPER, [*design, 0.0], list(expected), own=swing_quantities(SLOW), swing=SLOW)
    assert found == pytest.approx(list(expected.values()), rel=5e-6, abs=1e-9)


SLOW = Swing(**ANGLES, driver="cylinder")


@pytest.mark.slow
def test_quantities_are_those_of_dense_curves_in_both_directions() -> None:
    random = np.random.default_rng(31)
    jumps = [third + side for third in (1.0 / 3.0, 2.0 / 3.0) for side in (-1e-9, 0.0, 1e-9)]  # of a trapezoid
    share = np.sort([*np.linspace(0.0, 1.0, 8001), *jumps])
    for _ in range(case_count(12, 30)):
        mechanism, swing, design = some_case(random)
        machine, errors = lever_machine(mechanism, Linkage(*design[0].tolist()), swing)
        placed = lever_swing(mechanism, Linkage(*design[0].tolist()), swing)
        moving = lever_curves(machine, placed, share)
        rest = lever_curves(machine, replace(placed, law="slow", duration=None), np.array([0.0, 1.0]))
        push, length = (np.append(getattr(moving, of), getattr(rest, of)) for of in ("push", "length"))
        found = {name: float(value[0]) for name, value in values(mechanism, swing, design).items()}
        size, areas = float(np.abs(push).max()) + 35.0, CYLINDER.areas
        assert areas is not None
        out, back = max(push.max() + 35.0, 0.0), max(35.0 - push.min(), 0.0)
        assert found["peak_cylinder_push"] == pytest.approx(out, abs=1e-5 * size)
        assert found["peak_cylinder_pull"] == pytest.approx(back, abs=1e-5 * size)
        assert found["peak_cylinder_force"] == pytest.approx(max(out, back), rel=1e-5)
        pressure = max(out / areas[0], back / areas[1])
        assert found["cylinder_pressure"] == pytest.approx(pressure, rel=1e-5)
        assert found["pressure_margin"] == pytest.approx(2e7 / pressure, rel=1e-5)
        margin = CYLINDER.buckling_margin(length, push + 35.0)
        assert margin is not None
        assert found["buckling_margin"] == pytest.approx(float(margin.min()), rel=1e-5)
        for name in ("pin", "pivot", "cylinder_pivot"):
            forces = np.abs(np.append(getattr(moving, name), getattr(rest, name)))
            key = f"lever_{name}_force" if name != "cylinder_pivot" else "cylinder_pivot_force"
            assert found[key] == pytest.approx(float(forces.max()), rel=1e-5)
        ends = length[-2:]
        assert found["least_cylinder_length"] == pytest.approx(float(length.min()), rel=1e-12)
        assert found["cylinder_length_margin"] == pytest.approx(min(ends.min() - 0.6, 1.1 - ends.max()), abs=1e-12)
        assert found["lever_transmission_angle"] == pytest.approx(float(moving.transmission.min()), abs=1e-9)
        error = machine.sizes.worst_lever_angle_error(moving.lever_angle, errors)
        assert found["lever_angle_error"] == pytest.approx(float(error.max()), rel=1e-5)
        work = machine.energy_to_lift(placed.start, placed.end) + 35.0 * found["cylinder_travel"]
        assert found["lever_work"] == pytest.approx(work, rel=1e-9, abs=1e-9 * size)
        if swing.duration is not None:
            speed = float(np.abs(moving.speed).max())
            assert found["peak_cylinder_speed"] == pytest.approx(speed, rel=1e-6)
            assert found["cylinder_flow"] == pytest.approx(areas[0] * speed, rel=1e-6)
            power = (np.abs(moving.push) + 35.0) * np.abs(moving.speed)
            assert found["peak_cylinder_power"] == pytest.approx(float(power.max()), rel=1e-5)


VARYING = (
    Varying(name="frame angle", sets=(("lever.frame_angle", 1.0),), lower=-3.2, upper=3.2),
    Varying(name="bore", sets=(("lever.cylinder.bore", 1.0),), lower=0.05, upper=0.1),
    Varying(name="mass", sets=(("crank.mass", 1.0),), lower=1.0, upper=90.0),
    Varying(name="supply", sets=(("lever.cylinder.supply_pressure", 1.0),), lower=1e6, upper=4e7),
    Varying(name="spring force", sets=(("lever.spring.force", 1.0),), lower=-900.0, upper=900.0),
    Varying(name="spring pin", sets=(("lever.spring.lever", 1.0),), lower=0.1, upper=0.5),
    Varying(name="start", sets=(("start.angle", 1.0),), lower=-20.0, upper=20.0),
)


def _varied(case: Case) -> Case:
    """Return a case whose design has further numbers, at the values of the machine."""
    mechanism, swing, design = case
    assert mechanism.lever is not None
    assert isinstance(mechanism.crank, RigidLink)
    spring = mechanism.lever.spring
    assert spring is not None
    numbers = [mechanism.lever.frame_angle, 0.08, mechanism.crank.mass, 2e7, spring.force, spring.lever, swing.start]
    return replace(mechanism, varying=VARYING), swing, np.array([[*design[0], *numbers]])


@pytest.mark.slow
def test_gradients_are_those_of_extrapolated_differences() -> None:
    """Also by numbers of the cylinder, the mass of the lever, and the start of the swing."""
    random, misses, compared = np.random.default_rng(32), [], 0
    for index in range(case_count(4, 8)):
        mechanism, swing, design = some_case(random) if index % 2 else _varied(some_case(random))
        step = 1e-3 * np.maximum(np.abs(design), 0.05)
        for of in swing_quantities(swing):
            if of.undefined_because([mechanism]):
                continue
            found = of.evaluate(mechanism, design, gradients=True)
            assert found.gradients is not None
            if not found.values[0] or not np.isfinite(found.values[0]):  # it never pulls, or never pushes
                continue

            def function(displaced: Array, _: object, of: SwingQuantity = of, case: Mechanism = mechanism) -> Array:
                return of.evaluate(case, displaced).values

            expected, estimate = derivatives(function, design, step)
            size = np.abs(expected).max() + 1e-9
            if estimate.max() > 1e-8 * size:  # a kink within the steps
                continue
            compared += 1
            misses.append((float(np.abs(found.gradients - expected).max() / size), of.name, swing.law))
    assert compared > case_count(30, 70)
    assert max(misses)[0] < 1e-7, max(misses)


def test_numbers_that_vary_change_nothing_but_the_count_of_derivatives() -> None:
    random = np.random.default_rng(33)
    for _ in range(6):
        case = some_case(random)
        plain, varied = values(*case), values(*_varied(case))
        assert plain.keys() == varied.keys()
        for name, value in plain.items():
            assert varied[name] == pytest.approx(value, rel=1e-12), name


def test_pieces_hold_the_quantity_and_its_gradient() -> None:
    random = np.random.default_rng(34)
    for _ in range(12):
        mechanism, swing, design = some_case(random)
        for of in swing_quantities(swing):
            if of.undefined_because([mechanism]):
                continue
            found, pieces = of.evaluate(mechanism, design, gradients=True), of.pieces(mechanism, design)
            best = int((np.argmin if pieces.least else np.argmax)(pieces.values[0]))
            assert pieces.values[0, best] == pytest.approx(found.values[0], rel=1e-12), of.name
            assert found.gradients is not None
            assert pieces.gradients[0, best] == pytest.approx(found.gradients[0], rel=1e-7, abs=1e-7), of.name


def test_a_lever_that_cannot_swing_has_no_value() -> None:
    swinging, dead, short = [0.35, 0.9, 0.0], [0.35, 0.9, 0.0], [0.35, 0.9, 0.8]
    machine = replace(TIPPER, lever=Lever(frame_angle=math.radians(10.0), cylinder=Cylinder()))
    for of in swing_quantities(SLOW):
        if of.undefined_because([TIPPER]):
            continue
        found = of.evaluate(TIPPER, np.array([swinging, short, [np.nan, 0.9, 0.0]])).values
        assert not np.isnan(found[0]), of.name
        assert np.isnan(found[1:]).all(), of.name
        if not of.undefined_because([machine]):
            assert np.isnan(of.evaluate(machine, np.array([dead])).values).all(), of.name
    assert len({of.place for of in FACTS.values() if of.table == "motion"}) == sum(
        of.table == "motion" for of in FACTS.values()
    )


def _evaluated(machine: Mechanism, name: str, swing: Swing | None) -> Callable[[], object]:
    own = () if swing is None else swing_quantities(swing)
    return lambda: evaluate(machine, [0.35, 0.9, 0.0], [name], own=own, swing=swing)


@pytest.mark.parametrize(
    ("ask", "part"),
    [
        (_evaluated(TIPPER, "stroke", None), "a lever needs a swing that its cylinder drives, or the full turn"),
        (_evaluated(TIPPER, "stroke", SLOW), "stroke needs a crank that rotates fully; .* use a quantity of a swing"),
        (_evaluated(TIPPER, "swing_angle", SLOW), "swing_angle: it needs a crank with rod and slider; got a lever"),
        (
            _evaluated(TIPPER, "cylinder_flow", SLOW),
            "it needs a swing with a duration; got a slow one; give .motion. a law",
        ),
        (_evaluated(TIPPER, "pressure_margin", SLOW), "it needs the supply pressure of the cylinder; got none"),
        (_evaluated(TIPPER, "lever_angle_error", SLOW), "it needs tolerances; got none; for example, add"),
        (
            _evaluated(Mechanism(), "lever_work", Swing(**ANGLES, driver="slider")),
            "lever_work: it needs a lever moved by a cylinder that turns; got a slider-crank; set",
        ),
        (_evaluated(Mechanism(), "lever_work", None), "needs a lever that swings; this crank rotates fully"),
        (_evaluated(Mechanism(), "lever_work", SLOW), "a cylinder drives a lever; got one with a slider-crank"),
        (_evaluated(replace(TIPPER, speed=3.0), "lever_work", SLOW), "mechanism.speed: is for a crank that rotates"),
        (lambda: replace(TIPPER, acceleration=3.0), "rod nor slider; got mechanism.acceleration; leave it out"),
        (
            lambda: replace(TIPPER, loads=(StrokeForce(outward=1.0, inward=1.0),), slider_mass=2.0),
            r"got mechanism.slider, \[\[load\]\]; leave it out",
        ),
        (lambda: replace(SLOW, end=3.0), "must swing its lever less than 180 deg"),
        (
            lambda: replace(SLOW, actuator_tolerance=1e-3),
            "a named law; got a tolerance of the actuator; give from",
        ),
    ],
)
def test_what_a_lever_does_not_have_is_refused_in_one_sentence(ask: Callable[[], object], part: str) -> None:
    with pytest.raises(InputError, match=part):
        ask()


def test_a_dead_length_alone_leaves_what_the_least_length_exceeds_it_and_the_travel() -> None:
    """Its margin is that of a closed cylinder whose stroke is the travel, with the derivatives of differences."""
    assert TIPPER.lever is not None
    machine = replace(TIPPER, lever=replace(TIPPER.lever, cylinder=Cylinder(dead_length=0.22, bore=0.04)))
    (margin,) = (of for of in swing_quantities(SLOW) if of.name == "cylinder_length_margin")
    assert margin.undefined_because([machine]) is None
    design = np.array([[0.35, 0.9, 0.01]])
    least, travel = (values(machine, SLOW, design)[name] for name in ("least_cylinder_length", "cylinder_travel"))
    found = margin.evaluate(machine, design, gradients=True)
    assert found.values == pytest.approx(least - travel - 0.22, rel=1e-12)
    assert found.gradients is not None
    expected, _ = derivatives(lambda moved, _: margin.evaluate(machine, moved).values, design, np.full((1, 3), 1e-3))
    assert found.gradients == pytest.approx(expected, abs=1e-8)
