"""Results in inch units: the same as in metric ones, on the command line, in files and in reports."""

from __future__ import annotations

import csv
import io
import itertools
import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.kinds import (
    DISPLAYED_KINDS,
    KINDS,
    RATIO,
    column_key_in_system,
    metric_key,
    metric_unit_in,
    name_unit_and_factor_of_key,
)
from slidercrank.objectives.units import kind_of_any_unit, to_si, value_of_one_si_unit_in
from slidercrank.service.designs.columns import find_column
from slidercrank.service.designs.display_units import convert_record, convert_result, convert_row
from slidercrank.service.runs.result import result_of, rows_from_csv
from tests.service import fronts
from tests.service.conftest import Command

FACES = [face for kind in DISPLAYED_KINDS for face in (kind.metric, kind.inch) if face is not None]


def is_same_kind(symbol: str, unit: str) -> bool:
    """Whether a value in one unit is one of the kind of the other."""
    return to_si(f"1 {symbol}", replace(kind_of_any_unit(unit), limit=1e30)) > 0.0


@pytest.mark.parametrize("face", FACES, ids=lambda face: face.symbol)
def test_factors_and_symbols_are_those_that_job_files_are_read_with(face: object) -> None:
    assert face.factor == pytest.approx(value_of_one_si_unit_in(face.symbol), rel=1e-15)  # type: ignore[attr-defined]


def test_both_units_of_a_kind_measure_the_same() -> None:
    for kind in DISPLAYED_KINDS:
        for face in (kind.metric, kind.inch):
            assert face is None or is_same_kind(face.symbol, kind.unit)
    assert {kind for kind in KINDS if kind not in DISPLAYED_KINDS} == {RATIO}


@pytest.mark.parametrize(
    ("key", "shown", "metric", "inch"),
    [
        ("crank_mm", "crank_in", 25.4, 1.0),
        ("peak_torque_Nm", "peak_torque_lbf_in", 4.4482216152605 * 0.0254, 1.0),
        ("peak_pivot_force_N", "peak_pivot_force_lbf", 4.4482216152605, 1.0),
        ("peak_power_W", "peak_power_hp", 745.69987158227022, 1.0),
        ("peak_reflected_inertia_kg_m2", "peak_reflected_inertia_lb_in2", 0.45359237 * 0.0254**2, 1.0),
        ("peak_slider_acceleration_m_s2", "peak_slider_acceleration_in_s2", 9.80665, 386.08858267716535),
        ("stress_MPa", "stress_psi", 6.894757293168361e-3, 1.0),
        ("footprint_m2", "footprint_in2", 0.00064516, 1.0),
        ("rod_kg", "rod_lb", 0.45359237, 1.0),
        ("least_transmission_angle_deg", "least_transmission_angle_deg", 40.0, 40.0),
        ("rod_to_offset", "rod_to_offset", 3.2, 3.2),
        ("slack_stroke_mm", "slack_stroke_in", -2.54, -0.1),
    ],
)
def test_keys_carry_the_unit_of_their_values(key: str, shown: str, metric: float, inch: float) -> None:
    assert convert_row({key: metric}, "metric") == {key: metric}
    assert convert_row({key: metric}, "inch") == {shown: pytest.approx(inch, rel=1e-15)}
    assert metric_key(shown) == key
    assert find_column(shown, [shown]).title == find_column(key, [key]).title
    assert name_unit_and_factor_of_key(shown)[2] / name_unit_and_factor_of_key(key)[2] == pytest.approx(
        column_key_in_system(key, "inch")[1]
    )


def test_what_is_no_number_stays_at_any_depth() -> None:
    record = {
        "a_mm": [25.4, None, [math.inf]],
        "b_N": "none",
        "c": {"d_mm": {"e_kg": 0.45359237}, "ok_W": True},
        "n": 3,
    }
    assert convert_record(record, "metric") is record
    assert convert_record(record, "inch") == {
        "a_in": [pytest.approx(1.0), None, [math.inf]],
        "b_lbf": "none",
        "c": {"d_in": {"e_lb": 1.0}, "ok_hp": True},
        "n": 3,
    }


