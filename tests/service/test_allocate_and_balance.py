"""`slidercrank allocate` and `slidercrank balance`: numbers and figures are those of the model, errors are clear."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread

from slidercrank.model.cycle.multi_cylinder import shaking_curves
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Counterweight
from slidercrank.model.machine.mechanism import Window
from slidercrank.model.tolerance.exact_worst_case import first_order_position_errors
from slidercrank.optimise.job import load_job
from slidercrank.optimise.sizing.counterweight import RodSpace, best_balance
from slidercrank.optimise.sizing.input_words import Kind
from slidercrank.optimise.sizing.tolerance_allocation import allocate_tolerances
from slidercrank.service.figures.panel_drawing import draw_panel_figure
from slidercrank.service.questions.allocate.figure import allocation_curves, allocation_figure
from slidercrank.service.questions.counterweight import analysis as counterweight
from tests.service.conftest import Command
from tests.service.test_figures import overlaps

JOB = """
name = "Sieve"
[mechanism]
speed = "300 rpm"
crank = { width = "30 mm", depth = "20 mm", density = "7800 kg/m^3" }
rod = { width = "30 mm", depth = "20 mm", density = "7800 kg/m^3" }
slider = { mass = "1.95 kg" }
[tolerances]
crank = "0.05 mm"
rod = "0.1 mm"
offset = "0.1 mm"
crank_angle = "0.1 deg"
clearances = { crank_pin = "0.01 mm" }
[costs]
crank = { cost = 8.0, at = "0.05 mm", fixed = 5.0 }
rod = { cost = 6.0, at = "0.1 mm", max = "0.04 mm" }
crank_angle = { cost = 10.0, at = "0.1 deg", exponent = 2.0 }
[variables]
crank = "140 mm"
rod = "310 mm"
offset = ["40 mm", "80 mm"]
[objectives]
peak_torque = "minimise"
"""
LINKAGE = Linkage(0.14, 0.31, 0.06)
ALLOCATE = ("--offset", "60 mm", "--limit", "0.3 mm")
ROD = ("--rod-radius", "60 mm", "--rod-mass", "2 kg")


@pytest.fixture
def job(tmp_path: Path) -> Path:
    file = tmp_path / "job.toml"
    file.write_text(JOB)
    return file


def test_help_names_both(command: Command) -> None:
    for name in ("allocate", "balance"):
        assert f"  {name} " in command("--help").stdout
        assert command(name, "--help").exit_code == 0


@pytest.mark.parametrize("arguments", [("allocate", *ALLOCATE), ("balance", "--offset", "60 mm", *ROD)])
def test_what_may_vary_has_the_value_that_the_job_gives(
    job: Path, command: Command, arguments: tuple[str, ...]
) -> None:
    name, *options = arguments
    held = command(name, job, *options, "--json")
    more = """mechanism.rod.width = ["10 mm", "80 mm"]
