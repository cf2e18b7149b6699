"""Times of the strokes along speed profiles, against an integration over the crank angle.

`tests/model/test_averages_over_time.py` compares such an integration with the crank's differential equation.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from slidercrank.model.cycle.stroke_times import scaled_stroke_times, slow_stroke
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.loads.engine import FourStroke
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.machine.speed_profile import Harmonics, SpeedTable
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.own.designs import Designs
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.robust.quantity import Case, RobustQuantity
from slidercrank.objectives.tables.all_quantities import analyse
from tests.model.cases import TOLERANCES, Array, random_designs
from tests.model.quadrature import integrals

TURN = 2.0 * math.pi
FEEDER = np.array([[0.0376, 0.0998, 0.03119]])
"""Crank, rod, offset, m."""
FEEDER_SPEED = -2400.0 * math.pi / 30.0
TIMES = ("outward_stroke_time", "inward_stroke_time")


def random_case(seed: int) -> tuple[Mechanism, Array]:
    """Return a machine with a random profile, of either sense of rotation and branch, and a design (1, 3)."""
    random = np.random.default_rng(seed)
    if seed % 2:
        cosines, sines = random.uniform(-0.3, 0.3, (2, 1 + seed % 5)) / np.arange(1.0, 2.0 + seed % 5)
        profile: Harmonics | SpeedTable = Harmonics(cosines=tuple(cosines), sines=tuple(sines))
    else:
        angles = np.cumsum(random.uniform(0.3, 1.0, 5 + seed % 3)) - 2.0
        profile = SpeedTable(angles=tuple(angles), speeds=tuple(random.uniform(0.7, 1.3, len(angles))))
    speed = float(random.choice([-1.0, 1.0]) * random.uniform(0.5, 200.0))
    branch: Branch = "open" if random.random() < 0.5 else "crossed"
    return Mechanism(speed=speed, branch=branch, speed_profile=profile), random_designs(1, seed=seed, least_margin=0.05)


def ratio_of(profile: Harmonics | SpeedTable) -> Any:
    """Return the speed over its mean as a function of the crank angle, by the tests' own formulas."""
    if isinstance(profile, Harmonics):
        pairs = list(zip(profile.cosines, profile.sines, strict=True))
        return lambda at: 1.0 + sum(a * np.cos(k * at) + b * np.sin(k * at) for k, (a, b) in enumerate(pairs, start=1))
    angles, speeds = [*profile.angles, profile.angles[0] + TURN], [*profile.speeds, profile.speeds[0]]
    spline = CubicSpline(angles, speeds, bc_type="periodic")
    mean = float(spline.integrate(angles[0], angles[-1])) / TURN
    return lambda at: spline(at) / mean


def times_by_integration(machine: Mechanism, design: Array, lead: float = 0.0) -> dict[str, float]:
    """Return the times between the ends of the slider's travel, s, by integrating 1 / (speed p) over shaft angle.

    The slider reverses where its velocity changes sign; the farther end is the outer one.
    lead: lead of a cylinder's crank over the shaft's angle, rad.
    """
    assert machine.speed_profile is not None
    (r, l, e), profile = design[0], machine.speed_profile
    p, sign, way = ratio_of(profile), 1.0 if machine.branch == "open" else -1.0, math.copysign(1.0, machine.speed)

    def position(shaft: Any) -> Any:
        theta = shaft + lead
        return np.abs(r * np.cos(theta) + sign * np.sqrt(l * l - (e - r * np.sin(theta)) ** 2))

    def velocity(shaft: Any) -> Any:
        theta = shaft + lead
        across = e - r * np.sin(theta)
        return -r * np.sin(theta) + sign * across * r * np.cos(theta) / np.sqrt(l * l - across * across)

    shaft = 0.3 + way * np.linspace(0.0, 2.0 * TURN, 2001)
    turns = [
        brentq(velocity, shaft[k], shaft[k + 1], xtol=1e-15) for k in np.flatnonzero(np.diff(np.sign(velocity(shaft))))
    ]
    knots = np.add.outer(TURN * np.arange(-3, 4), profile.knots).ravel()
    first, second = (
        integrals(lambda at: 1.0 / p(at)[None], [low, *knots[(knots > low) & (knots < high)], high])[0]
        / abs(machine.speed)
        for low, high in map(sorted, itertools.pairwise(turns[:3]))
    )
    outward, inward = (first, second) if position(turns[1]) > position(turns[0]) else (second, first)
    return {"outward_stroke_time": outward, "inward_stroke_time": inward}


