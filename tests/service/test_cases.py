"""The published cases: exact values, verdicts, and that none of them is taken on trust."""

from __future__ import annotations

import csv
import json
import math
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Clearance
from slidercrank.service.cases import case_2, figures
from slidercrank.service.cases.case_table import collect_cases
from slidercrank.service.cases.figures import draw_cases
from slidercrank.service.cases.printed_values import CASES, Case, Row, is_confirmed, read_printed_table
from slidercrank.service.figures.style import new_figure
from tests.model.virtual_work import path
from tests.service.conftest import Command


@pytest.fixture(scope="module")
def cases() -> list[Case]:
    return collect_cases()


def rows(cases: list[Case], number: int) -> dict[str, Row]:
    return {row.key: row for row in cases[number - 1].rows}


def value(row: Row) -> float:
    assert row.exact is not None
    return row.exact


def test_exact_values_are_the_independent_ones(cases: list[Case], request: pytest.FixtureRequest) -> None:
    file = request.config.rootpath / "tests" / "data" / "published_exact.csv"
    lines = list(csv.DictReader(line for line in file.read_text().splitlines() if not line.startswith("#")))
    assert len(lines) > 45
    for line in lines:
        expected = float(line["exact"])
        # 1e-9, or half a unit of the last digit where fewer are given.
        given = 0.5 * 10.0 ** -len(line["exact"].partition(".")[2])
        tolerance = max(1e-9 * abs(expected), 1.001 * given)
        found = value(rows(cases, int(line["case"]))[line["key"]])
        assert found == pytest.approx(expected, rel=0.0, abs=tolerance), line


def test_exact_values_to_a_billionth_by_other_means(cases: list[Case]) -> None:
    """Square roots in decimal arithmetic, trigonometric loop closure, and complex steps instead of the model."""
    feeder = rows(cases, 5)
    for key, e in (("stroke", 20), ("stroke_10", 10)):
        stroke = Decimal(104**2 - e**2).sqrt() - Decimal(24**2 - e**2).sqrt()
        assert value(feeder[key]) == pytest.approx(float(stroke), rel=1e-9)
    excess = math.degrees(math.asin(20 / 24) - math.asin(20 / 104))
    assert value(feeder["excess_angle"]) == pytest.approx(excess, rel=1e-9)
    assert value(feeder["time_ratio"]) == pytest.approx((180 + excess) / (180 - excess), rel=1e-9)
    assert value(feeder["greatest_rod_angle"]) == pytest.approx(math.degrees(math.asin(60 / 64)), rel=1e-9)
    theta = np.linspace(0.0, 2.0 * math.pi, 1_000_001)
    for e in (0, 10, 20):
        at = path(np.array([0.040, 0.064, -1e-3 * e]), theta, 1.0)
        torque = 1.05 * 251.0**2 * at.x_1 * at.x_2
        # 6e-6 rad between angles: with T'' up to 50 T the peak is 2e-10 of itself above the greatest of them.
        assert value(feeder[f"torque_{e}"]) == pytest.approx(float(np.abs(torque).max()), rel=1e-9)
        if e:
            forward = float(np.abs(torque[at.x_1 > 0.0]).max())
            assert value(feeder[f"forward_torque_{e}"]) == pytest.approx(forward, rel=1e-9)
        rotating = 0.35 * 0.040 * np.cos(theta)
        for key, sign in (("s", -1.0), ("20", 1.0)):
            formula = 0.040 * 251.0**2 * (rotating + sign * 1.05 * at.x_2) * at.rod_sine / at.rod_cosine
            assert value(feeder[f"formula_{key}_{e}"]) == pytest.approx(float(np.abs(formula).max()), rel=1e-9)

    support, step = rows(cases, 4), 1e-30
    shares = {"crank": (0, 1.4), "rod": (1, 1.8), "offset": (2, -0.05)}
    for number, line in enumerate(read_printed_table("position_error_table1.csv"), start=1):
        angle = math.radians(float(line["crank_angle_deg"]))
        design = np.array([1.4, 1.8, -0.05])
        at = path(design, angle, 1.0)
        assert value(support[f"position_{number}"]) == pytest.approx(1e3 * float(at.x), rel=1e-9)
        rod_angle = math.degrees(math.asin(-float(at.rod_sine)))
        assert value(support[f"rod_angle_{number}"]) == pytest.approx(rod_angle, rel=1e-9)
        total = 0.0
        for name, (index, error) in shares.items():
            moved = design.astype(complex)
            moved[index] += 1j * step * error
            exact = float(path(moved, angle, 1.0).x.imag) / step
            total += exact
            assert value(support[f"{name}_{number}"]) == pytest.approx(exact, rel=1e-9)
        exact = 1e3 * float(path(design, angle + 1j * step, 1.0).x.imag) / step * math.radians(0.1)
        assert value(support[f"crank_angle_{number}"]) == pytest.approx(exact, rel=1e-9)
        assert value(support[f"total_{number}"]) == pytest.approx(total + exact, rel=1e-9)


