"""Results as JSON and CSV: strict, complete, and exact."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.runs.result import (
    Row,
    csv_text,
    json_ready,
    json_text,
    result_of,
    row_from_json,
    rows_from_csv,
)
from slidercrank.service.runs.runs_on_disk import result_from
from tests.service import fronts

DESIGN_KEYS = [
    *("crank_mm", "rod_mm", "offset_mm", "stroke_mm", "time_ratio", "slow_stroke"),
    *("outer_dead_centre_deg", "inner_dead_centre_deg", "least_transmission_angle_deg"),
    *("peak_torque_Nm", "peak_torque_angle_deg", "rms_torque_Nm", "mean_torque_Nm"),
    *("position_error_mm", "position_error_rss_mm", "peak_pivot_force_N", "peak_crank_pin_force_N"),
    *("peak_slider_pin_force_N", "peak_guide_force_N", "peak_slider_speed_m_s", "peak_slider_acceleration_m_s2"),
]
KEYS = ["run", "status", "message", "objectives", "designs", "hypervolume", "evaluations", "seconds"]


def test_json_has_the_released_keys() -> None:
    record = result_of(fronts.front(), "runs/x").record()
    assert set(KEYS) <= set(record)
    assert set(DESIGN_KEYS) <= set(record["designs"][0])
    assert [wanted["quantity"] for wanted in record["objectives"]] == list(fronts.FOUR)


def test_marked_designs_are_those_of_the_front() -> None:
    front = fronts.front()
    record = result_of(front, "runs/x").record()
    assert record["extremes"] == front.extremes()
    assert record["knee"] == front.knee()
    assert record["trade_offs"] == front.trade_offs(front.knee())


def test_an_empty_front_has_no_marked_design() -> None:
    record = result_of(fronts.empty_front("infeasible", "nothing"), "runs/x").record()
    assert (record["designs"], record["extremes"], record["knee"], record["trade_offs"]) == ([], {}, None, [])


def test_what_is_not_defined_is_null_in_json_and_infinity_a_word() -> None:
    given = {"a": math.inf, "b": [math.nan, -math.inf, 1.5], "c": {"d": math.nan}}
    assert json.loads(json_text(given)) == {"a": "inf", "b": [None, "-inf", 1.5], "c": {"d": None}}
    assert json_ready(given, gaps=True) == {"a": None, "b": [None, None, 1.5], "c": {"d": None}}


def test_random_designs_read_back_from_json_as_from_csv() -> None:
    random = np.random.default_rng(5)
    values = np.array([math.inf, -math.inf, math.nan, 0.0, -0.0, 1e300, 5e-324, 1.5])
    for _ in range(50):
        row: Row = {f"column_{place}_mm": float(value) for place, value in enumerate(random.choice(values, 9))}
        row |= {"choice_motor": str(random.choice(["inf", "-inf", "GM 4"])), "slow_stroke": "inward"}
        read = row_from_json(json.loads(json_text(row)))
        assert read.keys() == row.keys()
        (line,) = rows_from_csv(csv_text([row]))
        for key, value in row.items():
            undefined = isinstance(value, float) and math.isnan(value)
            assert read[key] == (None if undefined else value)
            if not key.startswith("choice_"):
                assert repr(line[key]) == repr(value)


def test_json_is_ascii() -> None:
    assert json_text({"name": "Förderer ≥ 2"}).isascii()


ROWS: list[Row] = [
    {"a_mm": 0.1 + 0.2, "b": math.inf, "word": "inward"},
    {"a_mm": 5e-324, "b": math.nan, "word": 'a, "b"\nc'},
    {"a_mm": -1.7976931348623157e308, "b": 1e22, "word": "outward"},
]


def test_csv_is_read_back_bit_for_bit() -> None:
    back = rows_from_csv(csv_text(ROWS))
    assert repr(back) == repr(ROWS)


def test_csv_of_no_designs_is_empty() -> None:
    assert csv_text([]) == ""
    assert rows_from_csv("") == []


def test_csv_with_a_short_line_is_refused() -> None:
    with pytest.raises(ValueError, match="shorter"):
        rows_from_csv("a,b\n1,2\n3\n")


def test_csv_has_every_number_of_the_table() -> None:
    front = fronts.front()
    back = rows_from_csv(csv_text(result_of(front, "x").designs))
    assert [list(row) for row in back] == [list(front.designs.columns)] * len(front)
    for name in front.designs.columns:
        kept = front.designs[name].tolist()
        assert [row[name] for row in back] == kept or np.isnan([*kept, *(row[name] for row in back)]).all()


def test_the_record_says_how_designs_of_discrete_values_were_found() -> None:
    problem = parse_job(
        {
            "name": "values",
            "mechanism": {"speed": "240 rpm", "slider": {"mass": "2 kg"}},
            "variables": {
                "crank": {"min": "40 mm", "max": "60 mm", "step": "2 mm"},
                "rod": {"min": "90 mm", "max": "250 mm", "series": "R10"},
                "offset": "20 mm",
            },
            "objectives": {"peak_torque": "minimise", "transmission_angle": {"target": "60 deg"}},
            "optimiser": {"method": "sobol", "evaluations": 64},
        }
    )
    result = result_of(solve(problem), "run")
    record = json.loads(json_text(result.record()))
    found = record["discrete"]
    assert (found["how"], found["combinations"], found["judged"]) == ("exact", 55, 55)
    assert found["values"] == {"crank": "multiples of 2 mm", "rod": "R10 in mm"}
    assert list(found["continuous_best"]) == ["peak_torque_Nm", "off_target_least_transmission_angle_deg"]
    assert found["continuous_best"]["peak_torque_Nm"] <= min(row["peak_torque_Nm"] for row in result.designs)  # type: ignore[type-var]
    again = result_from(record, result.designs, "run")
    assert again.discrete == found
    assert "discrete" not in replace(result, discrete=None).record()