def value(name: str, machine: Mechanism, design: Array) -> float:
    return float(QUANTITIES[name].evaluate(machine, design).values[0])


@pytest.mark.parametrize("seed", range(100))
def test_times_of_strokes_along_a_profile_are_those_of_the_crank_followed_over_time(seed: int) -> None:
    machine, design = random_case(seed)
    wanted = times_by_integration(machine, design)
    for name in TIMES:
        assert value(name, machine, design) == pytest.approx(wanted[name], rel=1e-9)
    slower, faster = max(wanted.values()), min(wanted.values())
    assert value("time_ratio", machine, design) == pytest.approx(slower / faster, rel=1e-9)
    row = analyse(machine, design).iloc[0]
    assert row["time_ratio"] == pytest.approx(slower / faster, rel=1e-9)
    assert row["slow_stroke"] == ("outward" if wanted["outward_stroke_time"] == slower else "inward")
    own = Designs(machine, design).time_ratio
    assert own[0, 0] == pytest.approx(slower / faster, rel=1e-9)


@pytest.mark.parametrize(("cosine", "ratio", "slow"), [(0.5, 1.615, "outward"), (-0.5, 1.0 / 0.947, "inward")])
def test_the_feeder_turns_its_time_ratio_and_slow_stroke_round_with_the_profile(
    cosine: float, ratio: float, slow: str
) -> None:
    machine = Mechanism(speed=FEEDER_SPEED, speed_profile=Harmonics(cosines=(cosine,), sines=(0.0,)))
    wanted = times_by_integration(machine, FEEDER)
    outward, inward = (wanted[name] for name in TIMES)
    assert max(outward / inward, inward / outward) == pytest.approx(ratio, abs=1e-3)
    row = analyse(machine, FEEDER).iloc[0]
    assert row["time_ratio"] == pytest.approx(max(outward / inward, inward / outward), rel=1e-9)
    assert row["outward_to_inward_time_ratio"] == pytest.approx(outward / inward, rel=1e-9)
    assert row["inward_to_outward_time_ratio"] == pytest.approx(inward / outward, rel=1e-9)
    assert row["slow_stroke"] == slow
    assert row["crank_angle_ratio"] == pytest.approx(1.20825266, abs=1e-8)


def test_without_a_profile_times_are_crank_angles_over_the_speed_and_the_time_ratio_is_the_closed_form() -> None:
    designs = random_designs(50, seed=4)
    for branch in ("open", "crossed"):
        for speed in (7.0, -7.0):
            machine = Mechanism(speed=speed, branch=branch)
            r, l, e = designs.T
            excess = np.arcsin(e / (l - r)) - np.arcsin(e / (l + r))
            side = math.copysign(1.0, speed) * (1.0 if branch == "open" else -1.0)
            for name, own in zip(TIMES, (math.pi - side * excess, math.pi + side * excess), strict=True):
                np.testing.assert_allclose(QUANTITIES[name].evaluate(machine, designs).values, own / 7.0, rtol=1e-12)
            geometric = QUANTITIES["crank_angle_ratio"].evaluate(machine, designs).values
            np.testing.assert_array_equal(QUANTITIES["time_ratio"].evaluate(machine, designs).values, geometric)
            linkage = Linkage(r, l, e, machine.branch)
            np.testing.assert_array_equal(slow_stroke(machine, linkage), linkage.slow_stroke(direction=speed))


