"""The topic of extremes: numbers, text, figure and command line."""

from __future__ import annotations

import io
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.objectives.tables.curve_extremes import curve_extremes
from slidercrank.service.figures.datasheet import cycle_curves as curves_of_figure
from slidercrank.service.figures.panel_drawing import draw_panel_figure
from slidercrank.service.questions.discovery import TOPICS
from slidercrank.service.questions.extremes import analysis as extremes
from slidercrank.service.render.formatting import format_text
from slidercrank.service.render.terminal import print_blocks
from slidercrank.service.runs.result import json_text
from tests.model.cases import linkage_of, random_designs, random_machine
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.test_figures import overlaps

LINKAGE = Linkage(0.14, 0.31, 0.06)
LOCKED = replace(fronts.MACHINE, friction=Friction(guide=1.5))
SIEVE = ("--crank", "140 mm", "--rod", "310 mm", "--offset", "60 mm")
MACHINES = {"loaded": fronts.MACHINE, "locked": LOCKED, "bare": Mechanism(), "moving": Mechanism(speed=-3.0)}


def printed_text(numbers: Any) -> str:
    stream = io.StringIO()
    print_blocks(Console(file=stream, width=140), extremes.blocks(numbers))
    return stream.getvalue()


def test_numbers_are_the_extremes_in_the_units_of_the_cycle_table() -> None:
    curves: Any = extremes.numbers(fronts.MACHINE, LINKAGE)["curves"]
    found = {extreme.name: extreme for extreme in curve_extremes(fronts.MACHINE, LINKAGE)}
    assert list(curves) == list(found)
    assert curves["slider_position"]["greatest_mm"] == 1e3 * found["slider_position"].greatest.value
    assert curves["torque"]["least_Nm"] == found["torque"].least.value
    torque = curves["torque"]
    angle = math.radians(torque["least_at_crank_angle_deg"])
    assert torque["least_at_slider_position_mm"] == pytest.approx(1e3 * float(LINKAGE.at(angle).slider_position))


@pytest.mark.parametrize("name", MACHINES)
def test_numbers_are_fit_for_json_and_can_be_shown(name: str) -> None:
    numbers: Any = extremes.numbers(MACHINES[name], LINKAGE)
    assert json.loads(json_text(numbers)) == numbers
    text = printed_text(numbers)
    assert "nan" not in text
    assert ("undefined" in text) == (name == "locked")
    assert ("drive torque" in text) == (name in ("loaded", "locked"))
    assert ("slider velocity" in text) == (name != "bare")


def test_what_friction_leaves_undetermined_is_none() -> None:
    curves: Any = extremes.numbers(LOCKED, LINKAGE)["curves"]
    assert curves["torque"]["least_Nm"] is None
    assert curves["torque"]["greatest_at_crank_angle_deg"] is None
    assert curves["slider_velocity"]["greatest_m_s"] > 0.0


def test_strokes_last_as_the_time_ratio_says() -> None:
    random = np.random.default_rng(31)
    for design in random_designs(20, seed=31):
        machine = random_machine(random, loads=False)
        linkage = linkage_of(design, machine.branch)
        strokes: Any = extremes.numbers(machine, linkage)["strokes"]
        out, back = strokes["outward"], strokes["inward"]
        assert out["duration_s"] + back["duration_s"] == pytest.approx(2.0 * math.pi / abs(machine.speed), rel=1e-12)
        assert out["crank_angle_deg"] + back["crank_angle_deg"] == pytest.approx(360.0, rel=1e-12)
        slow = str(linkage.slow_stroke(direction=machine.speed))
        ratio = strokes["duration_ratio"]
        assert (ratio if slow == "outward" else 1.0 / ratio) == pytest.approx(float(linkage.time_ratio), rel=1e-9)
        assert strokes["duration_difference_s"] == pytest.approx(out["duration_s"] - back["duration_s"], rel=1e-12)


