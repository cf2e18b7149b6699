"""`slidercrank sweep`, and its figures."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.sensitivity import Axis, sweep
from slidercrank.service.questions.sweep.analysis import parse_axis
from slidercrank.service.questions.sweep.figure import sweep_figure, sweep_grid
from tests.model.cases import SMOOTH
from tests.service.conftest import Command
from tests.service.test_figures import overlaps

JOB = """
name = "Feeder"
[mechanism]
speed = "-2400 rpm"
crank = { mass = "0.2 kg" }
rod = { mass = "0.5 kg" }
slider = { mass = "0.8 kg" }
[variables]
crank = "40 mm"
rod = ["50 mm", "250 mm"]
offset = ["0 mm", "80 mm"]
[objectives]
peak_torque = "minimise"
"""
OFFSETS = Axis("offset", (0.02, 0.0, 0.01, 0.03))
RODS = Axis("rod", (0.066, 0.08, 0.1))


@pytest.fixture
def job(tmp_path: Path) -> Path:
    file = tmp_path / "feeder.toml"
    file.write_text(JOB, encoding="utf-8")
    return file


def test_json_has_a_row_for_every_value_and_none_where_there_is_no_value(command: Command, job: Path) -> None:
    arguments = ("--rod", "64 mm", "--over", "offset=0 mm..30 mm:4", "--of", "stroke,peak_torque", "--json")
    done = command("sweep", job, *arguments)
    assert done.exit_code == 0, done.output
    rows = json.loads(done.stdout)
    assert [row["offset_mm"] for row in rows] == pytest.approx([0.0, 10.0, 20.0, 30.0])
    # Obaseki and Alfred, crank 40, rod 64 mm; exact.
    assert [row["stroke_mm"] for row in rows[:3]] == pytest.approx([80.0, 81.700690, 88.792308], abs=1.01e-6)
    assert rows[3]["stroke_mm"] is rows[3]["peak_torque_Nm"] is None
    assert "rod must exceed crank + |offset|" in rows[3]["reason"]
    assert rows[0]["crank_mm"] == pytest.approx(40.0)  # fixed by the job
    assert rows[0]["speed_rpm"] == pytest.approx(-2400.0)


def test_table_has_the_values_and_says_how_many_are_missing(command: Command, job: Path) -> None:
    done = command("sweep", job, "--rod", "64 mm", "--over", "offset=0 mm..30 mm:4", "--of", "stroke")
    assert done.exit_code == 0, done.output
    assert "88.7923" in done.stdout
    assert "1 of 4 have no value; the first: rod must exceed" in done.stderr


def test_grid_of_two_is_drawn(command: Command, job: Path, tmp_path: Path) -> None:
    arguments = ("--over", "offset=0 mm, 10 mm", "--over", "speed=100 rpm..300 rpm:3", "--rod", "80 mm")
    done = command("sweep", job, *arguments, "--of", "peak_slider_speed", "--figures", tmp_path / "figures")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "figures" / "sweep.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--over", "offset"), "a sweep needs a name, two ends with units"),
        (("--over", "offset=0..20 mm:5"), "--over offset must be a length with its unit"),
        (("--over", "offset=0 mm..20 mm:1"), "2 to 10,000 values"),
        (("--over", "offset=5 mm..5 mm:3"), "two different ends"),
        (("--over", "offset=0 mm..20 rpm:3"), "--over offset must be a length"),
        (("--over", "rod=-1 mm..20 mm:3"), "--over rod must be positive"),
        (("--over", "mass=1 mm..20 mm:3"), "a sweep must be over one of crank, rod, offset, speed; got 'mass'"),
        (
            ("--over", "offset=0 mm..20 mm:3", "--offset", "3 mm"),
            "offset may be set by --over or by --offset; got both",
        ),
        (("--over", "offset=0 mm..20 mm:3", "--over", "offset=1 mm..2 mm:3"), "different parameters"),
        (("--over", "speed=0 rpm..9 rpm:3"), "--offset is needed"),
        (("--over", "offset=0 mm..1 mm:3", "--of", "torque"), "no quantity is called 'torque'"),
    ],
)
def test_wrong_input_is_named_with_exit_code_two(
    command: Command, job: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = command("sweep", job, "--rod", "64 mm", *arguments, "--of", "stroke")
    assert done.exit_code == 2
    assert message in done.stderr
    assert done.stdout == ""


def test_ranges_and_lists_are_read_into_si() -> None:
    assert parse_axis("offset = -10 mm .. 10 mm : 3") == Axis("offset", (-0.01, 0.0, 0.01))
    assert parse_axis("rod=0.08 m,0.1 m").values == pytest.approx((0.08, 0.1))
    assert parse_axis("crank=.5 inch..1.5 inch:2").values == pytest.approx((0.0127, 0.0381))
    assert parse_axis("speed=-60 rpm, 60 rpm").values == pytest.approx((-2.0 * np.pi, 2.0 * np.pi))


def test_line_figure_draws_the_values_in_order_and_nothing_where_there_are_none() -> None:
    table = sweep(SMOOTH, np.array([0.04, 0.066, 0.0]), [OFFSETS], ["peak_torque", "rod_to_offset"])
    figure = sweep_figure(
        table, [OFFSETS], [QUANTITIES[name] for name in ("peak_torque", "rod_to_offset")], title="Sieve"
    )
    for panel, field in zip(figure.axes, ("peak_torque_Nm", "rod_to_offset"), strict=True):
        expected = table.sort_values("offset_mm")
        np.testing.assert_allclose(np.asarray(panel.lines[0].get_xdata(), float), expected["offset_mm"])
        values = np.where(np.isfinite(expected[field]), expected[field], np.nan)
        np.testing.assert_array_equal(np.asarray(panel.lines[0].get_ydata(), float), values)
        assert np.isnan(values).sum() == (1 if field == "peak_torque_Nm" else 2)
        assert "shaded" in panel.get_title("right")
    assert overlaps(figure) == []


def test_contour_figure_draws_the_values_over_both_parameters() -> None:
    table = sweep(SMOOTH, np.array([0.04, 1.0, 0.0]), [OFFSETS, RODS], ["peak_torque"])
    figure = sweep_figure(table, [OFFSETS, RODS], [QUANTITIES["peak_torque"]], title="Sieve")
    from slidercrank.objectives.registry import quantity

    grids, values = sweep_grid(table, [OFFSETS, RODS], quantity("peak_torque"))
    np.testing.assert_allclose(grids[0], [0.0, 10.0, 20.0, 30.0], atol=1e-12)
    np.testing.assert_allclose(grids[1], [66.0, 80.0, 100.0])
    for i, offset in enumerate(grids[0]):
        for j, rod in enumerate(grids[1]):
            row = table[np.isclose(table["offset_mm"], offset) & np.isclose(table["rod_mm"], rod)].iloc[0]
            np.testing.assert_array_equal(values[i, j], row["peak_torque_Nm"])
    assert np.isnan(values[3, 0])
    panel = figure.axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("offset, mm", "rod, mm")
    low, high = panel.collections[0].get_clim()
    assert low <= np.nanmin(values)
    assert high >= np.nanmax(values) * 0.9
    assert overlaps(figure) == []


@pytest.mark.parametrize(
    ("axes", "of"),
    [
        ([OFFSETS, Axis("rod", (0.08,))], ["stroke"]),  # one value: a line over the other
        ([Axis("speed", (1.0, 2.0)), RODS], ["stroke", "peak_slider_speed", "time_ratio"]),  # time ratio: constant
        ([Axis("offset", (0.2, 0.3))], ["stroke"]),  # turns nowhere
        ([Axis("offset", (0.0, 0.01))], ["time_ratio"] * 8),  # more than are drawn
    ],
)
def test_unusual_sweeps_can_be_drawn(axes: list[Axis], of: list[str]) -> None:
    table = sweep(SMOOTH, np.array([0.04, 0.1, 0.0]), axes, of)
    figure = sweep_figure(table, axes, [QUANTITIES[name] for name in of], title="A name that is long " * 8)
    assert overlaps(figure) == []


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mechanism.slider.mass", "--set"),
        ("ofset", "did you mean offset?"),
        ("rod_to_offset", "follows from these: sweep one of them, and compute rod_to_offset as a quantity"),
    ],
)
def test_a_name_that_is_not_swept_is_what_is_wrong(name: str, said: str, command: Command, job: Path) -> None:
    done = command("sweep", job, "--over", f"{name}=1 kg..2 kg:3", "--of", "stroke")
    assert done.exit_code == 2
    assert f"a sweep must be over one of crank, rod, offset, speed; got {name!r}" in done.stderr
    assert said in done.stderr