def test_both_strokes_take_the_time_of_a_turn_over_any_profile() -> None:
    for seed in range(20):
        machine, design = random_case(seed)
        assert machine.speed_profile is not None
        period = TURN / abs(machine.speed) / machine.speed_profile.time_mean_over_angle_mean
        assert sum(value(name, machine, design) for name in TIMES) == pytest.approx(period, rel=1e-13)


def test_a_single_harmonic_takes_the_time_of_its_closed_form() -> None:
    """Integral of 1 / (1 + a cos) by its closed form.

    It is 2 atan(sqrt((1 - a) / (1 + a)) tan(theta / 2)) / sqrt(1 - a^2).
    """
    for a in (0.3, -0.9, 0.999, 1.0 - 1e-6):
        elapsed = Harmonics(cosines=(a,)).elapsed_time
        theta = np.linspace(-3.1, 3.1, 200)
        wanted = 2.0 * np.arctan(math.sqrt((1.0 - a) / (1.0 + a)) * np.tan(0.5 * theta)) / math.sqrt(1.0 - a * a)
        found = elapsed.elapsed_up_to(theta) - elapsed.elapsed_up_to(np.zeros(1))
        # 1 - a is known to rounding alone: the time near it to 1e-16 / (1 - a) of itself.
        np.testing.assert_allclose(found, wanted, rtol=1e-13 + 4e-16 / (1.0 - abs(a)), atol=1e-13)
        assert elapsed.elapsed_over_full_turn == pytest.approx(
            TURN / math.sqrt(1.0 - a * a), rel=1e-13 + 4e-16 / (1.0 - abs(a))
        )


def test_a_profile_that_moves_with_the_mirror_image_swaps_the_strokes() -> None:
    """Mirrored about the slider line, a machine has offset -e and rotates in the other direction, along p(-theta)."""
    for seed in range(1, 20, 2):
        machine, design = random_case(seed)
        profile = machine.speed_profile
        assert isinstance(profile, Harmonics)
        turned = Harmonics(cosines=profile.cosines, sines=tuple(-b for b in profile.sines))
        mirrored = replace(machine, speed=-machine.speed, speed_profile=turned)
        for name in TIMES:
            there = value(name, mirrored, design * [1.0, 1.0, -1.0])
            assert there == pytest.approx(value(name, machine, design), rel=1e-12)


def test_a_speed_that_varies_changes_the_times_and_not_their_ratio() -> None:
    machine, design = random_case(3)
    varying = replace(machine, varying=(Varying(name="speed", sets=(("speed", 1.0),), lower=-9.0, upper=-3.0),))
    slow, fast = np.array([[*design[0], -3.0]]), np.array([[*design[0], -9.0]])
    for name in TIMES:
        assert value(name, varying, slow) == pytest.approx(3.0 * value(name, varying, fast), rel=1e-13)
    assert value("time_ratio", varying, slow) == value("time_ratio", varying, fast)


def test_cylinders_along_a_profile_have_times_of_their_own() -> None:
    """The profile is that of the shaft, which the crank of a cylinder leads by its phase."""
    machine, _ = random_case(1)
    arrangement = Arrangement(phases=(0.4, 2.6), banks=(0.0, 0.3))
    both = replace(machine, arrangement=arrangement)
    for cylinder, lead in enumerate((0.4, 2.3)):
        wanted = times_by_integration(machine, FEEDER, lead)
        found = scaled_stroke_times(both, *FEEDER.T, cylinder=cylinder)
        assert found.outward[0] / abs(machine.speed) == pytest.approx(wanted["outward_stroke_time"], rel=1e-9)
    for name, over in (("outward_to_inward_time_ratio", 1.0), ("inward_to_outward_time_ratio", -1.0)):
        each = [scaled_stroke_times(both, *FEEDER.T, cylinder=k).outward_to_inward_ratio[0] ** over for k in range(2)]
        assert abs(each[0] - each[1]) > 0.01
        assert value(name, both, FEEDER) == pytest.approx(min(each), rel=1e-14)
    for name in ("time_ratio", *TIMES):
        said = QUANTITIES[name].undefined_because([both])
        assert said is not None
        assert "because each has its own stroke times" in said
    assert QUANTITIES["time_ratio"].undefined_because([replace(both, speed_profile=None)]) is None
    assert np.isnan(analyse(both, FEEDER).iloc[0]["time_ratio"])


