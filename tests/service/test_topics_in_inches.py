"""Analyses in inch units: sentences, tables and figures have the metric values, changed, and no metric unit."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.friction import Friction
from slidercrank.model.machine.links import Counterweight
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.objectives.kinds import SHOWN, System, unit_text
from slidercrank.service.designs.columns import key_in
from slidercrank.service.designs.shown_units import record_in
from slidercrank.service.figures.panels import draw_sheet
from slidercrank.service.figures.sheets import Line, Panel, Sheet, over_turn
from slidercrank.service.topics.block import Block
from slidercrank.service.topics.discovery import TOPICS
from slidercrank.service.topics.exact_numbers import exact
from slidercrank.service.topics.inches import block_in_inches, sentence_in_inches, sheet_in_inches
from slidercrank.service.topics.told import told
from tests.service import fronts
from tests.service.conftest import Command

LBF_IN = 4.4482216152605 * 0.0254
METRIC = "|".join(
    sorted((re.escape(unit_text(kind.metric.symbol)) for kind in SHOWN if kind.inch), key=len, reverse=True)
)
QUICK = [name for name in TOPICS if name not in ("clearance", "start_up", "tolerances")]


@pytest.mark.parametrize(
    ("metric", "inch"),
    [
        ("greatest rod force 44.482 N at 228.08 deg", "greatest rod force 10 lbf at 228.08 deg"),
        ("crank from 25.4 to 50.8 mm, rod 254 mm", "crank from 1 to 2 in, rod 10 in"),
        ("0.7 mm; 0 mm; -2.54e-05 mm", "0.02756 in; 0 in; -1e-06 in"),
        ("50 % within 0.0254 mm at 300 rpm", "50 % within 0.001 in at 300 rpm"),
        ('got "60 mm", "-60 mm"; 2 N m is possible', 'got "60 mm", "-60 mm"; 17.7 lbf in is possible'),
        ("1 MPa m/s, 8 bar, 3 kg m²", "28551 psi ft/min, 116 psi, 10252 lb in²"),
        ("bar 25.4 x 50.8 mm, (0, 25.4) mm", "bar 1 x 2 in, (0, 1) in"),
        ("Nm of 3 N/mm, 7 Nails", "Nm of 3 N/mm, 7 Nails"),
    ],
)
def test_every_value_of_a_sentence_is_changed_but_for_what_somebody_typed(metric: str, inch: str) -> None:
    assert sentence_in_inches(metric) == inch


def test_numbers_of_a_table_have_the_unit_of_their_column_or_of_their_row() -> None:
    block = Block(
        heads=("curve", "least", "at deg", "slider mm", "e = 25.4 mm", "unit"),
        right=(False,) * 6,
        rows=(
            ("torque", "1", "90.00", "25.4", "7 %", "N m"),
            ("ratio", "1.5", "30", "50.8 / 76.2", "", ""),
            ("play", "25.4", "", "", "± 50.8", "mm"),
        ),
    )
    found = block_in_inches(block)
    assert found.heads == ("curve", "least", "at deg", "slider in", "e = 1 in", "unit")
    assert found.rows == (
        ("torque", f"{1 / LBF_IN:.4g}", "90.00", "1", "7 %", "lbf in"),
        ("ratio", "1.5", "30", "2 / 3", "", ""),
        ("play", "1", "", "", "± 2", "in"),
    )


@pytest.mark.parametrize("name", QUICK)
def test_no_topic_tells_a_metric_unit(name: str) -> None:
    topic = TOPICS[name].of(fronts.MACHINE, Linkage(0.12, 0.35, 0.08))
    try:
        numbers = topic.numbers(lambda: False)
    except InputError:
        return  # this machine has none
    text: list[str] = []
    for metric, inch in zip(told(topic, numbers), told(topic, numbers, "inch"), strict=True):
        assert len(inch.rows) == len(metric.rows)
        text += [inch.sentence, *inch.heads, *(cell for row in inch.rows for cell in row)]
    assert [one for one in text if re.search(rf"(?:^|\s)(?:{METRIC})(?![\w^/²³])", one)] == []


def values_of(record: Any, key: str = "") -> Iterator[tuple[str, float]]:
    """Yield the numbers of a record, each with its key."""
    if isinstance(record, dict | list):
        for name, value in record.items() if isinstance(record, dict) else ((key, value) for value in record):
            yield from values_of(value, name)
    elif isinstance(record, float):
        yield key, record


MACHINES: dict[str, dict[str, Any]] = {
    "balance": {"counterweight": Counterweight(mass=1.713, radius=0.0623)},
    "cylinders": {"arrangement": Arrangement(phases=(0.0, 2.17), places=(-0.0513, 0.0513))},
    "extremes": {},
    "friction": {"friction": Friction(guide=0.0837)},
    "motor": {},
    "uneven_speed": {"speed_profile": Harmonics(cosines=(0.0, 0.0513))},
}


@pytest.mark.parametrize("name", MACHINES)
def test_no_topic_writes_a_metric_number_in_inches(name: str) -> None:
    machine = replace(fronts.MACHINE, **MACHINES[name])
    topic = TOPICS[name].of(machine, Linkage(0.1237, 0.3519, 0.0811))
    record = topic.numbers(lambda: False)
    metric, other = set[str](), set[str]()
    for key, value in values_of(record):
        (other if key_in(key, "inch")[1] == 1.0 else metric).update(f"{abs(value):.{n}g}" for n in (4, 5, 6))
    other |= {f"{abs(value):.{n}g}" for _, value in values_of(record_in(record, "inch")) for n in (4, 5, 6)}
    blocks = told(topic, record, "inch")
    text = [*(block.sentence for block in blocks), *(cell for block in blocks for row in block.rows for cell in row)]
    written = {number for one in text for number in re.findall(r"\d+\.\d+(?:e[-+]\d+)?", one)}
    assert len(written & other) > 5
    assert written & (metric - other) == set()


def test_a_motor_in_inches_has_the_numbers_of_its_json() -> None:
    topic = TOPICS["motor"].of(fronts.MACHINE, Linkage(0.12, 0.35, 0.08))
    numbers = topic.numbers(lambda: False)
    rows = {row[0]: row for block in told(topic, numbers, "inch") for row in block.rows}
    assert float(rows["peak torque"][1]) == pytest.approx(numbers["peak_torque_Nm"] / LBF_IN, rel=1e-5)
    assert rows["peak torque"][2] == "lbf in"
    assert float(rows["mean power"][1]) == pytest.approx(numbers["mean_power_W"] / 745.69987158227, rel=1e-5)


def test_axes_of_a_figure_are_changed_with_all_that_is_drawn() -> None:
    x = np.array([0.0, 25.4])
    line = Line("at 50.8 mm", x, np.array([0.0, LBF_IN]))
    panel = Panel("torque at 25.4 mm, N m", "offset, mm", (line,), names=(("A", 25.4, LBF_IN),), level=("RMS", LBF_IN))
    around = replace(panel, title="rod angle, deg", across="crank angle, deg", level=None)
    one, other = sheet_in_inches(Sheet("Motor", "stroke 254 mm", (panel, around))).panels
    assert (one.title, one.across) == ("torque at 1 in, lbf in", "offset, in")
    assert one.lines[0].label == "at 2 in"
    np.testing.assert_allclose([one.lines[0].x, one.lines[0].y], [[0.0, 1.0], [0.0, 1.0]])
    assert one.level is not None
    np.testing.assert_allclose([*one.names[0][1:], one.level[1]], 1.0)
    np.testing.assert_array_equal(other.lines[0].x, x)


def test_the_figure_of_a_topic_has_lengths_and_extremes_in_inches() -> None:
    from slidercrank.service.topics.extremes.analysis import figure

    metric = figure(fronts.MACHINE, Linkage(0.1237, 0.3519, 0.0811))
    inch = sheet_in_inches(metric)
    assert inch.subtitle == "crank 4.87 in, rod 13.85 in, offset 3.193 in"
    for one, other in zip(metric.panels, inch.panels, strict=True):
        ends = [(float(line.y.min()), float(line.y.max())) for line in other.lines if line.points]
        assert ends == [pytest.approx(sorted(other.noted))]
        assert one.note == other.note
        assert one.note.count("{}") == 2


def test_the_drawn_note_of_a_panel_has_its_values() -> None:
    line = Line("", np.array([0.0, 360.0]), np.array([1.0, 2.0]))
    figure = draw_sheet(Sheet("", "", (over_turn("force, lbf", line, note="{} at 3°", noted=(-1.23456,)),)))
    assert figure.axes[0].get_title(loc="right") == "−1.235 at 3°"


def test_heads_of_a_table_have_their_lines_in_both_systems(command: Command) -> None:
    given = ("analyse", "--crank", "120 mm", "--rod", "350 mm", "--offset", "80 mm", "--speed", "60 rpm")
    for units, length, speed in (("metric", "mm", "m/s"), ("inch", "in", "in/s")):
        text = command(*given, "--show", "extremes", "--units", units).stdout
        assert re.search(rf"at, +slider, +at, +slider, *\n.* deg +{length} +greatest +deg +{length} +unit", text)
        assert re.search(rf"slider velocity .* {speed} *\n", text)


def test_offsets_of_approximations_are_fractions_of_one_length_in_either_unit() -> None:
    topic = TOPICS["approximations"].of(fronts.MACHINE, Linkage(0.12, 0.35, 0.08))
    record = topic.numbers(lambda: False)
    expected: tuple[tuple[System, str], ...] = (("metric", "115 mm"), ("inch", "4.528 in"))
    for units, farthest in expected:
        _, table, note = told(topic, record, units)
        assert table.heads[3:] == ("error", "0 %", "25 %", "50 %", "75 %", "100 %")
        assert note.sentence.endswith(f"with other offsets, in % of {farthest}.")


def test_sensitivities_are_per_inch_in_text_and_json() -> None:
    topic = TOPICS["sensitivity"].of(Mechanism(speed=30.0, slider_mass=0.8), Linkage(0.12, 0.35, 0.08))
    record = topic.numbers(lambda: False)
    metric, inch = (
        {row["quantity"]: row for row in of["quantities"]} for of in (record, topic.numbers_in(record, "inch"))
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
    head, table, *_ = told(topic, record, "inch")
    assert head.sentence.startswith("Change of each quantity for 1 in more of a dimension")
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


def test_text_in_inches_has_every_digit_of_its_numbers() -> None:
    """Random values, plain and calculated with, in sentences, lists, cells and remarks: not those of metric text."""
    random = np.random.default_rng(7)
    for value in 10.0 ** random.uniform(-6.0, 6.0, 400) * random.choice([-1.0, 1.0], 400):
        given = exact({"mm": float(value), "all": [float(value), "as it is", 3, None], "deg": float(value)})
        one, other = given["mm"], 1e-3 * given["all"][0]
        inch = value / 25.4
        told = sentence_in_inches(f"it is {one:.4g} mm, {one:+.5g} and {abs(one):g} mm at {given['deg']:.3g} deg")
        assert told == f"it is {inch:.4g} in, {inch:+.5g} and {abs(inch):g} in at {value:.3g} deg"
        assert (
            sentence_in_inches(f'"{one:.4g} mm" typed, {-other:.6g} m')
            == f'"{value:.4g} mm" typed, {-1e-3 * value:.6g} m'
        )
        rows = (("a", f"{one:.3g}", f"{one:.6g} mm without it", f"{one:.2f} x"),)
        heads = ("what", "size, mm", "of, mm", f"at {one:.4g} deg")
        block = block_in_inches(Block(heads=heads, right=(False,) * 4, rows=rows))
        assert block.rows == (("a", f"{inch:.4g}", f"{inch:.6g} in without it", f"{value:.2f} x"),)
        assert block.heads[1:] == ("size, in", "of, in", f"at {value:.4g} deg")
    assert exact(float("inf")) == np.inf
    assert f"{exact(float('nan')):.4g} {exact(float('-inf')):.3g}" == "nan -inf"