def test_a_unit_of_an_own_quantity_stays() -> None:
    assert metric_unit_in("EUR", "inch") == ("EUR", 1.0)
    assert convert_row({"price_EUR": 2.0}, "inch") == {"price_EUR": 2.0}


def test_the_order_the_marks_and_the_ranks_are_those_of_the_metric_result() -> None:
    result = result_of(fronts.front(), "run")
    inch = convert_result(result, "inch")
    assert (inch.knee, inch.extremes) == (result.knee, result.extremes)
    for wanted, shown in zip(result.objectives, inch.objectives, strict=True):
        ranks = [
            [item.minimised_value(row) for row in rows]
            for item, rows in ((wanted, result.designs), (shown, inch.designs))
        ]
        assert np.argsort(ranks[0]).tolist() == np.argsort(ranks[1]).tolist()
        assert name_unit_and_factor_of_key(shown.column)[1] == shown.unit


def test_trade_offs_tell_the_same_rates_in_readable_steps() -> None:
    front = fronts.front()
    told = [front.trade_offs(front.knee(), system) for system in ("metric", "inch")]
    assert any("lbf in" in sentence for sentence in told[1])
    assert not any(re.search(r"\d (mm|N|N m|kg)\b", sentence) for sentence in told[1])
    for metric, inch in zip(*told, strict=True):
        rates = []
        for sentence in (metric, inch):
            amounts = [to_si(value, kind_of_any_unit(value.split(" ", 1)[1])) for value in amounts_of(sentence)]
            rates.append([amount / amounts[0] for amount in amounts[1:]])
        assert rates[0] == pytest.approx(rates[1], rel=6e-3), "three digits are told"


def amounts_of(sentence: str) -> list[str]:
    """Return the amounts with a unit in a sentence."""
    return re.findall(r"[\d.e+-]+ (?:mm|in|deg|N m|lbf in)(?= )", sentence)


@pytest.fixture
def run(kept: Path) -> Path:
    """Return the folder of a run."""
    return next(file.parent for file in kept.glob("*/front.csv"))


def test_csv_in_inches_reads_back_to_the_metric_values(run: Path, command: Command) -> None:
    metric = rows_from_csv(command("export", run, "--csv", "-").stdout)
    inch = rows_from_csv(command("export", run, "--csv", "-", "--units", "inch").stdout)
    assert {"crank_in", "peak_torque_lbf_in"} <= set(inch[0])
    for one, other in zip(metric, inch, strict=True):
        for (key, value), (shown, told) in zip(one.items(), other.items(), strict=True):
            if value is None or isinstance(value, str) or not math.isfinite(value):
                assert str(value) == str(told)
            else:
                assert told is not None
                expected = value / name_unit_and_factor_of_key(key)[2]
                assert float(told) / name_unit_and_factor_of_key(shown)[2] == pytest.approx(expected, rel=1e-12)


