"""Report of a design that swings: its numbers, ends, extremes, sensitivity and errors, in both files."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.designs.design_curves import rows_of_swing_curves
from slidercrank.service.report.design_report import design_report
from slidercrank.service.report.document import Picture, Report, Table
from slidercrank.service.report.html import html_file
from slidercrank.service.report.pdf import pdf_file
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import result_of
from tests.service.report.paper import paper
from tests.service.report.test_report import text_of, texts

CRANK = {
    "motion": {"kind": "swing", "from": "100 deg", "swing": "-130 deg", "law": "cycloidal", "duration": "20 s"},
    "friction": {"guide": 0.1},
    "constraints": {"swing_transmission_angle": {"min": "20 deg"}},
    "objectives": {"peak_actuator_torque": "minimise", "swing_position_error": "minimise"},
}


@cache
def subject(driver: str) -> Subject:
    job: dict[str, Any] = tomllib.loads(Path("runs/support.toml").read_text(encoding="utf-8"))
    job |= CRANK if driver == "crank" else {}
    job["optimiser"] = {"method": "sobol", "evaluations": 256, "designs": 3, "seed": 1}
    problem = parse_job(job)
    return Subject(problem, result_of(solve(problem), "kept"), 1, run="kept", versions={})


@cache
def report(driver: str) -> Report:
    return design_report(subject(driver), created=0.0)


def table(found: Report, title: str) -> Table:
    return next(
        block
        for section in found.sections
        for block in section.blocks
        if isinstance(block, Table) and block.title.startswith(title)
    )


def number(text: str) -> float:
    return float(text.replace("−", "-"))


@pytest.mark.parametrize("driver", ["crank", "slider"])
def test_both_files_say_everything(driver: str) -> None:
    found = report(driver)
    page = text_of(html_file(found).decode())
    printed = re.sub(r"\s", "", "".join(each.whole for each in paper(pdf_file(found))))
    for text in texts(found):
        assert text in page, text
        assert re.sub(r"\s", "", text) in printed, text
    for title in ("The linkage, to scale", "The design over its swing", "Change of quantities with the dimensions"):
        assert title in page
    assert sum(isinstance(block, Picture) for section in found.sections for block in section.blocks) == 5


@pytest.mark.parametrize("driver", ["crank", "slider"])
def test_numbers_of_the_swing_are_those_of_the_quantities(driver: str) -> None:
    row, rows = subject(driver).row, {cells[0]: cells for cells in table(report(driver), "Swing driven").rows}
    peak = row["peak_actuator_force_N" if driver == "slider" else "peak_actuator_torque_Nm"]
    error = row["swing_angle_error_deg" if driver == "slider" else "swing_position_error_mm"]
    side = "crank" if driver == "slider" else "slider"
    for title, value in {
        "peak drive": peak,
        "travel": row["actuator_travel_mm"],
        "least transmission angle": row["swing_transmission_angle_deg"],
        f"{side} position error": error,
    }.items():
        assert abs(number(rows[title][1])) == pytest.approx(value, rel=1e-5), title
    shares = table(report(driver), "Sources of the error")
    assert sum(number(cells[2]) for cells in shares.rows) == pytest.approx(error, rel=5e-5)  # five digits each
    assert sum(number(cells[3]) for cells in shares.rows) == pytest.approx(100.0, abs=0.3)


@pytest.mark.parametrize("driver", ["crank", "slider"])
def test_extremes_are_those_of_the_curves_of_both_ways(driver: str) -> None:
    design = subject(driver).design
    assert design.part.motion is not None
    rows = rows_of_swing_curves(design.mechanism, design.linkage, design.part.motion)
    drive = next(key for key in rows[0] if key.startswith("drive"))
    said = {cells[0]: cells for cells in table(report(driver), "Extremes").rows}
    title = "force on the slider" if driver == "slider" else "torque on the crank"
    for name, values in (
        ("slider position", [row["slider_position_mm"] for row in rows]),
        (title, [row[drive] for row in rows]),
        ("crank pin force", [math.hypot(row["crank_pin_x_N"], row["crank_pin_y_N"]) for row in rows]),
    ):
        span = max(values) - min(values)
        assert number(said[name][1]) == pytest.approx(min(values), abs=1e-3 * span)
        assert number(said[name][4]) == pytest.approx(max(values), abs=1e-3 * span)
        place = int(np.argmax(values))
        assert abs(number(said[name][5]) - rows[place]["crank_angle_deg"]) < 2.0 or values[0] == pytest.approx(
            max(values)
        )


def test_tables_of_the_swing_are_in_inches_where_that_is_asked() -> None:
    found = design_report(replace(subject("slider"), system="inch"), created=0.0)
    units = {cells[2] for cells in table(found, "Swing driven").rows} | {
        cells[-1] for cells in table(found, "Extremes").rows
    }
    assert {"in", "lbf", "deg"} <= units
    assert not units & {"mm", "N"}
    assert "slider, in" in table(found, "Extremes").heads
    metric, inch = (
        {cells[0]: number(cells[4]) for cells in table(each, "Extremes").rows} for each in (report("slider"), found)
    )
    assert inch["slider position"] == pytest.approx(metric["slider position"] / 25.4, rel=1e-5)
