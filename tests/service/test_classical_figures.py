"""Figures and tables of the textbook analyses and of the published cases: their data is what the model gives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from slidercrank.model.classical.approximations import TORQUE, compare_approximations
from slidercrank.model.classical.loop_equations import motion_polygons, static_forces
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.service.cases import case_5
from slidercrank.service.cases import figures as of_cases
from slidercrank.service.cases.printed_values import read_printed_table
from slidercrank.service.figures.panel_drawing import draw_panel_figure
from slidercrank.service.figures.panel_figure import Line, Panel, PanelFigure
from slidercrank.service.questions.approximations import analysis as approximations_analysis
from slidercrank.service.questions.discovery import TOPICS
from slidercrank.service.questions.polygons import analysis as polygons_analysis
from slidercrank.service.questions.static_forces import analysis as static_analysis
from slidercrank.service.render.formatting import format_text
from slidercrank.service.render.terminal import print_blocks
from slidercrank.service.runs.result import json_text
from slidercrank.service.text.screen import console
from tests.model.virtual_work import path
from tests.service import fronts
from tests.service.test_figures import overlaps

LINKAGE = Linkage(0.14, 0.31, 0.06)
MACHINE = replace(fronts.MACHINE, rod=RigidLink(mass=1.2, centre=0.1))


def line(panel: Panel, label: str) -> Line:
    return next(line for line in panel.lines if line.label == label)


def test_polygon_panels_hold_the_vertices_of_both_branches() -> None:
    found = polygons_analysis.polygons_by_branch(LINKAGE, 0.5, speed=3.0, acceleration=2.0)
    sheet = polygons_analysis.polygon_panels(found, title="", subtitle="")
    position, velocity, acceleration = sheet.panels
    for branch in ("open", "crossed"):
        expected = motion_polygons(Linkage(0.14, 0.31, 0.06, branch), 0.5, speed=3.0, acceleration=2.0)
        np.testing.assert_allclose(line(position, branch).x, expected.position[:, 0], rtol=1e-14)
        for panel, points in ((velocity, expected.velocity), (acceleration, expected.acceleration)):
            closed = np.concatenate([points, points[:1]])
            np.testing.assert_array_equal(line(panel, branch).x, closed[:, 0])
            np.testing.assert_array_equal(line(panel, branch).y, closed[:, 1])
    names = [name for name, _, _ in acceleration.names]
    assert names == ["o1", "a11", "a1", "b11 open", "b1 open", "b11 crossed", "b1 crossed"]


@pytest.mark.parametrize("load", [None, -50.0])
def test_static_force_panels_are_those_of_the_model(load: float | None) -> None:
    forces, torque, advantage = static_analysis.figure(MACHINE, LINKAGE, load=load).panels
    theta = np.radians(line(forces, "guide").x)
    applied = line(forces, "load, outward").y
    if load is not None:
        np.testing.assert_array_equal(applied, load)
    else:
        assert set(applied) == {-200.0, 0.0}  # as the job says: in the outward stroke
    at = static_forces(LINKAGE, theta, load=applied)
    np.testing.assert_allclose(line(forces, "rod, compression").y, at.rod_force, rtol=1e-12)
    np.testing.assert_allclose(line(forces, "guide").y, at.guide_reaction, rtol=0, atol=1e-10)
    np.testing.assert_allclose(torque.lines[0].y, at.crank_torque, rtol=0, atol=1e-10)
    drawn = np.isfinite(advantage.lines[0].y)
    np.testing.assert_allclose(advantage.lines[0].y[drawn], at.mechanical_advantage[drawn], rtol=1e-9)
    assert np.all(at.mechanical_advantage[~drawn] > 9.9)


def test_static_force_numbers_are_peaks_of_the_curves() -> None:
    numbers: Any = static_analysis.numbers(MACHINE, LINKAGE, load=-50.0)
    theta = np.linspace(0.0, 2.0 * math.pi, 200_001)
    at = static_forces(LINKAGE, theta, load=-50.0)
    for key, curve in (
        ("peak_rod_force_N", at.rod_force),
        ("peak_guide_reaction_N", at.guide_reaction),
        ("peak_crank_torque_Nm", at.crank_torque),
    ):
        assert numbers[key] == pytest.approx(np.abs(curve).max(), rel=1e-8)
    assert numbers["least_mechanical_advantage"] == pytest.approx(at.mechanical_advantage.min(), rel=1e-8)
    every = static_forces(LINKAGE, np.radians(numbers["crank_angle_deg"]), load=-50.0)
    np.testing.assert_allclose(numbers["crank_torque_Nm"], every.crank_torque, rtol=0, atol=1e-12)
    assert numbers["load"] == "-50 N, constant, positive outward"


def test_static_forces_of_a_dead_centre_have_no_finite_advantage() -> None:
    numbers: Any = static_analysis.numbers(Mechanism(), Linkage(0.05, 0.15))
    assert numbers["mechanical_advantage"][0] is None
    assert numbers["mechanical_advantage"][6] is None
    assert numbers["load"].startswith("-1 N")
    assert "Infinity" not in json_text(numbers)


def test_approximation_panels_are_those_of_the_comparison() -> None:
    acceleration, torque, of_acceleration, of_torque = approximations_analysis.figure(MACHINE, LINKAGE).panels
    found = compare_approximations(MACHINE, LINKAGE, np.radians(torque.lines[0].x))
    np.testing.assert_allclose(line(acceleration, "exact").y, found.acceleration, rtol=0, atol=1e-9)
    np.testing.assert_allclose(line(acceleration, "series").y, found.accelerations["series"], rtol=0, atol=1e-9)
    np.testing.assert_allclose(line(torque, "exact").y, found.torque, rtol=0, atol=1e-9)
    for drawn, name in zip(torque.lines[1:], TORQUE, strict=True):
        np.testing.assert_allclose(drawn.y, found.torques[name], rtol=0, atol=1e-9)
    numbers: Any = approximations_analysis.numbers(MACHINE, LINKAGE)
    for panel, key in ((of_acceleration, "accelerations"), (of_torque, "torques")):
        for drawn, entry in zip(panel.lines, numbers[key], strict=True):
            np.testing.assert_allclose(drawn.y[::6], entry["error_over_offset_percent"], rtol=1e-9)
            np.testing.assert_allclose(drawn.x[::6], 1e-3 * np.abs(numbers["offset_mm"]), rtol=1e-12)


def test_errors_of_a_massless_machine_are_not_defined() -> None:
    machine = Mechanism(speed=3.0)
    numbers: Any = approximations_analysis.numbers(machine, LINKAGE)
    assert all(entry["error_percent"] is None for entry in numbers["torques"])
    assert numbers["accelerations"][0]["error_percent"] > 0.0
    assert len(approximations_analysis.figure(machine, LINKAGE).panels) == 3


def test_polygon_numbers_are_the_vertices() -> None:
    numbers: Any = polygons_analysis.numbers(MACHINE, LINKAGE, crank_angle=0.5)
    expected = motion_polygons(LINKAGE, 0.5, speed=MACHINE.speed)
    np.testing.assert_allclose(numbers["open"]["position_mm"]["B"], 1e3 * expected.position[2], rtol=1e-14)
    np.testing.assert_allclose(numbers["open"]["acceleration_m_s2"]["b11"], expected.acceleration[3], rtol=1e-14)


@pytest.mark.parametrize("analysis", [static_analysis, approximations_analysis, polygons_analysis])
def test_analyses_are_json_and_short_tables(analysis: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    numbers: Any = analysis.numbers(MACHINE, LINKAGE)
    json_text(numbers)
    print_blocks(console(), analysis.blocks(numbers))
    text = capsys.readouterr().out
    assert 8 <= len(text.splitlines()) <= 22
    assert "nan" not in text


def test_sieve_panels_are_the_motion_of_the_sieve() -> None:
    for panel, linkage in zip(
        of_cases.sensitivity_figure().panels, [(0.15, 0.31, -0.06), (0.14, 0.32, -0.06)] * 3, strict=True
    ):
        for drawn, design in zip(panel.lines, ((0.14, 0.31, -0.06), linkage), strict=True):
            at = path(np.array(design), np.radians(drawn.x), 1.0)
            speed = 10.0 * math.pi
            expected = {"position": 1e3 * at.x, "velocity": speed * at.x_1, "acceleration": speed**2 * at.x_2}
            name = format_text(panel.title).split()[1].rstrip(",")
            np.testing.assert_allclose(drawn.y, expected[name], rtol=0, atol=1e-9 * np.abs(expected[name]).max())
    at = path(np.array((0.14, 0.31, -0.06)), np.radians(of_cases.sieve_figure().panels[0].lines[0].x), 1.0)
    curves = {format_text(panel.title).partition(",")[0]: panel.lines[0].y for panel in of_cases.sieve_figure().panels}
    np.testing.assert_allclose(curves["rod angular velocity"], 10.0 * math.pi * at.rod_1, rtol=0, atol=1e-9)
    np.testing.assert_allclose(curves["rod angular acceleration"], 100.0 * math.pi**2 * at.rod_2, rtol=0, atol=1e-7)
    np.testing.assert_allclose(curves["rod angle"], np.degrees(np.arcsin(at.rod_sine)), rtol=0, atol=1e-9)


def test_in_line_panels_are_the_formulas() -> None:
    paths, _, rates, slider, forces, torque = of_cases.in_line_figure().panels
    np.testing.assert_allclose(np.hypot(line(paths, "crank pin").x, line(paths, "crank pin").y), 50.0, rtol=1e-13)
    assert (line(paths, "slider pin").x.min(), line(paths, "slider pin").x.max()) == pytest.approx((100.0, 200.0))
    theta = np.radians(torque.lines[0].x)
    rod = np.arcsin(0.05 * np.sin(theta) / 0.15)
    expected = -100.0 * 0.05 * (np.sin(theta) + np.cos(theta) * np.tan(rod))
    np.testing.assert_allclose(torque.lines[0].y, expected, rtol=0, atol=1e-11)
    np.testing.assert_allclose(line(forces, "rod, compression").y, 100.0 / np.cos(rod), rtol=1e-12)
    np.testing.assert_allclose(line(forces, "guide").y, 100.0 * np.tan(rod), rtol=0, atol=1e-10)
    np.testing.assert_allclose(line(rates, "rod").y, -0.5 * np.cos(theta) / (0.15 * np.cos(rod)), rtol=0, atol=1e-12)
    np.testing.assert_allclose(slider.lines[0].y, 10.0 * expected / 100.0, rtol=0, atol=1e-12)  # power balance


def test_position_error_panels_show_exact_and_printed_columns() -> None:
    panels = of_cases.position_error_figure().panels
    lines = read_printed_table("position_error_table1.csv")
    columns = list(lines[0])[3:]
    for panel, column in zip(panels, columns, strict=True):
        np.testing.assert_array_equal(line(panel, "printed").y, [float(row[column]) for row in lines])
    theta = np.radians(line(panels[1], "exact").x)
    at = path(np.array([1.4, 1.8, -0.05]), theta, 1.0)
    np.testing.assert_allclose(line(panels[1], "exact").y, 1.8 / at.rod_cosine, rtol=1e-12)
    parts = sum(line(panel, "exact").y for panel in panels[:4])
    np.testing.assert_allclose(line(panels[4], "exact").y, parts, rtol=1e-12)


def test_offset_panels_are_the_motion_and_virtual_work_of_the_feeder() -> None:
    acceleration, _, torque, formula, _, _ = of_cases.offset_figure().panels
    for e in (0, 10, 20):
        label = f"e = {e} mm"
        assert line(torque, label).x[-1] == pytest.approx(720.0)
        at = path(np.array([0.04, 0.064, -1e-3 * e]), np.radians(line(torque, label).x), 1.0)
        np.testing.assert_allclose(line(acceleration, label).y, 251.0**2 * at.x_2, rtol=0, atol=1e-7)
        np.testing.assert_allclose(line(torque, label).y, 1.05 * 251.0**2 * at.x_1 * at.x_2, rtol=0, atol=1e-8)
        expected = case_5.formula_torque(1e-3 * e, np.radians(line(formula, label).x))
        np.testing.assert_allclose(line(formula, label).y, expected, rtol=0, atol=1e-8)


SHEETS: dict[str, Callable[[], PanelFigure]] = {
    name: make for of_case in of_cases.FIGURES.values() for name, make in of_case.items() if name != "clearance"
} | {
    "static forces": lambda: static_analysis.figure(MACHINE, LINKAGE),
    "approximations": lambda: approximations_analysis.figure(MACHINE, LINKAGE),
    "feeder approximations": lambda: approximations_analysis.figure(case_5.MACHINE, case_5.feeder_linkage(0.02)),
}


@pytest.mark.parametrize("name", SHEETS)
def test_no_two_texts_of_a_sheet_overlap(name: str) -> None:
    sheet = SHEETS[name]()
    assert isinstance(sheet, PanelFigure)
    assert overlaps(draw_panel_figure(sheet)) == []


@pytest.mark.parametrize("name", ["polygons", "static_forces", "approximations"])
def test_figures_are_written(name: str, tmp_path: Path) -> None:
    file = TOPICS[name].bind_to_design(MACHINE, LINKAGE).draw(tmp_path)
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("offset", [0.06, -0.06])
def test_approximations_begin_at_an_offset_of_zero_without_a_sign(offset: float) -> None:
    first: Any = approximations_analysis.numbers(MACHINE, Linkage(0.14, 0.31, offset))["offset_mm"][0]
    assert f"{first:g}" == "0"
