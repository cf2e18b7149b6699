"""Numbers, text and figures of a loose joint: they are those of the simulation."""

from __future__ import annotations

import io
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from slidercrank.model.clearance.run import ClearanceRun
from slidercrank.model.clearance.statistics import clearance_statistics
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Clearance
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.kinds import ACCELERATION, LENGTH, SPEED
from slidercrank.service.figures.panel_drawing import draw_figure
from slidercrank.service.figures.style import figure_bytes
from slidercrank.service.questions.clearance.analysis import blocks, figure, numbers, run_simulation
from slidercrank.service.questions.clearance.figure import loose_joint_curves, speed_runs, speeds_figure
from slidercrank.service.render.terminal import print_blocks

BAR = Bar(width=0.03, depth=0.02, density=7800.0)
LINKAGE = Linkage(0.14, 0.31, -0.06)
# A soft contact, which vibrates slowly and is simulated quickly.
MACHINE = Mechanism(
    speed=10.0 * math.pi,
    crank=BAR,
    rod=BAR,
    slider_mass=1.95,
    clearance=Clearance(joint="crank pin", radius=1e-3, journal_radius=0.01, stiffness=1e8),
)


@pytest.fixture(scope="module")
def run() -> ClearanceRun:
    return run_simulation(MACHINE, LINKAGE, cycles=4, discard=1)


def text_of(found: dict[str, object]) -> str:
    console = Console(file=io.StringIO(), width=100)
    print_blocks(console, blocks(found))
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def test_numbers_are_those_of_the_summary(run: ClearanceRun) -> None:
    found, summary = numbers(MACHINE, LINKAGE, run=run), clearance_statistics(run)
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    assert (found["joint"], found["radial_clearance_mm"], found["status"]) == ("crank pin", 1.0, "done")
    assert (found["turns"], found["turns_discarded"]) == (3, 1)
    assert found["peak_acceleration_m_s2"] == summary.peak_acceleration.value
    assert found["peak_acceleration_uncertainty_m_s2"] == summary.peak_acceleration.uncertainty
    assert found["peak_acceleration_ratio"] == summary.acceleration_ratio.value
    assert found["displacement_deviation_percent"] == pytest.approx(100.0 * summary.displacement_deviation.value)
    assert found["contact_share_percent"] == pytest.approx(100.0 * summary.contact_share.value)
    assert found["penetration_mm"] == pytest.approx(1e3 * summary.penetration.value)
    assert found["impacts_per_turn"] == summary.impacts.value
    assert found["dissipated_J"] == summary.dissipated.value


def test_peaks_of_the_summary_are_peaks_of_the_motion(run: ClearanceRun) -> None:
    """Turn by turn, with the ideal peak from a dense sweep of the ideal acceleration."""
    turn = np.floor(run.times / run.turn_time * (1.0 + 1e-12))
    peaks = [np.abs(run.slider_acceleration[turn == k]).max() for k in (1, 2, 3)]
    summary = clearance_statistics(run)
    assert summary.peak_acceleration.value == pytest.approx(np.mean(peaks), rel=1e-12)
    sweep = LINKAGE.at(np.linspace(0.0, 2.0 * math.pi, 20001), speed=MACHINE.speed)
    ideal = np.abs(sweep.slider_acceleration).max()
    assert summary.acceleration_ratio.value == pytest.approx(np.mean(peaks) / ideal, rel=1e-6)
    impacts = np.count_nonzero(run.impact_times > run.turn_time) / 3.0
    assert summary.impacts.value == pytest.approx(impacts)
    touching = np.sum(np.diff(run.times) * run.in_contact[:-1] * (run.times[:-1] >= run.turn_time)) / (
        3.0 * run.turn_time
    )
    assert summary.contact_share.value == pytest.approx(touching, abs=1e-3)


