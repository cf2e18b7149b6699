"""Columns of measured tables: what they mean, in which units, and which are refused."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from slidercrank import InputError, Linkage, Mechanism, analyse
from slidercrank.objectives.tables.curve_extremes import every_curve
from slidercrank.objectives.tables.measured_curves import meaningful_columns, samples_of_measured_table
from tests.model.cases import SMOOTH, TABLES

LINKAGE = Linkage(0.05, 0.2, 0.03)
MACHINE = Mechanism(speed=30.0, slider_mass=0.8)


def meaning(name: str) -> tuple[str, float]:
    column = meaningful_columns(["crank_angle_deg", name], SMOOTH, LINKAGE)[name]
    return column.name, column.factor


def test_every_curve_is_read_as_tables_in_metric_inch_and_si_call_it() -> None:
    for curve in every_curve(SMOOTH, LINKAGE, np.zeros(1)):
        for face in (curve.kind.si_display_unit, curve.kind.metric, curve.kind.inch):
            if face is not None:
                for name in (curve.name + face.suffix, f"{curve.title} [{face.symbol}]"):
                    found, factor = meaning(name)
                    assert found == curve.name
                    assert factor == pytest.approx(1.0 / face.factor, rel=1e-12), name


@pytest.mark.parametrize("name", ["temperature_C", "time_of_day", "load_cell_V", "torque_filtered_Nm", "", "x"])
def test_other_columns_are_left_out(name: str) -> None:
    found = samples_of_measured_table({"crank_angle_deg": [0.0], "torque_Nm": [1.0], name: [5.0]}, MACHINE, LINKAGE)
    assert found.left_out == (name,)
    assert list(found.values) == ["torque"]


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (
            ["crank_angle_deg", "torque"],
            "a column must have its unit in its name; got 'torque'; write it like torque_Nm",
        ),
        (
            ["crank_angle_deg", "torque_mm"],
            "torque must be a torque; got 'torque_mm', a length; write it like torque_Nm",
        ),
        (
            ["crank_angle_deg", "torque_N_mm"],
            "torque must be in N m or lbf in; got 'torque_N_mm'; write it like torque_Nm",
        ),
        (
            ["crank_angle_deg", "torque in N"],
            "torque must be a torque; got 'torque in N', a force; write it like torque_Nm",
        ),
        (
            ["crank_angle_deg", "torque_Nm", "torque_N_m"],
            "a curve may only be measured once; got the columns 'torque_Nm' and",
        ),
        (
            ["torque_Nm"],
            "must have the column crank_angle_deg, or time_s at constant speed; got neither; add one to 'torque",
        ),
        (["crank_angel_deg", "torque_Nm"], "is 'crank_angel_deg' one of them?"),
        ([], "got neither; add one to no columns"),
        (["crank_angle_deg"], "a column must be a curve with its unit, such as slider_position_mm"),
        (["crank_angle_deg", "slider_positon_mm"], "did you mean slider_position?"),
        (["crank_angle_deg", "Velocity [m/s]"], "did you mean slider_velocity?"),
        (["crank_angle_deg", "u"], "curves are slider_position, slider_velocity,"),
    ],
)
def test_columns_that_cannot_be_are_refused(names: list[str], words: str) -> None:
    with pytest.raises(InputError, match=re.escape(words)):
        meaningful_columns(names, MACHINE, LINKAGE)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (
            {"crank_angle_deg": [0.0, 1.0], "torque_Nm": ["a", 1.0]},
            "'torque_Nm' must contain numbers; got other values",
        ),
        ({"crank_angle_deg": [0.0, 1.0], "torque_Nm": [1.0]}, "'torque_Nm' of shape (1,)"),
        ({"crank_angle_deg": [0.0], "torque_Nm": [[1.0]]}, "columns must be lists of equal length"),
        ({"crank_angle_deg": [math.inf], "torque_Nm": [1.0]}, "at most 1e+09 rad in size; got inf in row 1"),
        ({"crank_angle_deg": [0.0, 1.0], "slider_position_mm": [1.0, 1e99]}, "at most 10000 m in size; got 1e+99 in"),
        ({"crank_angle_deg": [0.0, math.nan], "torque_Nm": [math.nan, 1.0]}, "got none in 'torque_Nm'; add values"),
        (
            {"crank_angle_deg": [], "torque_Nm": []},
            "a curve must have numbers in at least one row with a crank angle; got none in",
        ),
        ({"crank_angle_deg": [0.0], "load_N": [1.0]}, "'load_N' is not defined for this machine: it needs loads"),
        (
            {"crank_angle_deg": [0.0], "position_error_mm": [1.0]},
            "a position error needs tolerances; got none",
        ),
    ],
)
def test_values_that_cannot_be_are_refused(table: dict[str, list[float]], words: str) -> None:
    with pytest.raises(InputError, match=re.escape(words)):
        samples_of_measured_table(table, MACHINE, LINKAGE)


def test_time_is_a_crank_angle_at_constant_speed() -> None:
    backwards = Mechanism(speed=-30.0)
    found = samples_of_measured_table({"time_s": [0.0, 0.01], "slider_position_mm": [1.0, 2.0]}, backwards, LINKAGE)
    assert found.by_time
    assert found.crank_angle == pytest.approx([0.0, -0.3], rel=1e-12)
    both = {"time_s": [0.0], "crank_angle_deg": [90.0], "slider_position_mm": [1.0]}
    found = samples_of_measured_table(both, backwards, LINKAGE)
    assert found.crank_angle == pytest.approx([0.5 * math.pi], rel=1e-12)
    assert found.left_out == ("time_s",)
    for machine, words in (
        (Mechanism(), "needs a crank speed; got none"),
        (SMOOTH, "a crank acceleration of 40 rad/s^2"),
    ):
        with pytest.raises(InputError, match=re.escape(words)):
            meaningful_columns(["time_s", "slider_position_mm"], machine, LINKAGE)


@pytest.mark.parametrize("machine", [SMOOTH, TABLES])
def test_rod_angles_may_be_measured_in_any_turn(machine: Mechanism) -> None:
    steady = replace(machine, acceleration=0.0)
    linkage = Linkage(0.05, 0.2, 0.03, machine.branch)
    analysis = analyse(steady, [0.05, 0.2, 0.03])
    cycle = analysis.cycle(60)
    turns = np.tile([-2.0, 0.0, 3.0], 20)
    table = {"crank_angle_rad": cycle.crank_angle_rad, "rod_angle_rad": cycle.rod_angle_rad + 2.0 * math.pi * turns}
    assert linkage.branch == steady.branch
    assert float(analysis.deviations(table)["rms"].iloc[0]) < 1e-12


def test_an_analysis_compares_a_table_with_its_own_cycle() -> None:
    analysis = analyse(MACHINE, [0.05, 0.2, 0.03])
    cycle = analysis.cycle(50)
    found = analysis.deviations(cycle.drop(columns=["load_N"]))  # zeros, and this machine has no load
    assert len(found) == cycle.shape[1] - 4  # position errors are empty without tolerances
    assert (found["rms"] < 1e-9).all()
    table = pd.DataFrame({"crank_angle_rad": cycle.crank_angle_rad - 0.2, "torque_N_m": cycle.torque_Nm + 0.5})
    found = analysis.deviations(table)
    assert found[["title", "unit", "samples"]].to_dict("index") == {
        "torque": {"title": "drive torque", "unit": "N m", "samples": 50}
    }
    shifts = found[["best_shift_rad", "best_shift", "rms_left"]].to_numpy(dtype=float)[0]
    assert shifts == pytest.approx([0.2, -0.5, 0.0], abs=1e-6)
