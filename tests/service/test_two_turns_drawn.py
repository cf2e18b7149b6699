"""Figures of a cycle of two turns: every curve from 0 to 720 deg, as the model has it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.loads.engine import FourStroke
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.service.figures.datasheet import cycle_curves
from slidercrank.service.figures.panel_figure import PanelFigure, sampled_crank_angles
from slidercrank.service.questions.cylinders import analysis as cylinders
from slidercrank.service.questions.extremes import analysis as extremes
from slidercrank.service.questions.friction import analysis as friction
from slidercrank.service.questions.indicator import analysis as indicator
from slidercrank.service.questions.motor import analysis as motor
from slidercrank.service.questions.static_forces import analysis as static_forces
from slidercrank.service.questions.uneven_speed import analysis as uneven_speed

LINKAGE = Linkage(0.043, 0.15, 0.005)
ENGINE = FourStroke(
    bore=0.086,
    low=0.9e5,
    high=60e5,
    exhaust=1.1e5,
    clearance=1.0 / 9.0,
    compression_exponent=1.3,
    expansion_exponent=1.3,
)
MACHINE = Mechanism(speed=300.0, slider_mass=0.5, loads=(ENGINE,))
ROWS = Arrangement(phases=(0.0, math.pi, 3.0 * math.pi, 2.0 * math.pi), places=(0.0, 0.1, 0.2, 0.3))


@pytest.mark.parametrize(
    ("figure", "machine"),
    [
        (extremes.figure, MACHINE),
        (motor.figure, MACHINE),
        (static_forces.figure, MACHINE),
        (friction.figure, Mechanism(speed=300.0, slider_mass=0.5, loads=(ENGINE,), friction=Friction(guide=0.05))),
        (uneven_speed.figure, Mechanism(speed=300.0, loads=(ENGINE,), speed_profile=Harmonics(cosines=(0.02,)))),
        (cylinders.figure, Mechanism(speed=300.0, slider_mass=0.5, loads=(ENGINE,), arrangement=ROWS)),
        (indicator.figure, MACHINE),
    ],
    ids=["extremes", "motor", "static_forces", "friction", "uneven_speed", "cylinders", "indicator"],
)
def test_every_topic_draws_both_turns(figure: Callable[[Mechanism, Linkage], PanelFigure], machine: Mechanism) -> None:
    panels = [panel for panel in figure(machine, LINKAGE).panels if panel.turns]
    assert panels
    for panel in panels:
        for line in panel.lines:
            if not line.points:
                assert (line.x.min(), line.x.max()) == (0.0, 720.0)


def test_the_sheet_of_a_design_has_the_torque_of_both_turns_and_its_peak_in_the_second() -> None:
    found = cycle_curves(MACHINE, LINKAGE)
    assert (found.angles[0], found.angles[-1], found.last_turn_end) == (0.0, 720.0, 720.0)
    torque, peak = found.panels[0].lines
    assert peak.x[0] > 360.0
    wanted = cycle(MACHINE, LINKAGE, np.radians(found.angles)).torque
    assert np.abs(torque.y - wanted).max() <= 1e-9 * np.abs(wanted).max()
    assert cycle_curves(Mechanism(speed=300.0, slider_mass=0.5), LINKAGE).last_turn_end == 360.0


def test_the_indicator_has_no_spike_where_the_turns_meet() -> None:
    """Beside the marked dead centres the pressure is that of one of the strokes that meet there."""
    (line,) = indicator.figure(MACHINE, LINKAGE).panels[1].lines
    bottom = math.degrees(LINKAGE.dead_centre_angles[0])
    near = np.abs(line.x - bottom) < 1e-4
    assert near.sum() >= 2
    assert line.y[near] == pytest.approx(0.9e5, rel=1e-6)  # intake, then compression
    near = np.abs(line.x - bottom - 360.0) < 1e-4
    assert line.y[near] == pytest.approx([60.0e5 / 10.0**1.3, 1.1e5], rel=1e-6)


def test_what_is_marked_on_a_turn_is_marked_on_both() -> None:
    angles = sampled_crank_angles([0.3], turns=2)
    for place in (0.3, 0.3 + 2.0 * math.pi):
        assert (np.abs(angles - place) < 2e-9).sum() == 2
    assert angles[-1] == pytest.approx(4.0 * math.pi)
    assert np.array_equal(sampled_crank_angles([0.3]), sampled_crank_angles([0.3], turns=1))