def test_greatest_speeds_of_the_strokes_are_those_of_a_sweep() -> None:
    random = np.random.default_rng(32)
    theta = np.linspace(0.0, 2.0 * math.pi, 200_000, endpoint=False)
    for design in random_designs(10, seed=32):
        machine = random_machine(random, loads=False)
        linkage = linkage_of(design, machine.branch)
        outward = linkage.sign * linkage.at(theta, speed=machine.speed).slider_velocity
        strokes: Any = extremes.numbers(machine, linkage)["strokes"]
        fast, back = (strokes[name]["greatest_speed_m_s"] for name in ("outward", "inward"))
        assert (fast, back) == pytest.approx((outward.max(), -outward.min()), rel=1e-6)
        assert strokes["greatest_speed_ratio"] == pytest.approx(fast / back, rel=1e-12)
        assert strokes["greatest_speed_difference_m_s"] == pytest.approx(fast - back, rel=1e-12)
        angle = math.radians(strokes["inward"]["greatest_speed_at_crank_angle_deg"])
        at = linkage.at(angle, speed=machine.speed)
        assert -linkage.sign * at.slider_velocity == pytest.approx(back, rel=1e-12)
        place = strokes["inward"]["greatest_speed_at_slider_position_mm"]
        assert place == pytest.approx(1e3 * float(at.slider_position), rel=1e-9)


@pytest.mark.parametrize("speed", [-5.0, 5.0])
def test_strokes_without_offset_are_equal(speed: float) -> None:
    strokes: Any = extremes.numbers(Mechanism(speed=speed), Linkage(0.05, 0.15))["strokes"]
    assert strokes["duration_ratio"] == pytest.approx(1.0, rel=1e-14)
    assert strokes["greatest_speed_ratio"] == pytest.approx(1.0, rel=1e-12)
    assert strokes["greatest_speed_difference_m_s"] == pytest.approx(0.0, abs=1e-12)


def test_without_a_speed_strokes_have_no_durations() -> None:
    strokes: Any = extremes.numbers(Mechanism(), LINKAGE)["strokes"]
    assert list(strokes["outward"]) == ["crank_angle_deg"]
    assert list(strokes) == ["outward", "inward", "angle_ratio", "duration_ratio"]


