"""Analyses in inch units: sentences, tables and figures have the metric values, changed, and no metric unit."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.kinds import (
    ANGLE,
    DISPLAYED_KINDS,
    FORCE,
    LENGTH,
    PERCENT,
    RATIO,
    TORQUE,
    Kind,
    System,
    unit_text,
)
from slidercrank.service.designs.display_units import convert_record
from slidercrank.service.figures.panel_drawing import draw_panel_figure
from slidercrank.service.figures.panel_figure import Line, Panel, PanelFigure, crank_angle_panel, panel_in_units
from slidercrank.service.questions.discovery import TOPICS
from slidercrank.service.render.blocks import Table, Text, Unit, Value, column, heading, words
from slidercrank.service.render.formatting import PlainBlock, format_text, format_value, plain_blocks
from slidercrank.service.render.numerals import format_number
from tests.service import fronts, sized
from tests.service.conftest import Command

LBF_IN = 4.4482216152605 * 0.0254
METRIC = "|".join(
    sorted((re.escape(unit_text(kind.metric.symbol)) for kind in DISPLAYED_KINDS if kind.inch), key=len, reverse=True)
)


@pytest.mark.parametrize("kind", [*DISPLAYED_KINDS, PERCENT, RATIO], ids=lambda kind: kind.name)
def test_a_number_in_inches_is_the_metric_one_times_the_factor_with_four_digits_at_least(kind: Kind) -> None:
    random = np.random.default_rng(7)
    face = kind.display_unit("inch")
    for number in (10.0 ** random.uniform(-6.0, 6.0, 40) * random.choice([-1.0, 1.0], 40)).tolist():
        digits = int(random.integers(2, 7))
        value = Value(number, kind, digits)
        for text, of, least in (
            (format_value(value), kind.metric, digits),
            (format_value(value, "inch"), face, max(digits, 4 if kind.inch else 0)),
        ):
            assert text == f"{of.factor * number:.{least}g} {unit_text(of.symbol)}".rstrip()


def test_undefined_infinite_zero_and_signed_numbers() -> None:
    assert [format_value(Value(number, LENGTH)) for number in (None, math.nan)] == ["undefined", "undefined"]
    assert format_value(Value(None, missing="unbounded"), "inch") == "unbounded"
    assert [format_value(Value(x, FORCE), "inch") for x in (math.inf, -math.inf)] == ["inf lbf", "-inf lbf"]
    assert format_value(Value(-1e-9, ANGLE, decimals=2)) == "0.00 deg"
    assert format_value(Value(-0.0, LENGTH), "inch") == "0 in"
    assert [format_value(Value(0.0574512, LENGTH, decimals=2), of) for of in ("metric", "inch")] == [
        "57.45 mm",
        "2.26186 in",
    ]
    assert [format_value(Value(x, LENGTH, sign=True)) for x in (0.0254, -0.0254)] == ["+25.4 mm", "-25.4 mm"]
    assert format_value(Value(-1.5e-3, LENGTH), printed=True) == "−1.5 mm"


def test_a_value_alone_in_a_cell_has_no_unit_and_within_a_text_it_has() -> None:
    length = Value(0.0508, LENGTH)
    row: tuple[Text, ...] = (length, words("{size} more", size=length), Unit(LENGTH))
    table = Table((column("size", LENGTH), column(left=True), column("unit", left=True)), (row,), ruled=True)
    assert plain_blocks([table, heading("bar {a} x {a}", a=length)], "inch") == [
        PlainBlock(heads=("size, in", "", "unit"), right=(True, False, False), rows=(("2", "2 in more", "in"),)),
        PlainBlock("bar 2 in x 2 in", heading=True),
    ]


def test_axes_of_a_figure_are_changed_with_all_that_is_drawn() -> None:
    x = np.array([0.0, 0.0254])
    line = Line(words("at {size}", size=Value(0.0508, LENGTH)), x, np.array([0.0, LBF_IN]))
    title = words("torque at {place}", place=Value(0.0254, LENGTH))
    panel = Panel(title, "offset", (line,), TORQUE, LENGTH, names=(("A", 0.0254, LBF_IN),), level=("RMS", LBF_IN))
    one = panel_in_units(panel, "inch")
    assert (one.title, one.x_title) == ("torque at 1 in, lbf in", "offset, in")
    assert one.lines[0].label == "at 2 in"
    np.testing.assert_allclose([one.lines[0].x, one.lines[0].y], [[0.0, 1.0], [0.0, 1.0]])
    assert one.level is not None
    np.testing.assert_allclose([*one.names[0][1:], one.level[1]], 1.0)
    drawn = panel_in_units(Panel("rod angle, deg", "crank angle, deg", (line,), turns=True), "inch")
    np.testing.assert_array_equal([drawn.lines[0].x, drawn.lines[0].y], [line.x, line.y])


def test_the_figure_of_a_topic_has_lengths_and_extremes_in_inches() -> None:
    from slidercrank.service.questions.extremes.analysis import figure

    sheet = figure(fronts.MACHINE, Linkage(0.1237, 0.3519, 0.0811))
    assert format_text(sheet.subtitle, "inch") == "crank 4.87008 in, rod 13.8543 in, offset 3.19291 in"
    for panel in sheet.panels:
        drawn = panel_in_units(panel, "inch")
        ends = [end for line in drawn.lines if line.points for end in line.y.tolist()]
        assert [part.split(" at ")[0] for part in str(drawn.note).split(", ")] == [format_number(end) for end in ends]
        assert len(ends) == 2


def test_the_drawn_note_of_a_panel_has_its_values() -> None:
    line, least = Line("", np.array([0.0, 360.0]), np.array([1.0, 2.0])), Value(-1.23456, FORCE, digits=4)
    panel = crank_angle_panel("force", line, kind=FORCE, note=words("{least} at 3°", least=least))
    figure = draw_panel_figure(PanelFigure("", "", (panel,)))
    assert figure.axes[0].get_title(loc="right") == "−1.235 N at 3°"
    assert figure.axes[0].get_title(loc="left") == "force, N"


def test_heads_of_a_table_have_their_lines_in_both_systems(command: Command) -> None:
    given = ("analyse", "--crank", "120 mm", "--rod", "350 mm", "--offset", "80 mm", "--speed", "60 rpm")
    for units, length, speed in (("metric", "mm", "m/s"), ("inch", "in", "in/s")):
        text = command(*given, "--show", "extremes", "--units", units).stdout
        assert re.search(rf"at, +slider, +at, +slider, *\n.* deg +{length} +greatest +deg +{length} +unit", text)
        assert re.search(rf"slider velocity .* {speed} *\n", text)


def test_offsets_of_approximations_are_fractions_of_one_length_in_either_unit() -> None:
    topic = TOPICS["approximations"].bind_to_design(fronts.MACHINE, Linkage(0.12, 0.35, 0.08))
    record = topic.numbers(lambda: False)
    expected: tuple[tuple[System, str], ...] = (("metric", "115 mm"), ("inch", "4.528 in"))
    for units, farthest in expected:
        _, table, note = plain_blocks(topic.blocks(record), units)
        assert table.heads[3:] == ("error", "0 %", "25 %", "50 %", "75 %", "100 %")
        assert note.sentence.endswith(f"for other offsets, in % of {farthest}.")


def test_sensitivities_are_per_inch_in_text_and_json() -> None:
    topic = TOPICS["sensitivity"].bind_to_design(Mechanism(speed=30.0, slider_mass=0.8), Linkage(0.12, 0.35, 0.08))
    record = topic.numbers(lambda: False)
    metric, inch = (
        {row["quantity"]: row for row in of["quantities"]} for of in (record, topic.numbers_in_units(record, "inch"))
    )
    for name, unit, factor in (
        ("peak_torque", "lbf in", 1.0 / LBF_IN),
        ("stroke", "in", 1.0 / 25.4),
        ("time_ratio", "", 1.0),
    ):
        assert inch[name]["unit"] == unit
        assert not [key for key in inch[name] if "_mm" in key]
        for key, value in metric[name].items():
            scale = factor * 25.4 if "_per_mm" in key else 1.0 if "percent" in key else factor
            if isinstance(value, float):
                assert inch[name][key.replace("_per_mm", "_per_in")] == pytest.approx(scale * value, rel=1e-12)
    head, table, *_ = plain_blocks(topic.blocks(record), "inch")
    assert head.sentence.startswith("Change of each quantity if a dimension grows by 1 in")
    stroke = next(row for row in table.rows if row[0] == "stroke")
    assert stroke[1:4] == (f"{inch['stroke']['value']:.5g}", "in", f"{inch['stroke']['crank_per_in']:+.4g}")


@pytest.mark.slow  # every derivative of every quantity
def test_the_command_line_sends_sensitivities_per_inch(tmp_path: Any, command: Command) -> None:
    given = ("analyse", fronts.job_file(tmp_path), "--crank", "120 mm", "--rod", "350 mm", "--offset", "80 mm")
    found = command(*given, "--show", "sensitivity", "--json", "--units", "inch").stdout
    rows = {row["quantity"]: row for row in json.loads(found)["sensitivity"]["quantities"]}
    assert rows["rod_to_crank"]["crank_per_in"] == pytest.approx(-350.0 / 120.0**2 * 25.4)
    assert rows["stroke"]["unit"] == "in"


def test_the_command_line_tells_a_topic_in_the_units_that_are_asked_for(tmp_path: Any, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    given = ("analyse", job, "--crank", "120 mm", "--rod", "350 mm", "--offset", "80 mm", "--show", "motor")
    found = command(*given, "--units", "inch").stdout
    assert re.search(r"peak torque +[\d.]+ +lbf in +at ", found)
    assert "metric units" not in found
    assert re.search(r"peak torque +[\d.]+ +N m +at ", command(*given).stdout)


@pytest.mark.parametrize(
    "asked",
    [
        ("allocate", "--limit", "0.3 mm"),
        ("allocate", "--limit", "0.3 mm", "--kind", "rss"),
        ("balance", "--mass", "0.5 kg"),
        ("balance", "--mass", "2 kg", "--rod-radius", "60 mm", "--rod-mass", "2 kg", "--arm", "200 mm"),
        ("sections",),
    ],
    ids=" ".join,
)
def test_what_sizes_one_design_says_in_inches_the_metric_numbers(
    asked: tuple[str, ...], command: Command, tmp_path: Path
) -> None:
    job = tmp_path / "job.json"
    job.write_text(json.dumps(sized.TABLES))
    name, *options = asked
    lengths = ("--crank", "60 mm", "--rod", "230 mm", "--offset", "70 mm")
    figures = () if name == "sections" else ("--figures", tmp_path / "figures")

    def said(*more: object) -> str:
        done = command(name, job, *lengths, *options, *more)
        assert done.exit_code == 0, done.output
        return done.stdout

    unit = re.compile(rf"[\d ]({METRIC})(?![\w/])")
    assert unit.search(said(*figures))
    assert not unit.search(said(*figures, "--units", "inch"))
    metric = json.loads(said("--json"))
    assert json.loads(said("--json", "--units", "inch")) == convert_record(metric, "inch") != metric
