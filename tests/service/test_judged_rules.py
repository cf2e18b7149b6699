"""Whether a design that is analysed meets the rules of its job."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.service import fronts
from tests.service.conftest import Command

DESIGN = ("--rod", "400 mm", "--offset", "100 mm")


def rules(command: Command, job: Path, crank: str) -> dict[str, dict[str, object]]:
    done = command("analyse", job, "--crank", crank, *DESIGN, "--json")
    assert done.exit_code == 0, done.stderr
    return {rule["quantity"]: rule for rule in json.loads(done.stdout)["rules"]}


def test_each_rule_has_its_value_and_by_how_much_it_is_missed(tmp_path: Path, command: Command) -> None:
    found = rules(command, fronts.job_file(tmp_path), "130 mm")
    stroke = found["stroke"]
    assert (stroke["met"], stroke["lower"], stroke["upper"]) == (False, 280.0, 280.0)
    # Dead centres at sqrt((l +- r)^2 - e^2).
    value = (530.0**2 - 100.0**2) ** 0.5 - (270.0**2 - 100.0**2) ** 0.5
    assert stroke["value"] == pytest.approx(value)
    assert stroke["missed_by"] == pytest.approx(280.0 - value)
    assert found["transmission_angle"]["met"]
    assert found["crank"]["missed_by"] == 0.0


def test_a_dimension_out_of_its_range_is_told(tmp_path: Path, command: Command) -> None:
    assert rules(command, fronts.job_file(tmp_path), "210 mm")["crank"]["missed_by"] == pytest.approx(10.0)


def test_a_dimension_between_two_of_its_choices_meets_neither(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    text = job.read_text()
    assert 'crank = ["20 mm", "200 mm"]' in text
    job.write_text(text.replace('crank = ["20 mm", "200 mm"]', 'crank = { choices = ["120 mm", "140 mm"] }'))
    found = rules(command, job, "137 mm")["crank"]
    assert (found["met"], found["lower"]) == (False, 140.0)
    assert found["missed_by"] == pytest.approx(3.0)


def test_the_table_says_what_is_not_met_first(tmp_path: Path, command: Command) -> None:
    text = command("analyse", fronts.job_file(tmp_path), "--crank", "130 mm", *DESIGN).stdout
    assert "Not met: stroke (exactly 280 mm) is 269.68" in text
    assert text.index("Not met") < text.index("  met: crank (at least 20 mm, at most 200 mm): 130 mm")


@pytest.mark.parametrize("change", [1e-4, 1e-6, -1e-7])
def test_a_small_miss_has_the_digits_that_show_it(tmp_path: Path, command: Command, change: float) -> None:
    # r^2 = S^2 (l^2 - e^2 - S^2 / 4) / (4 l^2 - S^2)
    crank = 280.0 * ((400.0**2 - 100.0**2 - 280.0**2 / 4.0) / (4.0 * 400.0**2 - 280.0**2)) ** 0.5
    text = command("analyse", fronts.job_file(tmp_path), "--crank", f"{crank * (1.0 + change)!r} mm", *DESIGN).stdout
    (found,) = re.findall(r"Not met: stroke \(exactly 280 mm\) is ([\d.]+) mm, by ([-+\d.e]+) mm\.", text)
    value, miss = map(float, found)
    assert abs(value - 280.0) == pytest.approx(miss, rel=0.1)
    assert (value > 280.0) == (change > 0.0)


def test_without_a_job_there_are_no_rules(command: Command) -> None:
    done = command("analyse", "--crank", "130 mm", *DESIGN, "--json")
    assert "rules" not in json.loads(done.stdout)