def test_the_command_line_tells_and_sends_extremes(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    done = command("analyse", job, *SIEVE, "--show", "extremes", "--json")
    assert done.exit_code == 0, done.stderr
    row = json.loads(done.stdout)
    curves = row["extremes"]["curves"]
    torque = curves["torque"]
    assert max(-torque["least_Nm"], torque["greatest_Nm"]) == pytest.approx(row["peak_torque_Nm"], rel=1e-9)
    inner, outer = curves["slider_position"]["least_mm"], curves["slider_position"]["greatest_mm"]
    assert outer - inner == pytest.approx(row["stroke_mm"], rel=1e-12)
    assert "load" not in curves  # the job has none
    shown = command("analyse", job, *SIEVE, "--show", "extremes").stdout
    assert "ratio of greatest speeds" in shown
    assert f"{torque['greatest_Nm']:.6g}" in shown


def test_extremes_are_sent_in_inches_without_a_job(command: Command) -> None:
    arguments = ("analyse", *SIEVE, "--speed", "60 rpm", "--show", "extremes", "--json")
    metric, inch = (
        json.loads(command(*arguments, "--units", units).stdout)["extremes"] for units in ("metric", "inch")
    )
    one, other = metric["curves"]["slider_velocity"], inch["curves"]["slider_velocity"]
    assert other["greatest_in_s"] == pytest.approx(one["greatest_m_s"] / 0.0254, rel=1e-12)
    assert other["least_at_slider_position_in"] == pytest.approx(one["least_at_slider_position_mm"] / 25.4, rel=1e-12)
    assert inch["curves"]["slider_jerk"]["least_in_s3"] == pytest.approx(
        metric["curves"]["slider_jerk"]["least_m_s3"] / 0.0254, rel=1e-12
    )
    speed = metric["strokes"]["outward"]["greatest_speed_m_s"]
    assert inch["strokes"]["outward"]["greatest_speed_in_s"] == pytest.approx(speed / 0.0254, rel=1e-12)


@pytest.mark.parametrize(("name", "count"), [("loaded", 6), ("locked", 6), ("bare", 1), ("moving", 3)])
def test_panels_mark_the_extremes_on_their_curves(name: str, count: int, tmp_path: Path) -> None:
    sheet = extremes.figure(MACHINES[name], LINKAGE)
    assert len(sheet.panels) == count
    for panel in sheet.panels:
        curve, *marks = panel.lines
        for mark in marks:
            assert len(mark.x) == 2
            assert mark.y == pytest.approx([np.nanmin(curve.y), np.nanmax(curve.y)], rel=1e-6, abs=1e-6)
            # A degree in ten million: the sampled angles have those of the marks on both sides.
            distances = np.abs(curve.x[:, None] - mark.x[None, :]).min(axis=0)
            assert np.all(distances < 1e-7)
        assert bool(marks) != ("undefined" in format_text(panel.note))
    assert overlaps(draw_panel_figure(sheet)) == []
    file = TOPICS["extremes"].bind_to_design(MACHINES[name], LINKAGE).draw(tmp_path)
    assert file.read_bytes().startswith(b"\x89PNG")


def test_durations_of_strokes_are_those_along_the_speed_profile() -> None:
    """By counting the time of small steps; the crank angles of the strokes stay those of the linkage."""
    for speed, branch in ((5.0, "open"), (-5.0, "open"), (5.0, "crossed")):
        plain = Mechanism(speed=speed, branch=branch)  # type: ignore[arg-type]
        machine = replace(plain, speed_profile=Harmonics(sines=(0.5,)))
        linkage = Linkage(0.14, 0.31, 0.06, plain.branch)
        ends = math.copysign(2.0 * math.pi, speed) * np.linspace(0.0, 1.0, 400_001)
        middle = 0.5 * (ends[1:] + ends[:-1])
        time = np.abs(np.diff(ends)) / (5.0 * (1.0 + 0.5 * np.sin(middle)))
        out = np.diff(np.abs(linkage.at(ends).slider_position)) > 0.0
        strokes, even = (extremes.numbers(each, linkage)["strokes"] for each in (machine, plain))
        for name, own in (("outward", out), ("inward", ~out)):
            assert strokes[name]["duration_s"] == pytest.approx(time[own].sum(), rel=1e-4)
            assert strokes[name]["crank_angle_deg"] == even[name]["crank_angle_deg"]
        assert strokes["angle_ratio"] == even["angle_ratio"]
        assert strokes["duration_ratio"] == pytest.approx(time[out].sum() / time[~out].sum(), rel=1e-4)
        assert even["duration_ratio"] == pytest.approx(even["angle_ratio"], rel=1e-13)
        # The figure of the design shades the stroke that takes longer, here the one of the smaller crank angle or not.
        drawn = curves_of_figure(machine, linkage)
        (span, *rest) = drawn.panels[0].shaded
        low, high = np.radians(span)
        inside = (np.mod(middle, 2.0 * math.pi) > low) & (np.mod(middle, 2.0 * math.pi) < high)
        slow = out if time[out].sum() > time[~out].sum() else ~out
        assert np.mean(slow[inside]) > 0.999
        assert len(rest) <= 1


def test_several_cylinders_along_a_profile_have_no_one_duration() -> None:
    both = Mechanism(speed=5.0, speed_profile=Harmonics(sines=(0.5,)), arrangement=Arrangement(phases=(0.0, 2.0)))
    numbers: Any = extremes.numbers(both, LINKAGE)
    assert numbers["strokes"]["duration_ratio"] is None
    assert numbers["strokes"]["outward"]["duration_s"] is None
    assert "ratio of durations" not in printed_text(numbers)
    assert json.loads(json_text(numbers)) == numbers
