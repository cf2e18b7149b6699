"""Accepted and refused dimensions of a linkage, with the words of the refusals; crank from stroke."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.inverse_kinematics import crank_from_stroke
from slidercrank.model.linkage.linkage import Linkage
from tests.model.cases import random_designs


def test_dimensions_broadcast() -> None:
    machine = Linkage(0.1, [[0.3], [0.4]], [0.0, 0.05, -0.05])
    assert machine.stroke.shape == (2, 3)
    assert machine.rotates_fully.shape == (2, 3)
    assert machine.at(0.3).slider_position.shape == (2, 3)
    assert machine.slow_stroke().shape == (2, 3)
    assert machine.stroke[1, 2] == Linkage(0.1, 0.4, -0.05).stroke
    assert Linkage(0.1, 0.3).at(np.zeros((4, 5)), speed=[1.0, 2.0, 3.0, 4.0, 5.0]).rod_angle.shape == (4, 5)
    assert Linkage(0.1, [0.3, 0.4]).rod_point(np.zeros((7, 1)), along=0.1).position.shape == (7, 2, 2)


def test_scalar_dimensions_give_scalars() -> None:
    machine = Linkage(0.1, 0.3, 0.02)
    assert np.ndim(machine.stroke) == np.ndim(machine.time_ratio) == 0
    assert isinstance(machine.slow_stroke(), str)
    assert bool(machine.rotates_fully)


def test_linkage_is_immutable() -> None:
    lengths = np.array([0.1, 0.2])
    machine = Linkage(lengths, 0.4)
    lengths[0] = 0.3
    assert machine.crank[0] == 0.1
    with pytest.raises(dataclasses.FrozenInstanceError):
        machine.rod = lengths  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        machine.crank[0] = 0.3


@pytest.mark.parametrize(
    ("dimensions", "message"),
    [
        ((0.0, 0.3, 0.0), "crank must be above zero; got 0 m"),
        ((0.1, -0.3, 0.0), "rod must be above zero; got -0.3 m"),
        (([0.1, -0.2], 0.3, 0.0), "crank must be above zero; got -0.2 m"),
        ((math.nan, 0.3, 0.0), "crank must be finite; got nan"),
        ((0.1, math.inf, 0.0), "rod must be finite; got inf"),
        ((0.1, 0.3, [0.0, math.nan]), "offset must be finite"),
        (("long", 0.3, 0.0), "crank must be a number or an array of numbers in SI units; got 'long'"),
        ((0.1, None, 0.0), "rod must be finite; got None"),
        (([0.1, 0.1], [0.3, 0.3, 0.3], 0.0), r"must broadcast to one shape; got \(2,\), \(3,\), \(\)"),
    ],
)
def test_wrong_dimensions_are_refused(dimensions: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Linkage(*dimensions)


def test_unknown_branch_is_refused() -> None:
    with pytest.raises(InputError, match="branch must be 'open' or 'crossed'; got 'closed'"):
        Linkage(0.1, 0.3, branch="closed")  # type: ignore[arg-type]


def test_linkage_that_never_closes_is_refused() -> None:
    message = r"or the linkage cannot close; got rod 300 mm, crank 100 mm, offset -400 mm; shorten the offset"
    with pytest.raises(AssemblyError, match=message):
        Linkage(0.1, 0.3, -0.4)


@pytest.mark.parametrize(
    "name", ["dead_centres", "dead_centre_angles", "stroke", "time_ratio", "least_transmission_angle"]
)
def test_what_needs_full_rotation_says_so(name: str) -> None:
    rocking = Linkage([0.1, 0.25], 0.3, -0.1)
    assert list(rocking.rotates_fully) == [True, False]
    message = (
        r"rod must exceed crank \+ \|offset\| for full rotation; "
        r"got rod 300 mm, crank 250 mm, offset -100 mm; lengthen the rod or reduce the offset"
    )
    with pytest.raises(AssemblyError, match=message):
        getattr(rocking, name)
    with pytest.raises(AssemblyError, match=message):
        rocking.slow_stroke()


def test_rod_of_exactly_crank_and_offset_does_not_turn_fully() -> None:
    assert not Linkage(0.25, 0.75, 0.5).rotates_fully


def test_rocking_linkage_moves_where_it_can() -> None:
    rocking = Linkage(0.25, 0.3, 0.1)
    reachable = np.radians([0.0, 40.0, 150.0, 200.0])
    motion = rocking.at(reachable, speed=1.0)
    # The rod keeps its length.
    pin = np.stack([0.25 * np.cos(reachable), 0.25 * np.sin(reachable)])
    np.testing.assert_allclose(np.hypot(motion.slider_position - pin[0], 0.1 - pin[1]), 0.3, rtol=1e-14)
    with pytest.raises(AssemblyError, match=r"got rod 300 mm, crank 250 mm, offset 100 mm at 270.000 deg; .*reachable"):
        rocking.at(np.radians([0.0, 270.0]))
    with pytest.raises(AssemblyError, match="reachable"):
        rocking.rod_point(math.radians(270.0), along=0.1)
    with pytest.raises(AssemblyError, match="reachable"):
        rocking.error_influences(math.radians(270.0))


def test_crank_angles_must_be_finite() -> None:
    with pytest.raises(InputError, match="crank angles must be finite"):
        Linkage(0.1, 0.3).at([0.0, math.nan])
    with pytest.raises(InputError, match="must be a number or an array of numbers in SI units; got 'top'"):
        Linkage(0.1, 0.3).at("top")
    with pytest.raises(InputError, match="stroke must be a number or an array of numbers in SI units; got '80 mm'"):
        crank_from_stroke("80 mm", rod=0.3)


@pytest.mark.parametrize("direction", [0.0, math.nan])
def test_slow_stroke_needs_a_direction(direction: float) -> None:
    with pytest.raises(InputError, match="direction must be positive"):
        Linkage(0.1, 0.3, 0.1).slow_stroke(direction=direction)


def test_crank_from_stroke_gives_back_the_crank() -> None:
    designs = random_designs(2000, seed=3)
    crank, rod, offset = designs.T
    found = crank_from_stroke(Linkage(crank, rod, offset).stroke, rod=rod, offset=offset)
    # l^2 - e^2 - S^2/4 cancels where rod and offset are long against the crank: measured 3e-14.
    np.testing.assert_allclose(found, crank, rtol=1e-12)
    scalar = crank_from_stroke(0.08, rod=0.2)
    np.testing.assert_allclose(scalar, 0.04, rtol=1e-15)


@pytest.mark.parametrize(
    ("stroke", "rod", "offset"),
    [
        (0.5, 0.3, 0.1),  # no real crank
        (0.0, 0.3, 0.1),
        (-0.1, 0.3, 0.1),
        (0.28, 0.2, 0.15),  # the crank found does not turn fully
        (0.6, 0.3, 0.0),  # the folded linkage
        (math.nan, 0.3, 0.0),
    ],
)
def test_stroke_out_of_reach_is_refused(stroke: float, rod: float, offset: float) -> None:
    with pytest.raises(AssemblyError, match="no crank gives this stroke with full rotation; got stroke"):
        crank_from_stroke(stroke, rod=rod, offset=offset)


def test_root_that_belongs_to_the_sum_of_the_dead_centres_is_refused() -> None:
    # Squaring S = x_out - x_in adds the solutions of S = x_out + x_in. Of every linkage that turns fully, that sum is
    # such a stroke: the formula gives back the crank, yet the linkage has another stroke.
    for crank, rod, offset in random_designs(200, seed=4):
        inner, outer = Linkage(crank, rod, offset).dead_centres
        with pytest.raises(AssemblyError, match="no crank gives this stroke"):
            crank_from_stroke(inner + outer, rod=rod, offset=offset)


def test_one_bad_stroke_among_many_is_named() -> None:
    with pytest.raises(AssemblyError, match="got stroke 900 mm, rod 300 mm, offset 50 mm"):
        crank_from_stroke([0.1, 0.9], rod=0.3, offset=0.05)


@pytest.mark.parametrize("motion", [{"speed": math.nan}, {"acceleration": math.inf}, {"speed": [1.0, math.nan]}])
def test_crank_motion_that_is_not_a_number_is_refused(motion: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="crank speed and acceleration must be finite"):
        Linkage(0.1, 0.3, 0.02).at(0.3, **motion)


def test_dead_centre_a_rounding_error_below_zero_is_at_zero() -> None:
    _, outer = Linkage(0.1, 0.3, -1e-18).dead_centre_angles
    assert outer == 0.0
