"""Zero where rounding is meant, and a star for every best design."""

from __future__ import annotations

import math
import re

import pytest

from slidercrank.objectives.kinds import name_unit_and_factor_of_key
from slidercrank.service.designs.columns import find_column
from slidercrank.service.designs.display_units import row_without_noise
from slidercrank.service.runs.result import Result, StoredObjective
from slidercrank.service.text.screen import console
from slidercrank.service.text.tables import show_design, show_front

ROW: dict[str, float | str | None] = {
    "crank_mm": 40.0,
    "peak_torque_Nm": 12.5,
    "mean_torque_Nm": -5.7e-14,
    "slack_peak_torque_Nm": 1.27e-14,
    "position_error_mm": 3e-9,
    "time_ratio": 1.25,
    "slack_time_ratio": 2.2e-16,
    "rod_stress_MPa": math.inf,
    "crank_stress_MPa": 1e-20,
    "residual": 2e-15,
    "status": "stationary",
    "friction_loss_J": None,
}


def test_numbers_below_the_rounding_of_their_unit_are_zero_and_others_stay() -> None:
    expected = ROW | {"mean_torque_Nm": 0.0, "slack_peak_torque_Nm": 0.0, "slack_time_ratio": 0.0}
    assert row_without_noise(ROW) == expected


def test_a_design_is_shown_without_rounding(capsys: pytest.CaptureFixture[str]) -> None:
    show_design(console(), ROW)
    shown = capsys.readouterr().out
    assert re.search(r"mean torque over the crank angle +0  N m", shown)
    assert "e-14" not in shown


def result(prices: list[float]) -> Result:
    designs = [
        {"crank_mm": 40.0 + row, "rod_mm": 100.0, "offset_mm": 0.0, "stroke_mm": 80.0 + row, "price_EUR": price}
        for row, price in enumerate(prices)
    ]
    wanted = (
        StoredObjective(quantity="price", sense="minimise", column="price_EUR", title="price", unit="EUR"),
        StoredObjective(quantity="stroke", sense="maximise", column="stroke_mm", title="stroke", unit="mm"),
    )
    return Result(
        run="",
        name="ties",
        status="done",
        message="",
        objectives=wanted,
        designs=list(map(dict, designs)),
        hypervolume=1.0,
        evaluations=1,
        seconds=1.0,
        seed=1,
        extremes={"price": 0, "stroke": len(prices) - 1},
        knee=None,
        trade_offs=[],
    )


@pytest.mark.parametrize(
    ("prices", "starred"),
    [([229.0, 229.0 * (1.0 + 1e-12), 240.0], [True, True, False]), ([229.0, 229.0, 229.0], [False, False, False])],
)
def test_every_best_design_has_a_star_and_a_constant_objective_has_none(
    prices: list[float], starred: list[bool], capsys: pytest.CaptureFixture[str]
) -> None:
    show_front(console(), result(prices), range(3))
    lines = [line for line in capsys.readouterr().out.splitlines() if re.match(r" *\d+  ", line)]
    assert [bool(re.search(r"2[24][09]\.0\*", line)) for line in lines] == starred
    assert "82.00*" in lines[-1]


def test_columns_of_a_catalogue_keep_their_unit_and_say_what_suffices() -> None:
    keys = [
        *ROW,
        "choice_gearmotor",
        "choice_least_gearmotor",
        "least_gearmotor_output_speed_1_min",
        "least_flow_L_min",
    ]
    assert name_unit_and_factor_of_key("output_speed_1_min") == ("output_speed", "1/min", 60.0)
    titles = [(find_column(key, keys).title, find_column(key, keys).unit) for key in keys[-3:]]
    assert titles == [
        ("smallest sufficient gearmotor", ""),
        ("smallest sufficient gearmotor output speed", "1/min"),
        ("least flow", "L/min"),
    ]