def test_the_slow_stroke_of_cylinders_is_named_where_it_is_the_same() -> None:
    opposed = Arrangement(phases=(0.0, math.pi))
    uneven = Mechanism(speed=5.0, speed_profile=Harmonics(cosines=(0.0,), sines=(0.6,)), arrangement=opposed)
    linkage = Linkage(0.03, 0.1, 0.0)
    assert slow_stroke(uneven, linkage) == "differs"
    alike = replace(uneven, speed_profile=Harmonics(cosines=(0.01,)))
    assert slow_stroke(alike, Linkage(0.03, 0.1, 0.04)) == "inward"


def test_times_need_a_speed_that_repeats() -> None:
    for machine, said in (
        (Mechanism(), "needs a crank speed"),
        (Mechanism(speed=1.0, acceleration=1.0), "crank accel"),
    ):
        for name in TIMES:
            reason = QUANTITIES[name].undefined_because([machine])
            assert reason is not None
            assert said in reason
            assert np.isnan(value(name, machine, FEEDER))
        assert value("time_ratio", machine, FEEDER) == pytest.approx(1.20825266, abs=1e-8)


def test_a_cycle_of_two_turns_has_the_strokes_of_its_turn() -> None:
    """The profile repeats every turn, independently of the gas."""
    machine, design = random_case(5)
    gas = FourStroke(
        bore=0.08, low=9e4, high=5e6, clearance=0.11, compression_exponent=1.3, expansion_exponent=1.25, exhaust=1.1e5
    )
    engine = replace(machine, branch="open", loads=(gas,))
    for name in ("time_ratio", *TIMES):
        assert value(name, engine, design) == value(name, replace(machine, branch="open"), design)


def test_derivatives_of_a_function_of_ones_own_follow_the_times() -> None:
    for seed in (1, 2):
        machine, design = random_case(seed)
        gradients = QUANTITIES["time_ratio"].evaluate(machine, design, gradients=True).gradients
        assert gradients is not None
        for column in range(3):
            stepped = design.astype(np.complex128)
            stepped[:, column] += 1e-30j
            own = Designs(machine, stepped).time_ratio.imag[0, 0] / 1e-30
            assert own == pytest.approx(gradients[0, column], rel=1e-13)
    both = replace(machine, arrangement=Arrangement(phases=(0.0, 2.0)))
    with pytest.raises(
        InputError,
        match="time_ratio: with a speed profile it needs a single cylinder, because each has its own stroke times",
    ):
        _ = Designs(both, design).time_ratio


@pytest.mark.parametrize("case", ["worst case", "percentile"])
def test_a_robust_time_ratio_along_a_profile_is_of_time(case: Case) -> None:
    """Against designs at the corners of the tolerances, which a quotient of times is steepest towards."""
    machine = Mechanism(speed=5.0, speed_profile=Harmonics(sines=(0.4,)), tolerances=TOLERANCES)
    design = np.array([[0.04, 0.12, 0.02]])
    robust = RobustQuantity(inner=QUANTITIES["time_ratio"], side="high", case=case)
    found = float(robust.evaluate(machine, design).values[0])
    limits = np.array(
        [
            TOLERANCES.crank.deviation_limit(0.04),
            TOLERANCES.rod.deviation_limit(0.12),
            TOLERANCES.offset.deviation_limit(0.02),
        ]
    )
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * limits
    worst = max(value("time_ratio", machine, design + corner) for corner in corners)
    plain = value("time_ratio", machine, design)
    assert found == pytest.approx(worst, rel=1e-9) if case == "worst case" else plain < found < worst
