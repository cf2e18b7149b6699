"""Mean and RMS torque against adaptive quadrature of the torque by virtual work, breakpoints given."""

from __future__ import annotations

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from slidercrank.model.averages import average_torque
from slidercrank.model.linkage import Linkage
from slidercrank.model.loads import AngleTable, PositionTable, StrokeForce
from slidercrank.model.mechanism import Mechanism
from tests.model.cases import MACHINES, SMOOTH, Array, linkage_of, random_designs, random_machine
from tests.model.virtual_work import drive_torque

DESIGNS = random_designs(25, seed=61)


def breakpoints(machine: Mechanism, design: Array) -> list[float]:
    """Return the crank angles at which the torque may have a kink, and those next to which it is steep."""
    linkage = linkage_of(design, machine.branch)
    inner, outer = (abs(float(end)) for end in linkage.dead_centres)
    found = [0.0, 0.5 * math.pi, math.pi, 1.5 * math.pi, *linkage.dead_centre_angles]
    for load in machine.loads:
        if isinstance(load, AngleTable):
            found += load.angles
        elif isinstance(load, PositionTable):
            for at in load.positions:
                x = {"crank pivot": at, "inner dead centre": inner + at, "outer dead centre": outer - at}[load.datum]
                found += angles_at(x if machine.branch == "open" else -x, design)
    return sorted({angle % (2.0 * math.pi) for angle in found} | {2.0 * math.pi})


def angles_at(x: float, design: Array) -> list[float]:
    """Return the crank angles at which crank pin and slider pin at x are a rod apart."""
    r, l, e = (float(value) for value in design)
    distance = math.hypot(x, e)
    cosine = (r**2 + distance**2 - l**2) / (2.0 * r * distance)
    if abs(cosine) > 1.0:
        return []
    return [math.atan2(e, x) + math.acos(cosine), math.atan2(e, x) - math.acos(cosine)]


def by_quadrature(machine: Mechanism, design: Array) -> tuple[float, float]:
    points = breakpoints(machine, design)
    first = second = 0.0
    for a, b in pairwise(points):
        if b - a > 1e-14:
            first += quad(lambda t: float(drive_torque(machine, design, t)), a, b, limit=400, epsabs=1e-11)[0]
            second += quad(lambda t: float(drive_torque(machine, design, t)) ** 2, a, b, limit=400, epsrel=1e-12)[0]
    return first / (2.0 * math.pi), math.sqrt(second / (2.0 * math.pi))


@pytest.mark.parametrize("name", MACHINES)
def test_averages_are_those_of_adaptive_quadrature(name: str) -> None:
    averages = average_torque(MACHINES[name], DESIGNS)
    for design, mean, rms in zip(DESIGNS, averages.mean, averages.rms, strict=True):
        expected_mean, expected_rms = by_quadrature(MACHINES[name], design)
        # The adaptive rule stops at 1e-11 N m an interval; the mean may cancel to far below the RMS value.
        assert mean == pytest.approx(expected_mean, rel=0.0, abs=1e-10 * expected_rms + 1e-10)
        assert rms == pytest.approx(expected_rms, rel=1e-10)


def test_averages_hold_for_random_machines() -> None:
    random = np.random.default_rng(62)
    for design in random_designs(12, seed=63, least_margin=0.01):
        machine = random_machine(random)
        averages = average_torque(machine, design[None])
        expected_mean, expected_rms = by_quadrature(machine, design)
        assert averages.mean[0] == pytest.approx(expected_mean, rel=0.0, abs=1e-10 * expected_rms)
        assert averages.rms[0] == pytest.approx(expected_rms, rel=1e-10)


def test_mean_torque_of_a_constant_force_against_one_stroke_is_its_work() -> None:
    # F S over 2 pi, whatever masses and gravity do.
    machine = dataclasses.replace(SMOOTH, acceleration=0.0, loads=(StrokeForce(outward=-120.0, inward=0.0),))
    designs = random_designs(500, seed=64)
    work = 120.0 * Linkage(*designs.T).stroke
    averages = average_torque(machine, designs)
    error = np.abs(averages.mean - work / (2.0 * math.pi)) / averages.rms
    assert error.max() < 1e-11


def test_mechanism_at_rest_has_averages_and_gradients_of_zero() -> None:
    averages = average_torque(Mechanism(), DESIGNS, gradients=True)
    for values in (averages.mean, averages.rms, averages.mean_gradients, averages.rms_gradients):
        assert values is not None
        assert np.all(values == 0.0)


def test_no_designs_have_no_averages() -> None:
    assert average_torque(SMOOTH, np.empty((0, 3))).mean.shape == (0,)
