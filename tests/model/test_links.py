"""Mass properties: the round-ended bar by integration over its shape, and what is refused."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from slidercrank.model.errors import InputError
from slidercrank.model.machine.design import DESIGN, LOAD_ROWS, Design, derive_design, design_at
from slidercrank.model.machine.links_and_joints import Bar, Counterweight, RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.raw_machine_vector import load_structure, raw_vector
from tests.model.cases import MACHINES, random_designs
from tests.model.virtual_work import body

STEEL = Bar(width=0.03, depth=0.02, density=7800.0)


def by_integration(bar: Bar, length: float) -> tuple[float, float, float]:
    """Return mass and the second moments of mass along and across the bar about its centre, slice by slice."""
    radius, half = 0.5 * bar.width, 0.5 * length

    def height(u: float) -> float:
        beyond = max(0.0, abs(u) - half)
        return 2.0 * math.sqrt(max(0.0, radius**2 - beyond**2))

    def integral(slice_: Any) -> float:
        # In the caps u = half + radius sin(t): smooth there, unlike the slice's height over u.
        middle = quad(slice_, 0.0, half, epsabs=0, epsrel=1e-13)[0]
        cap = quad(
            lambda t: slice_(half + radius * math.sin(t)) * radius * math.cos(t),
            0.0,
            0.5 * math.pi,
            epsabs=0,
            epsrel=1e-13,
        )[0]
        return 2.0 * float(middle + cap) * bar.density * bar.depth

    mass = integral(height)
    along = integral(lambda u: height(u) * u**2)
    across = integral(lambda u: height(u) ** 3 / 12.0)
    return mass, along, across


@pytest.mark.parametrize("length", [0.001, 0.14, 0.31, 2.0])
def test_bar_has_the_mass_and_inertias_of_its_shape(length: float) -> None:
    mass, along, across = by_integration(STEEL, length)
    through = mass * STEEL.depth**2 / 12.0
    # The quadrature is good to 1e-13, the tests of printed figures to 1e-9.
    assert STEEL.mass(length) == pytest.approx(mass, rel=1e-12)
    expected = (along + across, along + through, across + through)
    np.testing.assert_allclose(STEEL.principal_inertias(length), expected, rtol=1e-11)


def derived(machine: Mechanism, designs: Any) -> Design:
    loads = load_structure(machine)
    raw = np.repeat(raw_vector(machine)[:, None], len(designs), axis=1).astype(designs.dtype)
    raw[:3] = designs.T
    block = np.empty((DESIGN + LOAD_ROWS * len(machine.loads), len(designs)), dtype=designs.dtype)
    derive_design(raw, loads.kind, loads.datum, block)
    found: Design = design_at(block, slice(None))
    return found


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_mass_properties_of_a_design_follow_its_lengths(machine: Mechanism) -> None:
    designs = random_designs(50, seed=41)
    d = derived(machine, designs)
    weight = machine.counterweight
    for link, length, got, extra in (
        (machine.crank, designs[:, 0], (d.crank_mass, d.crank_along, d.crank_across, d.crank_inertia), weight),
        (machine.rod, designs[:, 1], (d.rod_mass, d.rod_along * d.l, d.rod_across * d.l, d.rod_inertia), None),
    ):
        alone = body(link, length)
        mass, along, across = alone.mass, alone.mass * alone.along, alone.mass * alone.across
        inertia = alone.inertia + alone.mass * (alone.along**2 + alone.across**2)
        if extra is not None:
            mass = mass + extra.mass
            along = along + extra.mass * extra.radius * math.cos(extra.angle)
            across = across + extra.mass * extra.radius * math.sin(extra.angle)
            inertia = inertia + extra.inertia + extra.mass * extra.radius**2
        for value, expected in zip(got, (mass, along, across, inertia), strict=True):
            # Sums of a handful of products.
            np.testing.assert_allclose(value, np.broadcast_to(expected, value.shape), rtol=1e-14, atol=1e-16)


def test_mass_properties_have_complex_step_derivatives() -> None:
    machine = MACHINES["smooth"]
    designs = random_designs(20, seed=42).astype(complex)
    designs[:, 0] += 1e-30j
    # d/dL of the polar inertia about the pivot: that of the bar's tip line, by central differences.
    slope = derived(machine, designs).crank_inertia.imag / 1e-30
    h = 1e-4
    wide = []
    for sign in (-1.0, 1.0):
        moved = designs.real.copy()
        moved[:, 0] += sign * h
        wide.append(derived(machine, moved).crank_inertia)
    # A cubic: the central difference is off by h^2 times the third derivative / 6, 2 rho d w h^2 / 6.
    np.testing.assert_allclose(slope, (wide[1] - wide[0]) / (2.0 * h), rtol=0, atol=2e-8)


@pytest.mark.parametrize("name", ["width", "depth", "density"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_bar_needs_positive_sizes(name: str, value: float) -> None:
    with pytest.raises(InputError, match=f"the {name} of a bar must be positive and finite; got {value:g}"):
        dataclasses.replace(STEEL, **{name: value})


@pytest.mark.parametrize("name", ["mass", "inertia"])
@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf])
def test_link_needs_mass_and_inertia_of_zero_or_more(name: str, value: float) -> None:
    with pytest.raises(InputError, match=f"the {name} of a link must be zero or more and finite; got"):
        RigidLink(**{"mass": 1.0, name: value})


@pytest.mark.parametrize("name", ["centre", "centre_across"])
@pytest.mark.parametrize("value", [math.nan, -math.inf])
def test_mass_centre_must_be_finite(name: str, value: float) -> None:
    with pytest.raises(InputError, match=f"the {name} of a link must be finite"):
        RigidLink(**{"mass": 1.0, name: value})


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"mass": -1.0}, "the mass of the counterweight must be zero or more"),
        ({"radius": -0.1}, "the radius of the counterweight must be zero or more"),
        ({"inertia": math.nan}, "the inertia of the counterweight must be zero or more and finite"),
        ({"angle": math.inf}, "the angle of the counterweight must be finite"),
    ],
)
def test_wrong_counterweight_is_refused(values: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Counterweight(**{"mass": 1.0, "radius": 0.1, **values})