mechanism.slider.mass = ["0.5 kg", "5 kg"]
tolerances.offset = ["0.01 mm", "0.3 mm"]
mechanism.speed = { choices = ["200 rpm", "250 rpm"] }
"""
    text = job.read_text()
    job.write_text(text.replace("[objectives]", f"{more}[objectives]"))
    assert len(load_job(job).mechanism.varying) == 3
    done = command(name, job, *options, "--json")
    assert done.exit_code == held.exit_code == 0, done.stderr
    assert done.stdout == held.stdout
    text = job.read_text()
    job.write_text(text.replace('offset = "0.1 mm"', 'offset = "0.2 mm"').replace("1.95 kg", "3 kg"))
    other = command(name, job, *options, "--json")
    assert other.exit_code == 0, other.stderr
    assert other.stdout != held.stdout


def test_allocation_is_that_of_the_model(job: Path, command: Command) -> None:
    done = command("allocate", job, *ALLOCATE, "--kind", "rss", "--json")
    assert done.exit_code == 0, done.stderr
    numbers, problem = json.loads(done.stdout), load_job(job)
    assert problem.costs is not None
    found = allocate_tolerances(LINKAGE, problem.costs, 3e-4, "rss", mechanism=problem.mechanism)
    assert numbers["cost"] == pytest.approx(found.cost, rel=1e-12)
    assert numbers["error_mm"] == pytest.approx(0.3, rel=1e-10)
    assert numbers["saving_per_um"] == pytest.approx(1e-6 * found.saving, rel=1e-12)
    assert sum(row["cost"] for row in numbers["tolerances"]) == pytest.approx(numbers["cost"], rel=1e-12)
    assert [row["name"] for row in numbers["tolerances"]] == ["crank", "rod", "crank_angle"]
    by_name = {row["name"]: row for row in numbers["tolerances"]}
    assert by_name["rod"]["bound"] == "greatest"
    assert by_name["rod"]["tolerance_mm"] == pytest.approx(0.04, rel=1e-12)
    assert by_name["rod"]["bound_saving_per_um"] > 0.0
    assert by_name["crank_angle"]["tolerance_deg"] == pytest.approx(np.degrees(found.parts[2].tolerance), rel=1e-12)
    before = first_order_position_errors(problem.mechanism, LINKAGE, np.linspace(0.0, 2.0 * np.pi, 2000))
    assert numbers["error_before_mm"] == pytest.approx(1e3 * before.root_sum_square.max(), rel=1e-5)
    assert numbers["cost_before"] == pytest.approx(8.0 + 5.0 + 6.0 + 10.0, rel=1e-12)


def test_balance_is_that_of_the_model(job: Path, command: Command) -> None:
    done = command("balance", job, "--offset", "60 mm", "--radius", "80 mm", "--mass", "6 kg", "--json")
    assert done.exit_code == 0, done.stderr
    numbers, mechanism = json.loads(done.stdout), load_job(job).mechanism
    found = best_balance(mechanism, LINKAGE, radius=0.08, greatest_moment=0.48)
    assert numbers["counterweight_moment_kg_m"] == pytest.approx(found.moment, rel=1e-9)
    assert numbers["counterweight_kg"] == pytest.approx(found.moment / 0.08, rel=1e-9)
    weight = Counterweight(
        mass=numbers["counterweight_kg"], radius=0.08, angle=np.radians(numbers["counterweight_angle_deg"])
    )
    theta = np.linspace(0.0, 2.0 * np.pi, 5000)
    for key, machine in (("before", mechanism), ("after", dataclasses.replace(mechanism, counterweight=weight))):
        curves = shaking_curves(machine, LINKAGE, theta)
        peak = np.hypot(curves.force_x, curves.force_y).max()
        assert numbers[key]["peak_shaking_force_N"] == pytest.approx(peak, rel=1e-5)
    assert numbers["after"]["peak_shaking_force_N"] < 0.5 * numbers["before"]["peak_shaking_force_N"]
    assert numbers["rod_balance"] is None


def test_what_is_found_is_shown_and_drawn(job: Path, tmp_path: Path, command: Command) -> None:
    done = command("allocate", job, *ALLOCATE, "--kind", "RSS", "--figures", tmp_path / "figures")
    assert done.exit_code == 0, done.stderr
    for words in ("0.04 mm", "the greatest bound", "raising it by 1 µm saves", "in the job: cost 29"):
        assert words in done.stdout
    done = command("balance", job, "--offset", "60 mm", *ROD, "--measure", "rms", "--figures", tmp_path / "figures")
    assert done.exit_code == 0, done.stderr
    for words in ("added to the rod", "before", "in the job: counterweight = { mass ="):
        assert words in done.stdout
    for name in ("allocation", "balance"):
        assert imread(tmp_path / "figures" / f"{name}.png").shape[1] > 800


def test_the_counterweight_that_is_shown_can_be_put_into_the_job(job: Path, command: Command) -> None:
    shown = command("balance", job, "--offset", "60 mm").stdout
    line = next(line for line in shown.splitlines() if "in the job: " in line).split("in the job: ")[1]
    before = command("balance", job, "--offset", "60 mm", "--json").stdout
    job.write_text(JOB.replace("[tolerances]", f"{line}\n[tolerances]"))
    numbers = json.loads(command("balance", job, "--offset", "60 mm", "--json").stdout)
    assert numbers["before"]["peak_shaking_force_N"] == pytest.approx(
        json.loads(before)["after"]["peak_shaking_force_N"], rel=1e-4
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("allocate", "--offset", "60 mm", "--limit", "0.1"), "--limit must be a length with its unit"),
        (("allocate", "--limit", "0.1 mm"), "--offset is needed"),
        (("allocate", *ALLOCATE, "--kind", "average"), "kind must be 'worst case' or 'rss'"),
        (("balance", "--offset", "60 mm", "--rod-mass", "2 kg"), "got only --rod-mass; add --rod-radius"),
        (("balance", "--offset", "60 mm", "--arm", "0.5 m"), "without a rod balance"),
        (("balance", "--offset", "60 mm", "--measure", "mean"), "measure must be"),
        (("balance", "--offset", "60 mm", "--mass", "2 mm"), "--mass must be a mass"),
    ],
)
def test_wrong_values_are_exit_code_2(arguments: tuple[str, ...], words: str, job: Path, command: Command) -> None:
    name, *rest = arguments
    done = command(name, job, *rest)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr


def test_a_limit_below_the_least_tolerances_is_infeasible(job: Path, command: Command) -> None:
    done = command("allocate", job, "--offset", "60 mm", "--limit", "0.001 mm", "--json")
    assert done.exit_code == 3
    assert "the limit must exceed the position error" in done.stderr
    assert json.loads(done.stdout)["status"] == "infeasible"


def test_a_job_without_costs_has_no_allocation(job: Path, command: Command) -> None:
    text = job.read_text()
    job.write_text(text[: text.index("[costs]")] + text[text.index("[variables]") :])
    done = command("allocate", job, *ALLOCATE)
    assert (done.exit_code, done.stdout) == (2, "")
    assert "this job has no [costs]; for example, add" in done.stderr


def test_check_says_what_the_tolerances_cost(job: Path, command: Command) -> None:
    shown = command("check", job).stdout
    assert "costs         crank 5 + 8 (0.05 mm / tolerance)" in shown
    assert "rod 6 (0.1 mm / tolerance), at most 0.04 mm" in shown
    assert "crank angle 10 (0.1 deg / tolerance)^2" in shown


@pytest.mark.parametrize("kind", ["worst case", "rss"])
def test_the_figure_of_an_allocation_draws_what_the_model_gives(kind: Kind, job: Path) -> None:
    problem = load_job(job)
    assert problem.costs is not None
    window = Window(during="inward stroke", start=0.2, end=0.9)
    tolerances = dataclasses.replace(problem.mechanism.tolerances, window=window)
    mechanism = dataclasses.replace(problem.mechanism, tolerances=tolerances)
    found = allocate_tolerances(LINKAGE, problem.costs, 3e-4, kind, mechanism=mechanism)
    data = allocation_curves(found, LINKAGE, problem.costs, mechanism)
    theta = np.radians(data.angles)
    now, before = (first_order_position_errors(each, LINKAGE, theta) for each in (found.mechanism, mechanism))
    errors = [each.worst_case if kind == "worst case" else each.root_sum_square for each in (now, before)]
    np.testing.assert_allclose(data.parts.sum(axis=0), errors[0], rtol=1e-9)
    assert data.error_before is not None
    np.testing.assert_allclose(data.error_before, errors[1], rtol=1e-9)
    assert data.sources == ("crank", "rod", "offset", "crank angle", "crank pin clearance")
    (span,) = data.counted
    fractions = (LINKAGE.at(np.radians(span)).slider_position - LINKAGE.dead_centres[0]) / LINKAGE.stroke
    np.testing.assert_allclose(sorted(fractions), [0.2, 0.9], rtol=1e-9)
    figure = allocation_figure(data)
    error, cost = figure.axes
    lines: list[Any] = list(error.lines)
    np.testing.assert_allclose(lines[0].get_ydata(), 1e3 * data.error_before)
    np.testing.assert_array_equal(lines[2].get_xdata(), np.degrees(found.angles))
    widths = [bar.get_width() for bar in cost.patches]  # type: ignore[attr-defined]
    np.testing.assert_allclose(widths, [*(part.cost for part in found.parts), 13.0, 6.0, 10.0], rtol=1e-12)
    assert overlaps(figure) == []
    inch = allocation_figure(data, "inch")
    np.testing.assert_allclose(np.asarray(inch.axes[0].lines[0].get_ydata()), data.error_before / 0.0254)
    assert inch.axes[0].get_ylabel() == "position error, in"


@pytest.mark.parametrize("space", [None, RodSpace(radius=0.06, mass=2.0)])
def test_the_figure_of_a_balance_draws_what_the_model_gives(space: RodSpace | None, job: Path) -> None:
    problem = load_job(job)
    mechanism = problem.mechanism
    found = best_balance(mechanism, LINKAGE, rod=space)
    sheet = counterweight.figure(mechanism, LINKAGE, optimum=found, problem=problem)
    assert len(sheet.panels) == (2 if space is None else 3)
    theta = np.radians(sheet.panels[1].lines[0].x)
    for n, machine in enumerate((mechanism, found.balanced)):
        curves = shaking_curves(machine, LINKAGE, theta)
        size = np.abs(curves.force_x).max()
        np.testing.assert_allclose(sheet.panels[0].lines[n].x, curves.force_x, rtol=0, atol=1e-9 * size)
        np.testing.assert_allclose(sheet.panels[0].lines[n].y, curves.force_y, rtol=0, atol=1e-9 * size)
        expected = np.hypot(curves.force_x, curves.force_y)
        np.testing.assert_allclose(sheet.panels[1].lines[n].y, expected, rtol=0, atol=1e-9 * size)
        if space is not None:
            np.testing.assert_allclose(sheet.panels[2].lines[n].y, curves.moment, rtol=0, atol=1e-9 * size)
    assert sheet.panels[1].lines[1].y.max() == pytest.approx(found.shaking_after.peak_force, rel=1e-4)
    assert overlaps(draw_panel_figure(sheet)) == []