def test_every_cell_of_the_printed_table_is_a_row(cases: list[Case]) -> None:
    lines = read_printed_table("position_error_table1.csv")
    assert (len(lines), len(lines[0])) == (10, 8)  # the crank angle is given, seven columns are found
    printed = [row.printed for row in cases[3].rows if row.where.startswith("Table 1")]
    assert sorted(map(str, printed)) == sorted(text for line in lines for text in list(line.values())[1:])


def test_tables_are_as_printed(cases: list[Case], request: pytest.FixtureRequest) -> None:
    """The copy that ships is the one that the tests of the model read."""
    file = request.config.rootpath / "tests" / "data" / "position_error_table1.csv"
    body = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    assert read_printed_table("position_error_table1.csv") == list(csv.DictReader(body))


def test_every_verdict_has_what_it_needs(cases: list[Case]) -> None:
    for case in cases:
        assert case.rows
        for row in case.rows:
            assert (row.printed is None) == (row.verdict == "not printed"), row
            assert (row.exact is None) == (row.verdict == "not checkable"), row
            assert bool(row.why) == (row.verdict in ("misprint", "differs", "not checkable")), row
            assert row.printed is None or row.where, row
            assert row.exact is None or math.isfinite(row.exact), row


@pytest.mark.parametrize(
    ("case", "key", "verdict"),
    [
        (1, "open_acceleration", "agrees"),
        (2, "rod_mass", "agrees"),
        (2, "slider_mass", "agrees"),
        (2, "rod_Mxx", "differs"),
        (3, "crank_torque_size", "agrees"),
        (3, "rod_acceleration", "misprint"),
        (4, "crank_angle_5", "misprint"),
        (4, "offset_5", "agrees"),
        (5, "stroke", "differs"),
        (5, "time_ratio", "differs"),
        (5, "formula_s_0", "agrees"),
        (5, "formula_s_20", "differs"),
        (5, "equation_20", "misprint"),
        (5, "equation_20_mended", "agrees"),
        (5, "experiment_series_min", "agrees"),
        (5, "experiment_measured_max", "not checkable"),
    ],
)
def test_verdicts(cases: list[Case], case: int, key: str, verdict: str) -> None:
    assert rows(cases, case)[key].verdict == verdict


@pytest.mark.parametrize(
    ("entry", "exact", "agrees"),
    [
        ({"printed": "9.79"}, 9.7918, True),
        ({"printed": "9.79"}, 9.8001, False),
        ({"printed": "-29.03"}, -29.0255, True),
        ({"printed": "+5.42"}, -5.4174, False),
        ({"printed": "1.9", "decimals": 2}, 1.92, False),
        ({"printed": "about 80", "within": 5}, 84.9, True),
        ({"printed": "about 80", "within": 5}, 85.1, False),
        ({"printed": "< 50"}, 49.0, True),
        ({"printed": "< 50"}, 50.1, False),
        ({"printed": "13", "within": 0}, 13.0, True),
    ],
)
def test_a_number_is_confirmed_to_a_unit_of_its_last_printed_digit(
    entry: dict[str, object], exact: float, agrees: bool
) -> None:
    assert is_confirmed(entry, exact) == agrees


