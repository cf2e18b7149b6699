"""The curves of one design are those of the linkage and of the position error, in their units and signs."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from tests.model.cases import MACHINES, SMOOTH, TOLERANCES, linkage_of, random_designs
from tests.model.virtual_work import error_parts, path, slider_load

THETA = np.linspace(-2.0, 8.0, 101)


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_curves_are_those_of_the_linkage(machine: Mechanism) -> None:
    sign = 1.0 if machine.branch == "open" else -1.0
    for design in random_designs(20, seed=81):
        got = cycle(machine, linkage_of(design, machine.branch), THETA)
        at = linkage_of(design, machine.branch).at(THETA, speed=machine.speed, acceleration=machine.acceleration)
        np.testing.assert_array_equal(got.crank_angle, THETA)
        # The same formulas, once with contracted multiplications and once without.
        np.testing.assert_allclose(got.slider_position, at.slider_position, rtol=1e-12)
        for name in ("slider_velocity", "slider_acceleration", "transmission_angle"):
            expected = getattr(at, name)
            size = np.abs(expected).max()
            np.testing.assert_allclose(getattr(got, name), expected, rtol=0, atol=1e-11 * size, err_msg=name)
        load = slider_load(machine, design, THETA, path(design, THETA, sign))
        np.testing.assert_allclose(got.load, load, rtol=0, atol=1e-9 * np.abs(load).max())


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_position_error_adds_up_the_parts_of_all_tolerances(machine: Mechanism) -> None:
    for design in random_designs(20, seed=82):
        got = cycle(machine, linkage_of(design, machine.branch), THETA)
        parts = error_parts(machine, design, THETA)
        np.testing.assert_allclose(got.position_error, sum(np.abs(part) for part in parts), rtol=1e-11)
        np.testing.assert_allclose(got.position_error_rss, np.sqrt(sum(part**2 for part in parts)), rtol=1e-11)


def test_root_sum_square_is_at_most_the_worst_case_and_at_least_half_of_it() -> None:
    # Four parts: their root sum square is no less than their sum over two.
    got = cycle(SMOOTH, Linkage(0.05, 0.2, 0.03), THETA)
    assert np.all(got.position_error_rss <= got.position_error)
    assert np.all(got.position_error_rss >= 0.5 * got.position_error)


def test_one_tolerance_alone_gives_the_same_error_either_way() -> None:
    size = Tolerance(absolute=1e-4)
    for name, alone in {
        "crank": Tolerances(crank=size),
        "rod": Tolerances(rod=size),
        "offset": Tolerances(offset=size),
        "crank angle": Tolerances(crank_angle=size),
    }.items():
        got = cycle(Mechanism(tolerances=alone), Linkage(0.05, 0.2, 0.03), THETA)
        np.testing.assert_allclose(got.position_error_rss, got.position_error, rtol=1e-15, err_msg=name)
        assert got.position_error.max() > 0.0


def test_position_error_predicts_a_finite_one() -> None:
    # All four tolerances at their limits, with the signs that add up: the slider is off by what is predicted.
    design, theta = np.array([0.05, 0.2, 0.03]), 2.0
    machine = dataclasses.replace(SMOOTH, tolerances=TOLERANCES)
    parts = error_parts(machine, design, theta)
    signs = [math.copysign(1.0, float(part)) for part in parts]
    t = TOLERANCES
    sizes = (
        t.crank.absolute + t.crank.fraction * 0.05,
        t.rod.absolute + t.rod.fraction * 0.2,
        t.offset.absolute + t.offset.fraction * 0.03,
    )
    off = Linkage(*(length + sign * size for length, sign, size in zip(design, signs[:3], sizes, strict=True)))
    moved = (
        off.at(theta + signs[3] * t.crank_angle.absolute).slider_position - Linkage(*design).at(theta).slider_position
    )
    predicted = cycle(machine, Linkage(*design), theta).position_error[0]
    # To first order: relative errors of 2e-3 squared remain.
    assert moved == pytest.approx(predicted, rel=1e-2)


def test_cycle_needs_full_rotation() -> None:
    with pytest.raises(AssemblyError, match="for full rotation"):
        cycle(SMOOTH, Linkage(0.25, 0.3, 0.1), THETA)


def test_linkage_on_another_branch_than_the_mechanism_is_refused() -> None:
    with pytest.raises(InputError, match="same branch; got crossed and open"):
        cycle(Mechanism(), Linkage(0.05, 0.2, 0.03, "crossed"), THETA)


def test_several_linkages_at_once_are_refused() -> None:
    with pytest.raises(InputError, match=r"one linkage is possible at a time; got an array of shape \(2,\)"):
        cycle(Mechanism(), Linkage(0.05, [0.2, 0.3], 0.03), THETA)


def test_curves_at_no_angle_are_refused() -> None:
    with pytest.raises(InputError, match="crank angles, speeds and accelerations must be finite"):
        cycle(Mechanism(), Linkage(0.05, 0.2, 0.03), [0.0, math.nan])