def test_text_says_the_joint_and_the_numbers_with_their_uncertainty(run: ClearanceRun) -> None:
    text = text_of(numbers(MACHINE, LINKAGE, run=run))
    assert "1 mm at the crank pin" in text
    assert "peak slider acceleration" in text
    assert "±" in text
    assert "3 turns, after 1" in text
    assert "loads" not in text
    assert len(text.splitlines()) < 20


def test_a_run_cancelled_early_has_no_statistics() -> None:
    found = numbers(MACHINE, LINKAGE, cancelled=lambda: True)
    assert (found["status"], found["turns"]) == ("cancelled", 0)
    assert found["peak_acceleration_m_s2"] is None
    assert found["energy_residual_J"] is None
    assert "cancelled" in text_of(found)


def test_ideal_joints_are_refused() -> None:
    ideal = replace(MACHINE, clearance=None)
    with pytest.raises(
        InputError,
        match=r"needs a joint with clearance; all joints of this job are ideal; for example, add .* \[clearance\]",
    ):
        numbers(ideal, LINKAGE)
    with pytest.raises(InputError, match="needs a joint with clearance; all joints are ideal"):
        speed_runs(ideal, LINKAGE)


def test_curves_are_the_last_turn_of_the_motion(run: ClearanceRun) -> None:
    curves = loose_joint_curves(run)
    assert (curves.angles[0], curves.angles[-1]) == pytest.approx((0.0, 360.0), abs=1e-9)
    last = run.times >= 3.0 * run.turn_time * (1.0 - 1e-12)
    np.testing.assert_allclose(curves.curves[LENGTH], run.slider_position[last])
    np.testing.assert_allclose(curves.curves[SPEED], run.slider_velocity[last])
    np.testing.assert_allclose(curves.curves[ACCELERATION], run.slider_acceleration[last])
    ideal = LINKAGE.at(np.radians(curves.angles), speed=MACHINE.speed)
    for title, values in zip(
        curves.ideal,
        (ideal.slider_position, ideal.slider_velocity, ideal.slider_acceleration),
        strict=True,
    ):
        np.testing.assert_allclose(curves.ideal[title], values, atol=1e-9 * np.abs(values).max())
    np.testing.assert_allclose(curves.force, run.contact_force[last])
    depth = np.hypot(curves.journal_x, curves.journal_y) - 1e-3
    np.testing.assert_allclose(depth, run.penetration[last], atol=1e-15)
    assert np.all(curves.force[~curves.touching] == 0.0)


def test_figures_are_drawn(run: ClearanceRun) -> None:
    for drawn in (figure(MACHINE, LINKAGE, run=run), speeds_figure([run, run])):
        metric, inch = draw_figure(drawn), draw_figure(drawn, "inch")
        assert figure_bytes(metric, "png").startswith(b"\x89PNG")
        for before, after in zip(metric.axes, inch.axes, strict=True):
            unit = before.get_title(loc="left").rpartition(", ")[2]
            factor = {"mm": 1.0 / 25.4, "N": 1.0 / 4.4482216152605}.get(unit, 1000.0 / 25.4)  # else m/s or m/s^2
            if "journal" in before.get_title(loc="left"):
                factor = 1.0 / 25.4
            np.testing.assert_allclose(
                np.asarray(after.lines[0].get_ydata()), factor * np.asarray(before.lines[0].get_ydata()), rtol=1e-9
            )


def test_speeds_are_compared_in_the_direction_of_the_machine() -> None:
    backward = replace(MACHINE, speed=-1.0)
    (run,) = speed_runs(backward, LINKAGE, (300.0,))
    assert run.mechanism.speed == pytest.approx(-10.0 * math.pi)
    assert run.cycles == 3


def test_a_run_without_a_complete_turn_is_not_drawn() -> None:
    asked = iter([False, True])
    short = run_simulation(MACHINE, LINKAGE, cancelled=lambda: next(asked))
    with pytest.raises(InputError, match="complete turn"):
        loose_joint_curves(short)
