"""Envelope of the moving links, against outlines of the drawing's bars over many angles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Bar, RigidLink
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import Array, linkage_of, random_designs

NAMES = ("envelope_length", "envelope_height")
ANGLES = np.linspace(0.0, 2.0 * np.pi, 100_001)


def swept(design: Array, branch: Branch, crank: float, rod: float) -> tuple[float, float]:
    """Return the extents along and across of discs of the links' widths about their pin centres."""
    x = np.asarray(linkage_of(design, branch).at(ANGLES).slider_position)
    r, y = float(design[0]), np.full_like(ANGLES, design[2])
    pin = np.stack([r * np.cos(ANGLES), r * np.sin(ANGLES)])
    discs = [(0.0 * pin, crank), (pin, crank), (pin, rod), (np.stack([x, y]), rod)]
    high = np.max([(at + 0.5 * width).max(axis=1) for at, width in discs], axis=0)
    low = np.min([(at - 0.5 * width).min(axis=1) for at, width in discs], axis=0)
    return tuple((high - low).tolist())


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_it_is_that_of_outlines_over_a_hundred_thousand_angles(branch: Branch) -> None:
    random = np.random.default_rng(61)
    seen = set()
    for design in random_designs(40, seed=62):
        crank, rod = design[0] * 10.0 ** random.uniform([-2.0, -2.0], [1.0, 0.3])
        machine = Mechanism(
            crank=Bar(width=crank, depth=0.01, density=1.0),
            rod=Bar(width=rod, depth=0.01, density=1.0),
            branch=branch,
        )
        for name, expected in zip(NAMES, swept(design, branch, crank, rod), strict=True):
            assert QUANTITIES[name].evaluate(machine, design[None]).values[0] == pytest.approx(expected, rel=1e-8)
            seen.add((name, int(np.argmax(QUANTITIES[name].pieces(machine, design[None]).values))))
    assert len(seen) == 7  # every piece is the greatest somewhere


def test_links_without_sections_are_centre_lines_and_sweep_the_footprint() -> None:
    designs = random_designs(50, seed=63)
    machine = Mechanism(crank=RigidLink(mass=1.0))
    length, height = (QUANTITIES[name].evaluate(machine, designs).values for name in NAMES)
    assert length * height == pytest.approx(QUANTITIES["footprint"].evaluate(machine, designs).values, rel=1e-14)


def test_slopes_by_widths_are_halves_and_wholes() -> None:
    bar = Bar(width=0.02, depth=0.01, density=1.0)
    widths = tuple(
        Varying(name=link, sets=((f"{link}.width", 1.0),), lower=0.01, upper=0.1) for link in ("crank", "rod")
    )
    machine = replace(Mechanism(crank=bar, rod=bar), varying=widths)
    designs = np.array([[0.05, 0.2, 0.01, 0.04, 0.02], [0.05, 0.2, 0.01, 0.02, 0.04], [0.05, 0.3, -0.12, 0.04, 0.02]])
    length, height = (QUANTITIES[name].evaluate(machine, designs, gradients=True).gradients for name in NAMES)
    assert length is not None
    assert height is not None
    assert length[:, 3:].tolist() == [[0.5, 0.5], [0.0, 1.0], [0.5, 0.5]]
    assert height[:, 3:].tolist() == [[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]]
    assert height[2, 2] == -1.0
