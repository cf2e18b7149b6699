"""Crank angles reported for greatest values: of equal ones the first, the same in every analysis."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.multi_cylinder import multi_cylinder_curves
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.model.signals.panel_polynomials import index_of_first_maximum, wrap_into_cycle
from slidercrank.objectives.tables.all_quantities import analysis_columns
from slidercrank.objectives.tables.curve_extremes import curve_extremes
from slidercrank.service.figures.datasheet import cycle_curves
from slidercrank.service.questions.cylinders import analysis as cylinders
from slidercrank.service.questions.motor import analysis as motor
from slidercrank.service.questions.uneven_speed import analysis as uneven_speed
from tests.case_count import case_count

TURN = 2.0 * math.pi


def even_engine(count: int, seed: int) -> tuple[Mechanism, Linkage]:
    """Return in-line cylinders with evenly spaced cranks, no gravity: their torque is periodic and symmetric."""
    random = np.random.default_rng(seed)
    machine = Mechanism(
        speed=float(random.uniform(20.0, 200.0)),
        slider_mass=float(random.uniform(0.2, 2.0)),
        rod=RigidLink(mass=float(random.uniform(0.1, 1.0))),
        arrangement=Arrangement(phases=tuple(TURN * k / count for k in range(count))),
    )
    crank = float(random.uniform(0.02, 0.08))
    return machine, Linkage(crank, crank * float(random.uniform(2.2, 5.0)), 0.0)


def angle_of_greatest(machine: Mechanism, linkage: Linkage, sign: int) -> float:
    """Return the first crank angle, deg, of the greatest torque, by parabolas through samples; sign 0: of its size."""
    theta = np.linspace(0.0, TURN, 20_000, endpoint=False)
    torque = multi_cylinder_curves(machine, linkage, theta).torque
    curve = sign * torque if sign else np.abs(torque)
    top = (curve >= np.roll(curve, 1)) & (curve > np.roll(curve, -1))
    before, at, after = (np.roll(curve, k)[top] for k in (1, 0, -1))
    bend = before - 2.0 * at + after
    heights = at - (after - before) ** 2 / (8.0 * bend)
    angles = theta[top] + 0.5 * (before - after) / bend * theta[1]
    return math.degrees(float(angles[heights >= heights.max() * (1.0 - 1e-7)].min()))


@pytest.mark.slow
@pytest.mark.parametrize("count", range(1, 7))
@pytest.mark.parametrize("seed", range(case_count(2, 4)))
def test_every_place_names_the_first_of_equal_greatest_torques(count: int, seed: int) -> None:
    machine, linkage = even_engine(count, seed)
    size, most, least = (angle_of_greatest(machine, linkage, sign) for sign in (0, 1, -1))
    row = analysis_columns(machine, np.array([[linkage.crank, linkage.rod, 0.0]]))
    together: Any = cylinders.numbers(machine, linkage)
    whole: Any = motor.numbers(machine, linkage)
    torque = next(found for found in curve_extremes(machine, linkage) if found.name == "torque")
    named = {
        "table": (row["peak_torque_angle_deg"][0], size),
        "motor": (whole["peak_torque_angle_deg"], size),
        "power": (whole["peak_power_angle_deg"], size),
        "cylinders": (together["peak_torque_angle_deg"], size),
        "cylinders, greatest": (together["greatest_torque_angle_deg"], most),
        "cylinders, least": (together["least_torque_angle_deg"], least),
        "extremes, greatest": (math.degrees(torque.greatest.crank_angle), most),
        "extremes, least": (math.degrees(torque.least.crank_angle), least),
    }
    for place, (angle, expected) in named.items():
        assert angle == pytest.approx(expected, abs=1e-4), place  # of a parabola through samples 0.018 deg apart


def test_the_figure_of_the_curves_marks_the_first_of_equal_peaks() -> None:
    machine, linkage = even_engine(1, 3)
    expected = analysis_columns(machine, np.array([[linkage.crank, linkage.rod, 0.0]]))["peak_torque_angle_deg"][0]
    panel = next(panel for panel in cycle_curves(machine, linkage).panels if panel.title == "drive torque")
    assert panel.lines[1].x == pytest.approx([expected], abs=1e-9)


def test_the_first_of_equal_values_is_that_of_the_least_angle_and_zero_is_zero_but_for_rounding() -> None:
    values = np.array([[3.0, 1.0, 3.0 * (1.0 - 1e-12)], [2.0, 2.0 + 1e-6, 2.0], [np.inf, np.nan, np.nan]])
    angles = np.array([[5.0, 0.1, 2.0], [0.5, 1.0, 1.5], [np.nan, np.nan, np.nan]])
    assert index_of_first_maximum(values, angles, TURN).tolist() == [2, 1, 0]
    # A sample beside a flat top is as high but for rounding, and is not the peak.
    assert index_of_first_maximum(np.array([1.0 - 1e-12, 1.0]), np.array([1.0, 1.0001]), TURN) == 1
    # At zero from below.
    assert index_of_first_maximum(np.array([1.0, 1.0]), np.array([3.0, TURN - 1e-9]), TURN) == 1
    assert [wrap_into_cycle(angle, TURN) for angle in (TURN - 1e-9, 1.0, TURN + 1.0)] == [0.0, 1.0, pytest.approx(1.0)]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_no_extreme_of_a_symmetric_machine_is_named_at_the_end_of_its_cycle(seed: int) -> None:
    random = np.random.default_rng(seed)
    profile = Harmonics(cosines=(0.0, float(random.uniform(-0.1, 0.1)))) if seed % 2 else None
    machine = Mechanism(
        speed=float(random.uniform(10.0, 200.0)),
        slider_mass=float(random.uniform(0.2, 5.0)),
        crank=RigidLink(mass=float(random.uniform(0.0, 1.0)), inertia=float(random.choice([0.0, 0.1, 10.0]))),
        rod=RigidLink(mass=float(random.uniform(0.0, 2.0))),
        speed_profile=profile,
    )
    crank = float(random.uniform(0.02, 0.08))
    linkage = Linkage(crank, crank * float(random.uniform(1.2, 5.0)), 0.0)
    named: Any = dict(motor.numbers(machine, linkage))
    if profile is not None:
        named |= uneven_speed.numbers(machine, linkage)
    angles = {key: angle for key, angle in named.items() if key.endswith("_angle_deg") and angle is not None}
    for end in curve_extremes(machine, linkage):
        for side in (end.least, end.greatest):
            if not math.isnan(side.crank_angle):
                angles[f"{end.name} {side.value}"] = math.degrees(side.crank_angle)
    assert len(angles) > 4
    for key, angle in angles.items():
        assert 0.0 <= round(angle, 2) < 360.0, (key, angle)
    inertia = named["least_reflected_inertia_angle_deg"]
    assert inertia == pytest.approx(0.0, abs=1e-3) or inertia < 180.0 - 1e-3  # dead centres at 0 and 180 deg are alike


def test_an_angle_before_zero_is_zero_where_equal_values_reach_it() -> None:
    # cos(t + d) differs from its greatest value by d^2 / 2 at zero: less than 1e-9 for d below 4.5e-5 rad.
    for before, expected in ((4e-5, 0.0), (2e-4, TURN - 2e-4)):
        assert wrap_into_cycle(TURN - before, TURN) == pytest.approx(expected, abs=1e-12)
    assert f"{math.degrees(wrap_into_cycle(TURN - 9.9e-5, TURN)):.2f}" == "0.00"
    assert f"{math.degrees(wrap_into_cycle(TURN - 1.1e-4, TURN)):.2f}" == "359.99"