def test_reasons_hold(cases: list[Case]) -> None:
    """The claims with numbers in the reasons are true."""
    sieve, support, feeder = rows(cases, 2), rows(cases, 4), rows(cases, 5)
    for key, low in (("crank_mass", 0.2), ("crank_Mxx", 0.6), ("crank_Mzz", 0.3), ("rod_Mxx", 0.3), ("rod_Mzz", 0.1)):
        printed = float(str(sieve[key].printed))
        assert 100.0 * (1.0 - printed / value(sieve[key])) == pytest.approx(low, abs=0.05)
    for number, line in enumerate(read_printed_table("position_error_table1.csv"), start=1):
        factor = -(2.0 * math.pi - math.radians(float(line["crank_angle_deg"])))
        claimed = factor * value(support[f"crank_angle_{number}"])
        assert float(line["error_from_crank_angle_printed_mm"]) == pytest.approx(claimed, abs=0.01)
        parts = [float(line[name]) for name in line if name.startswith("error_")]
        # Four columns cut after two digits.
        assert float(line["total_printed_mm"]) == pytest.approx(sum(parts), abs=0.03)
    rod_of_122 = math.degrees(math.asin(20 / 82) - math.asin(20 / 162))
    assert float(str(feeder["excess_angle"].printed)) == pytest.approx(rod_of_122, abs=0.1)
    assert 20.994 * 60.0 / (2.0 * math.pi) == pytest.approx(200.48, abs=0.005)
    assert value(feeder["forward_torque_20"]) / value(feeder["return_torque_20"]) == pytest.approx(0.25, abs=0.01)


def test_command_shows_all_cases_with_reasons(command: Command) -> None:
    done = command("cases")
    assert done.exit_code == 0, done.stderr
    for number in CASES:
        assert f"Case {number}: " in done.stdout
    assert "all 10: misprint" in done.stdout
    assert "the exact value times -(2 pi - crank angle in rad)" in done.stdout
    assert "not printed" in done.stdout


def test_command_shows_one_case_in_full(command: Command) -> None:
    done = command("cases", "--case", 4)
    assert "Case 4" in done.stdout
    assert "Case 5" not in done.stdout
    assert done.stdout.count("error from the crank angle at") == 10
    assert command("cases", "--case", 6).exit_code == 2


def test_json_has_every_row(command: Command, cases: list[Case]) -> None:
    record = json.loads(command("cases", "--json").stdout)
    assert [case["number"] for case in record["cases"]] == list(CASES)
    for case, expected in zip(record["cases"], cases, strict=True):
        assert len(case["rows"]) == len(expected.rows)
        for row, same in zip(case["rows"], expected.rows, strict=True):
            assert row["exact"] == same.exact
            assert row["verdict"] == same.verdict
            assert set(row) == {"key", "what", "unit", "where", "printed", "formula", "exact", "verdict", "why"}


def test_figures_of_one_case_are_drawn(command: Command, tmp_path: Path) -> None:
    done = command("cases", "--case", 3, "--figures", tmp_path / "figures", "--json")
    assert done.exit_code == 0, done.stderr
    files = sorted(file.name for file in (tmp_path / "figures").iterdir())
    assert files == ["case_3_motion_and_forces.png"]


def test_case_2_has_the_figure_of_its_loose_joint_too(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The simulation takes long and has its own tests; here only what is simulated counts."""
    drawn: list[tuple[object, ...]] = []
    monkeypatch.setattr(figures, "speed_runs", lambda *given: drawn.append(given))
    monkeypatch.setattr(figures, "speeds_figure", lambda _: new_figure(1.0, 1.0))
    names = [file.name for file in draw_cases([2], tmp_path)]
    assert names == ["case_2_motion.png", "case_2_sensitivity.png", "case_2_clearance.png"]
    assert drawn == [(case_2.LOOSE, case_2.SIEVE)]
    assert case_2.LOOSE.clearance == Clearance(joint="crank pin", radius=1e-3, journal_radius=0.01)
