"""Balancing: shaking is affine in the masses, classic balances, and scipy on the same problems."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
import scipy.optimize
from numpy.typing import NDArray

from slidercrank.model.cycle.multi_cylinder import shaking_curves
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.sizing.counterweight import Balance, RodSpace, best_balance
from slidercrank.optimise.sizing.input_words import Measure
from slidercrank.optimise.sizing.shaking_rows import shaking_rows, with_balance_masses
from tests.model.cases import linkage_of, random_designs, random_machine

Array = NDArray[np.float64]
search: Any = scipy.optimize.minimize  # its stubs have no array of constraints
MEASURES: tuple[Measure, ...] = ("peak", "rms")
TURN = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)


def random_cases(count: int, *, seed: int) -> list[tuple[Mechanism, Linkage]]:
    random = np.random.default_rng(seed)
    cases = []
    for design in random_designs(count, seed=seed, least_margin=0.1):
        machine = dataclasses.replace(random_machine(random, loads=False), acceleration=0.0)
        cases.append((machine, linkage_of(design, machine.branch)))
    return cases


def two_point_rod(length: float, at_pin: float, at_slider: float) -> RigidLink:
    """Return the rod that two masses at its ends make."""
    mass = at_pin + at_slider
    return RigidLink(mass=mass, centre=at_slider * length / mass, inertia=at_pin * at_slider * length**2 / mass)


def along_and_across(found: Balance) -> Array:
    return found.moment * np.array([math.cos(found.angle), math.sin(found.angle)])


def test_shaking_is_affine_in_counterweight_and_rod_balance() -> None:
    random = np.random.default_rng(1)
    for machine, linkage in random_cases(6, seed=2):
        mass, at = random.uniform(0.1, 3.0), random.uniform(-0.1, 0.1, 2)
        own = random.uniform(0.0, 1e-2)
        x = np.array([*random.uniform(-0.2, 0.2, 2), mass, *(mass * at), mass * at @ at + own])
        force, moment = (table @ np.array([1.0, *x]) for table in shaking_rows(machine, linkage, TURN[:9]))
        radius = random.uniform(0.01, 0.1)
        expected = shaking_curves(with_balance_masses(machine, linkage, x, radius), linkage, TURN[:9])
        size = np.abs(force).max()
        np.testing.assert_allclose(force, [expected.force_x, expected.force_y], rtol=0, atol=1e-12 * size)
        np.testing.assert_allclose(moment, expected.moment, rtol=0, atol=1e-12 * np.abs(moment).max())


@pytest.mark.parametrize("measure", MEASURES)
def test_without_a_slider_mass_the_rotating_mass_is_balanced_in_full(measure: Measure) -> None:
    """A rod with its mass at the crank pin turns with the crank. c = -(crank's moment + rod's mass times crank)."""
    crank = RigidLink(mass=0.7, centre=0.02, centre_across=0.004)
    machine = Mechanism(speed=-20.0, crank=crank, rod=RigidLink(mass=1.2, centre=0.0, inertia=0.0))
    found = best_balance(machine, Linkage(0.05, 0.2, 0.03), measure=measure)
    expected = np.array([-(0.7 * 0.02 + 1.2 * 0.05), -0.7 * 0.004])
    np.testing.assert_allclose(along_and_across(found), expected, rtol=1e-7)
    assert found.shaking_before.peak_force == pytest.approx(400.0 * np.hypot(*expected), rel=1e-12)
    assert found.shaking_after.peak_force <= 1e-7 * found.shaking_before.peak_force


@pytest.mark.parametrize("rod", [0.06, 0.2, 5.0])
def test_least_rms_balances_the_rotating_mass_and_half_of_the_reciprocating_one(rod: float) -> None:
    """Without offset exactly, for any rod: what a long rod leaves out has even harmonics only, which c has not."""
    machine = Mechanism(
        speed=30.0, crank=RigidLink(mass=0.4, centre=0.02), rod=two_point_rod(rod, 0.6, 0.3), slider_mass=1.1
    )
    found = best_balance(machine, Linkage(0.05, rod), measure="rms")
    rotating, reciprocating = 0.4 * 0.02 + 0.6 * 0.05, (0.3 + 1.1) * 0.05
    assert found.moment == pytest.approx(rotating + 0.5 * reciprocating, rel=1e-9)
    assert abs(found.angle) == pytest.approx(math.pi, abs=1e-9)
    assert found.mass == pytest.approx(found.moment / 0.05, rel=1e-12)  # at the crank's radius


def test_least_peak_tends_to_the_half_mass_compromise_for_long_rods() -> None:
    """The primary force, in line with m r w^2, alone: its peak is halved. The rest is of order crank / rod."""
    off = []
    for ratio in (1e-3, 1e-4):
        machine = Mechanism(speed=30.0, slider_mass=1.1)
        found = best_balance(machine, Linkage(0.05, 0.05 / ratio))
        off.append(found.moment / (0.5 * 1.1 * 0.05) - 1.0)
        assert found.shaking_after.peak_force / found.shaking_before.peak_force == pytest.approx(0.5, abs=2.0 * ratio)
        assert abs(off[-1]) < 2.0 * ratio
    assert abs(off[0]) > 1e-9  # so that it is a limit that is seen


def test_a_rod_balance_and_a_counterweight_balance_the_force_in_full() -> None:
    """Berkof and Lowen: the centre of rod and slider on the crank pin, then the whole as a rotating mass."""
    machine = Mechanism(
        speed=25.0, crank=RigidLink(mass=0.4, centre=0.02), rod=RigidLink(mass=0.6, centre=0.06), slider_mass=1.1
    )
    found = best_balance(machine, Linkage(0.05, 0.2, 0.02), rod=RodSpace(radius=0.08, mass=10.0))
    assert found.rod is not None
    along = 0.6 * 0.06 + 1.1 * 0.2
    assert found.rod.moment_along == pytest.approx(-along, rel=1e-7)
    assert found.rod.moment_across == pytest.approx(0.0, abs=1e-7 * along)
    assert found.rod.mass == pytest.approx(along / 0.08, rel=1e-7)  # all of it as far out as there is space
    assert found.moment == pytest.approx(0.4 * 0.02 + (0.6 + along / 0.08 + 1.1) * 0.05, rel=1e-7)
    assert found.shaking_after.peak_force <= 1e-7 * found.shaking_before.peak_force
    assert found.shaking_after.peak_moment > found.shaking_before.peak_moment  # what it costs


def test_least_rms_is_the_solution_of_least_squares() -> None:
    """F = F_0 + w^2 R(theta) c: c = -mean(R^T F_0) / w^2."""
    for machine, linkage in random_cases(8, seed=3):
        bare = dataclasses.replace(machine, counterweight=dataclasses.replace(machine.counterweight, mass=0.0))
        force = shaking_curves(bare, linkage, TURN)
        sine, cosine = np.sin(TURN), np.cos(TURN)
        best = -np.array(
            [
                np.mean(cosine * force.force_x + sine * force.force_y),
                np.mean(cosine * force.force_y - sine * force.force_x),
            ]
        )
        best /= machine.speed**2
        found = best_balance(machine, linkage, measure="rms")
        np.testing.assert_allclose(along_and_across(found), best, rtol=0, atol=1e-7 * np.hypot(*best))
        rest = shaking_curves(found.balanced, linkage, TURN)
        rms = np.sqrt(np.mean(rest.force_x**2 + rest.force_y**2))
        assert found.objective == pytest.approx(rms, rel=1e-9)


def by_scipy(machine: Mechanism, linkage: Linkage, found: Balance, arm: float | None, space: RodSpace | None) -> float:
    """Return the least of peaks on many angles by SLSQP, over all moments, mass and inertia, and over epigraphs."""
    rest = shaking_curves(found.balanced, linkage, TURN)
    sizes = (np.hypot(rest.force_x, rest.force_y), np.abs(rest.moment))
    tops = [TURN[(size >= np.roll(size, 1)) & (size >= np.roll(size, -1))] for size in sizes]
    near = np.concatenate([angle + np.linspace(-6e-3, 6e-3, 41) for angle in np.concatenate(tops)])
    count, moment = (2, 0.1) if space is None else (6, 0.1)
    reach = 1.0 if space is None else space.radius
    unit = np.array([moment, moment, 1.0, reach, reach, reach**2])[:count]
    force, turning = shaking_rows(machine, linkage, np.concatenate([TURN[::4], near]))
    size = np.abs(force[..., 0]).max()
    f, g = force[..., : count + 1] / size, turning[..., : count + 1] / (size * (arm or 1.0))
    f[..., 1:] *= unit
    g[..., 1:] *= unit

    def rules(z: Array) -> Array:
        x = np.array([1.0, *z[:count]])
        fx, fy, m = f[0] @ x, f[1] @ x, g @ x
        held = [z[-2] ** 2 - fx**2 - fy**2]
        if arm is not None:
            held += [z[-1] - m, z[-1] + m]
        if space is not None:
            held += [[z[2] * z[5] - z[3] ** 2 - z[4] ** 2, z[2] - z[5], space.mass - z[2]]]
        return np.concatenate(held)

    start = np.zeros(count + 2)
    start[-2:] = 1.2, 2.0 * np.abs(g[:, 0]).max() + 0.1
    if space is not None:
        start[2], start[5] = 0.5 * space.mass, 0.25 * space.mass
        start[0], start[-2] = -start[2] * float(linkage.crank) / moment, 3.0
    bounds = [(None, None)] * count + [(0.0, None)] * 2
    if space is not None:
        bounds[2] = bounds[5] = (0.0, None)
    done = search(
        lambda z: z[-2] + (z[-1] if arm is not None else 0.0),
        start,
        method="SLSQP",
        bounds=bounds,
        constraints={"type": "ineq", "fun": rules},
        options={"ftol": 1e-13, "maxiter": 500},
    )
    assert done.success or done.status == 8, done.message  # 8: no descent left within rounding
    return float(done.fun * size)


@pytest.mark.parametrize("arm", [None, 0.3])
def test_scipy_finds_the_same_least_peak(arm: float | None) -> None:
    for machine, linkage in random_cases(3, seed=5):
        space = None if arm is None else RodSpace(radius=0.06, mass=1.5)
        found = best_balance(machine, linkage, arm=arm, rod=space)
        assert found.converged
        assert found.objective == pytest.approx(by_scipy(machine, linkage, found, arm, space), rel=1e-6)
        assert found.objective == pytest.approx(found.bound, rel=1e-6)


def test_peaks_are_exact_and_less_than_before() -> None:
    for machine, linkage in random_cases(3, seed=6):
        found = best_balance(machine, linkage, rod=RodSpace(radius=0.05, mass=0.8), arm=0.4, greatest_moment=0.2)
        before, after = found.shaking_before_and_after(TURN)
        for curves, shaking in ((before, found.shaking_before), (after, found.shaking_after)):
            size = np.hypot(curves.force_x, curves.force_y)
            assert shaking.peak_force >= size.max() * (1.0 - 1e-12)
            assert shaking.peak_force == pytest.approx(size.max(), rel=1e-4)
            assert shaking.rms_force == pytest.approx(np.sqrt(np.mean(size**2)), rel=1e-6)
            assert shaking.peak_moment >= np.abs(curves.moment).max() * (1.0 - 1e-12)
        assert found.rod is not None
        first = math.hypot(found.rod.moment_along, found.rod.moment_across)
        # A body of that mass, moment and inertia fits into the space.
        assert first**2 <= found.rod.mass * found.rod.inertia * (1.0 + 1e-9)
        assert found.rod.inertia <= 0.05**2 * found.rod.mass * (1.0 + 1e-9)
        assert found.rod.mass <= 0.8 * (1.0 + 1e-8)
        assert found.moment <= 0.2 * (1.0 + 1e-8)


@pytest.mark.parametrize("measure", MEASURES)
def test_the_price_of_a_bounded_counterweight_predicts_one_percent_more(measure: Measure) -> None:
    machine, linkage = Mechanism(speed=30.0, rod=RigidLink(mass=0.5), slider_mass=1.1), Linkage(0.05, 0.15, 0.02)
    free = best_balance(machine, linkage, measure=measure)
    assert free.saving == 0.0
    most = 0.5 * free.moment
    found = best_balance(machine, linkage, measure=measure, greatest_moment=most)
    assert found.moment == pytest.approx(most, rel=1e-7)
    more = best_balance(machine, linkage, measure=measure, greatest_moment=1.01 * most)
    assert found.objective - more.objective == pytest.approx(found.saving * 0.01 * most, rel=0.02)
    wide = best_balance(machine, linkage, measure=measure, greatest_moment=2.0 * free.moment)
    assert wide.saving == 0.0
    assert wide.objective == pytest.approx(free.objective, rel=1e-8)


def test_what_makes_no_sense_is_refused() -> None:
    machine, linkage = Mechanism(speed=30.0, slider_mass=1.0), Linkage(0.05, 0.15)
    wrong = dataclasses.replace
    for arguments, message in (
        ((wrong(machine, acceleration=1.0), {}), "constant crank speed; got 30 rad/s with an acceleration of 1"),
        ((wrong(machine, speed=0.0), {}), "constant crank speed; got 0 rad/s"),
        ((wrong(machine, slider_mass=0.0), {}), "balancing needs masses"),
        ((machine, {"arm": 0.3}), "the counterweight does not affect the shaking moment .* without a rod balance"),
        ((machine, {"greatest_moment": 0.0}), "greatest_moment must be positive"),
        ((machine, {"radius": math.nan}), "radius must be positive"),
        ((machine, {"measure": "mean"}), "measure must be"),
    ):
        with pytest.raises(InputError, match=message):
            best_balance(arguments[0], linkage, **arguments[1])
    with pytest.raises(InputError, match="space for the rod balance"):
        RodSpace(radius=0.0, mass=1.0)
    with pytest.raises(InputError, match="greatest mass"):
        RodSpace(radius=1.0, mass=math.inf)
