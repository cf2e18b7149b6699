"""Allowable values: which a design goes beyond, and by how much, compared with what the forces say."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.machine.drive import Drive
from slidercrank.model.machine.mechanism import Material, Mechanism, Strength
from slidercrank.objectives.registry import FACTS
from slidercrank.objectives.tables.evaluate_quantities import violations_of_allowables
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.sections_table import EXAMPLE
from tests.model.cases import random_designs
from tests.model.strength.sections import random_bars

PINS = ("crank_pivot", "crank_pin", "slider_pin")
FORCES = {"crank_pivot": "peak_pivot_force", "crank_pin": "peak_crank_pin_force", "slider_pin": "peak_slider_pin_force"}


def weak(random: np.random.Generator) -> Strength:
    """Return a material of which some of its allowable values are exceeded, and pins."""
    yielding = 10.0 ** random.uniform(5.5, 8.5)
    endurance = yielding * random.uniform(0.2, 0.9)
    material = Material(
        density=7850.0,
        elasticity=2.07e11,
        yield_strength=yielding,
        ultimate_strength=1.5 * yielding,
        endurance=endurance,
        bearing_pressure=10.0 ** random.uniform(4.5, 7.5),
    )
    pivot, crank_pin, slider_pin = random.uniform(2e-3, 1e-2, 3).tolist()
    return Strength(material=material, crank_pivot=pivot, crank_pin=crank_pin, slider_pin=slider_pin)


def test_pins_of_the_examples_bear_an_ordinary_load() -> None:
    """A load of 5 kN exceeds nothing on bars of the examples, with pins of half their width."""
    bar = {"width": "30 mm", "depth": "20 mm", "density": EXAMPLE["material"]["density"]}
    tables = {
        "name": "Pusher",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "4 kg"}, "crank": bar, "rod": bar},
        "load": [{"force": "5 kN", "opposes": "motion"}],
        "sections": EXAMPLE,
        "variables": {"crank": "20 mm", "rod": "150 mm", "offset": "0 mm"},
        "objectives": {"peak_torque": "minimise"},
    }
    found = parse_job(tables).analyse([0.02, 0.15, 0.0])
    assert found["pin_pressure_crank_pin"] > 5e3 / (15e-3 * 20e-3)
    assert found.violated == {}


def test_what_is_violated_follows_from_the_forces_and_the_material() -> None:
    random = np.random.default_rng(41)
    seen: set[str] = set()
    kept: set[str] = set()
    for seed in range(8):
        machine = replace(random_bars(random), strength=weak(random))
        found = sc.analyse(machine, random_designs(1, seed=seed, least_margin=3e-2)[0])
        assert machine.strength is not None
        material, expected = machine.strength.material, {}
        for name in ("static_safety", "fatigue_safety", "buckling_safety"):
            if name in found and found[name] < 1.0:
                expected[name] = 1.0 - found[name]
        depths = {pin: min(machine.crank.depth, machine.rod.depth) for pin in PINS}  # type: ignore[union-attr]
        depths |= {"crank_pivot": machine.crank.depth, "slider_pin": machine.rod.depth}  # type: ignore[union-attr]
        for pin in PINS:
            force, diameter = found[FORCES[pin]], getattr(machine.strength, pin)
            for name, stress, allowed in (
                ("pressure", force / (diameter * depths[pin]), material.bearing_pressure),
                ("shear", 4.0 * force / (math.pi * diameter**2), material.yield_strength / math.sqrt(3.0)),
            ):
                if stress > allowed:
                    expected[f"pin_{name}_{pin}"] = stress - allowed
        assert found.violated == pytest.approx(expected, rel=1e-9)
        seen |= expected.keys()
        kept |= {name for name in found if FACTS[name].allowed_by} - expected.keys()
    assert len(seen) >= 8
    assert len(kept) >= 8


def test_a_value_that_is_allowed_to_rounding_is_not_violated() -> None:
    machine = replace(random_bars(np.random.default_rng(3)), strength=weak(np.random.default_rng(3)))
    assert machine.strength is not None
    allowed = machine.strength.material.bearing_pressure
    name = "pin_pressure_crank_pin"
    for factor, by in ((1.0, 0.0), (1.0 + 1e-9, 0.0), (1.0 + 1e-6, 1e-6 * allowed), (math.inf, math.inf)):
        found = violations_of_allowables(machine, {name: factor * allowed}.get)
        assert found.get(name, np.zeros(1)) == pytest.approx(by, rel=1e-6)


def test_a_machine_without_material_violates_nothing_and_a_quantity_without_allowable_value_has_none() -> None:
    machine = replace(random_bars(np.random.default_rng(3)), strength=None)
    assert sc.analyse(machine, random_designs(1, seed=1, least_margin=3e-2)[0]).violated == {}
    assert {name for name, of in FACTS.items() if of.allowed_by} == {
        *(f"pin_{what}_{pin}" for what in ("pressure", "shear") for pin in PINS),
        *("static_safety", "fatigue_safety", "buckling_safety"),
        *("motor_peak_torque", "motor_rms_torque", "motor_speed"),
    }
    with pytest.raises(NotImplementedError, match="stroke has no allowable value"):
        FACTS["stroke"].allowable_value(machine)


def test_the_good_side_of_safeties_is_high_and_python_says_it() -> None:
    better = sc.quantities()["better"]
    assert (better[["static_safety", "fatigue_safety", "transmission_angle", "rod_to_offset"]] == "high").all()
    assert (better[["peak_torque", "pin_shear_crank_pin", "footprint"]] == "low").all()


def test_what_a_motor_cannot_give_is_violated_and_only_what_its_drive_states() -> None:
    drive = Drive(gear_ratio=4.0, greatest_torque=0.5)
    machine = Mechanism(speed=30.0, slider_mass=2.0, drive=drive)
    found = sc.analyse(machine, [0.05, 0.2, 0.02])
    assert found.violated == {"motor_peak_torque": pytest.approx(found["motor_peak_torque"] - 0.5)}
    assert sc.analyse(replace(machine, drive=replace(drive, greatest_torque=None)), [0.05, 0.2, 0.02]).violated == {}