def test_tables_json_and_the_environment_follow(run: Path, command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    shown = command("front", run, "--units", "inch").stdout
    assert "stroke 11.0236 in" in shown
    assert "lbf in" in command("front", run, "--units", "inch", "--columns", "crank,peak_torque").stdout
    assert not re.search(r"\b(mm|N m)\b", shown)
    record = json.loads(command("front", run, "--units", "inch", "--json").stdout)
    metric = json.loads(command("front", run, "--json").stdout)
    assert all(item["column"] in record["designs"][0] for item in record["objectives"])
    assert record["designs"][0]["crank_in"] == pytest.approx(metric["designs"][0]["crank_mm"] / 25.4, rel=1e-14)
    assert not any(re.search(r"\d (mm|N m)\b", sentence) for sentence in record["trade_offs"])
    monkeypatch.setenv("SLIDERCRANK_UNITS", "inch")
    assert command("front", run).stdout == shown
    assert "mm" in command("front", run, "--units", "metric").stdout
    assert command("front", run, "--units", "foot").exit_code == 2


def test_conditions_name_their_own_unit_whatever_is_shown(run: Path, command: Command) -> None:
    least = json.loads(command("front", run, "--json").stdout)["designs"]
    middle = sorted(row["crank_mm"] for row in least)[len(least) // 2]
    numbers = [
        json.loads(command("front", run, "--json", "--where", condition, "--units", units).stdout)["designs"]
        for condition, units in itertools.product(
            (f"crank >= {middle!r} mm", f"crank >= {middle / 25.4!r} in"), ("metric", "inch")
        )
    ]
    assert 0 < len(numbers[0]) < len(least)
    assert len({len(rows) for rows in numbers}) == 1


def test_a_dimension_without_a_column_is_no_ratio_of_it() -> None:
    with pytest.raises(InputError, match="there is no quantity or column 'rod'"):
        find_column("rod", ["crank_mm", "rod_to_offset", "rod_to_crank"])
    assert find_column("stiffness", ["rod_to_offset", "stiffness_N_mm"]).key == "stiffness_N_mm"


def test_columns_are_called_as_any_export_writes_them(run: Path, command: Command) -> None:
    rows = json.loads(command("front", run, "--json").stdout)["designs"]
    head = command("export", run, "--csv", "-", "--units", "inch").stdout.splitlines()[0].split(",")
    for key in ("crank_in", "peak_torque_lbf_in", "rod_in"):
        assert key in head
        metric = metric_key(key)
        middle = sorted(row[metric] for row in rows)[len(rows) // 2]
        bound = middle * column_key_in_system(metric, "inch")[1]
        for units, where in itertools.product(("metric", "inch"), (f"{key} <= {bound!r}", f"{metric} <= {middle!r}")):
            told = command("front", run, "--json", "--units", units, "--where", where, "--sort", key).stdout
            found = json.loads(told)["designs"]
            assert len(found) == sum(row[metric] <= middle * (1.0 + 1e-8) for row in rows)
    shown = json.loads(command("front", run, "--json", "--columns", "crank_in").stdout)["designs"]
    assert shown == [{"crank_mm": row["crank_mm"]} for row in rows]
    assert command("front", run, "--where", "crank_ft >= 1").exit_code == 2


def test_a_design_and_its_report_follow(run: Path, command: Command, tmp_path: Path) -> None:
    told = command("front", run, "--knee", "--units", "inch").stdout
    assert re.search(r"crank +[\d.]+ +in *\n", told)
    assert command("report", run, "--knee", "--out", tmp_path / "r.html", "--units", "inch").exit_code == 0
    text = (tmp_path / "r.html").read_text()
    assert "lbf in" in text
    assert "crank_in" in text
    assert "peak_torque_Nm" not in text
    cells = next(csv.reader(io.StringIO(command("export", run, "--csv", "-", "--units", "inch").stdout)))
    assert not [cell for cell in cells if cell.endswith(("_mm", "_N", "_Nm", "_W", "_kg"))]


def test_rules_of_a_design_are_told_in_the_units_asked_for(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    sizes = ("--crank", "100 mm", "--rod", "400 mm", "--offset", "50 mm")
    metric, inch = (
        json.loads(command("analyse", job, *sizes, "--json", "--units", units).stdout)["rules"]
        for units in ("metric", "inch")
    )
    assert {rule["unit"] for rule in inch} <= {"in", "deg", ""}
    for one, other in zip(metric, inch, strict=True):
        factor = 25.4 if one["unit"] == "mm" else 1.0
        for key in ("lower", "upper", "value", "missed_by"):
            assert other[key] == (None if one[key] is None else pytest.approx(one[key] / factor, rel=1e-12))
    assert " mm" not in "".join(
        line for line in command("analyse", job, *sizes, "--units", "inch").stdout.splitlines() if "met" in line.lower()
    )
