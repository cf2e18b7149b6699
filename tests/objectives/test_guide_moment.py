"""Guide moment against the forces of the cycle times the lever, closely sampled."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism, SliderDistances
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.joint_forces import GUIDE_MOMENT
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import SMOOTH, STROKES, TABLES, Array, linkage_of, random_designs

GUIDE = SliderDistances(guide=0.12)
DESIGNS = random_designs(8, seed=4, least_margin=0.05)
TURN = 2.0 * math.pi


def moment(machine: Mechanism, design: Array, angles: Array) -> Array:
    """Return |N (x_out + g - x)| from the forces of the cycle."""
    linkage = linkage_of(design, machine.branch)
    found = cycle(machine, linkage, angles.ravel())
    outer = math.sqrt((design[0] + design[1]) ** 2 - design[2] ** 2)
    x = linkage.at(angles.ravel()).slider_position * machine.sign
    return np.abs(found.guide * (outer + 0.12 - x)).reshape(angles.shape)


@pytest.mark.parametrize("friction", [Friction(), Friction(guide=0.05)], ids=["smooth", "rubbing"])
@pytest.mark.parametrize("machine", [SMOOTH, STROKES, TABLES], ids=["smooth", "strokes", "tables"])
def test_it_is_the_greatest_product_of_force_and_lever(machine: Mechanism, friction: Friction) -> None:
    machine = replace(machine, slider=GUIDE, friction=friction)
    for design, found in zip(DESIGNS, GUIDE_MOMENT.evaluate(machine, DESIGNS).values, strict=True):
        angles = np.linspace(0.0, TURN, 4001)
        rough, step = moment(machine, design, angles), angles[1]
        near = angles[np.argsort(-rough)[:12]]
        best = rough.max()
        for _ in range(4):
            fine = near[:, None] + step * np.linspace(-1.0, 1.0, 101)
            values = moment(machine, design, fine)
            near, best = fine[np.arange(len(near)), values.argmax(axis=1)], max(best, values.max())
            step /= 50.0
        assert found == pytest.approx(best, rel=1e-9)


def test_a_load_on_a_rod_without_mass_by_hand() -> None:
    """In line N = F tan(phi); a far guide counts where N is greatest.

    Here tan(phi) = r sin / sqrt(l^2 - r^2 sin^2).
    """
    r, l, force, far = 0.05, 0.13, 800.0, 1e6
    machine = Mechanism(loads=(StrokeForce(outward=-force, inward=-force),), slider=SliderDistances(guide=far))
    found = GUIDE_MOMENT.evaluate(machine, np.array([[r, l, 0.0]])).values[0]
    # tan(phi) = 5 / 12 with the crank normal to the line; the lever then is far + r + l - 0.12.
    assert found == pytest.approx(force * (5.0 / 12.0) * (far + 0.06), rel=1e-9)


def test_cylinders_count_one_by_one_and_the_distance_may_vary() -> None:
    machine = replace(SMOOTH, slider=GUIDE, gravity=(0.0, 0.0))
    several = replace(machine, arrangement=Arrangement(phases=(0.0, 2.0)))
    one, two = (GUIDE_MOMENT.evaluate(each, DESIGNS).values for each in (machine, several))
    np.testing.assert_allclose(two, one, rtol=1e-10)
    varying = Varying(name="guide", sets=(("slider.guide", 1.0),), lower=0.05, upper=0.2)
    designs = np.column_stack([DESIGNS, np.full(len(DESIGNS), 0.12)])
    found = GUIDE_MOMENT.evaluate(replace(machine, varying=(varying,)), designs, gradients=True)
    np.testing.assert_allclose(found.values, one, rtol=1e-13)
    farther = GUIDE_MOMENT.evaluate(replace(machine, slider=SliderDistances(guide=0.12 + 1e-6)), DESIGNS).values
    assert found.gradients is not None
    np.testing.assert_allclose(found.gradients[:, 3], (farther - one) / 1e-6, rtol=1e-4)


def test_a_guide_without_a_place_has_none() -> None:
    assert "the position of the guide" in str(GUIDE_MOMENT.undefined_because([SMOOTH]))
    assert QUANTITIES["guide_moment"] is GUIDE_MOMENT
