"""Refusals of a loose joint: values that make no sense, and linkages that cannot be simulated."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from slidercrank.model.clearance.run import simulate
from slidercrank.model.errors import AssemblyError, InputError, SlidercrankError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Clearance, RigidLink
from slidercrank.model.machine.mechanism import Mechanism

BAR = Bar(width=0.03, depth=0.02, density=7800.0)
SIEVE = Mechanism(speed=10.0 * math.pi, crank=BAR, rod=BAR, slider_mass=1.95, gravity=(0.0, -9.81))
LINKAGE = Linkage(0.14, 0.31, -0.06)
PIN = Clearance(joint="crank pin", radius=1e-3, journal_radius=0.01)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"joint": "crank_pin"}, ["joint", "'crank pin'"]),
        ({"law": "hertz"}, ["law", "'flores'"]),
        ({"radius": 0.0}, ["radius", "positive"]),
        ({"radius": -1e-3}, ["radius", "positive"]),
        ({"radius": math.nan}, ["radius", "positive and finite", "nan"]),
        ({"radius": 0.02}, ["less than the radius of the journal", "20 mm", "units"]),
        ({"journal_radius": math.inf}, ["journal_radius", "finite"]),
        ({"restitution": 0.0}, ["restitution", "above 0"]),
        ({"restitution": 1.1}, ["restitution", "at most 1"]),
        ({"restitution": math.nan}, ["restitution", "nan"]),
        ({"friction": -0.1}, ["friction", "zero or more"]),
        ({"poisson": 0.6}, ["poisson", "0.5"]),
        ({"stiffness": 0.0}, ["stiffness", "positive"]),
        ({"slow_impact": 0.0}, ["slow_impact", "positive"]),
        ({"slip_speed": -1.0}, ["slip_speed", "positive"]),
    ],
)
def test_a_clearance_that_makes_no_sense_is_refused(change: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(InputError) as refused:
        replace(PIN, **change)
    for word in words:
        assert word in str(refused.value)


@pytest.mark.parametrize(
    ("machine", "linkage", "options", "words"),
    [
        (replace(SIEVE, speed=0.0), LINKAGE, {}, "needs a crank speed; got none"),
        (replace(SIEVE, acceleration=1.0), LINKAGE, {}, "a crank at constant speed"),
        (replace(SIEVE, rod=RigidLink(mass=0.0)), LINKAGE, {}, "give both a mass"),
        (SIEVE, Linkage(0.14, 0.2012, -0.06), {}, "fold over"),
        (SIEVE, LINKAGE, {"cycles": 3, "discard": 3}, "exceed discard"),
        (SIEVE, LINKAGE, {"tolerance": 1.0}, "tolerance"),
    ],
)
def test_what_cannot_be_simulated_is_refused(
    machine: Mechanism, linkage: Linkage, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        simulate(machine, linkage, PIN, **options)


def test_a_slider_without_mass_behind_a_loose_pin_is_refused() -> None:
    with pytest.raises(InputError, match="slider of 0 kg; give both a mass"):
        simulate(replace(SIEVE, slider_mass=0.0), LINKAGE, replace(PIN, joint="slider pin"))


def test_a_contact_too_soft_to_hold_the_journal_is_an_error() -> None:
    with pytest.raises(SlidercrankError, match=r"stiffness of 1000 N/m\^1.5; stiffen the contact"):
        simulate(SIEVE, LINKAGE, replace(PIN, stiffness=1e3), cycles=1, discard=0)


def test_a_linkage_that_does_not_turn_fully_is_refused() -> None:
    with pytest.raises(AssemblyError, match="full rotation"):
        simulate(SIEVE, Linkage(0.14, 0.18, -0.06), PIN)
