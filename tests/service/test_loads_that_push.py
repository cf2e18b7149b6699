"""A load that pushes with the stroke: what `check`, a front and its report say of it."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.service.report.document import Facts, Paragraph
from slidercrank.service.report.job_and_front import job_section
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import result_of
from tests.service import fronts
from tests.service.conftest import Command

PUSH = """
[[load]]
positions = ["0 mm", "60 mm"]
forces = ["350 N", "350 N"]
measured_from = "outer dead centre"
during = "outward stroke"
"""
SENTENCE = (
    "350 N outward, helps the outward stroke, from 60 mm before the outer dead centre to it; "
    "constant beyond, hence everywhere"
)
QUESTION = f"in every {{}} loads do more work on the machine than they absorb, by 98 J per cycle: load #1 ({SENTENCE})"


def test_check_says_of_a_load_what_it_does_and_questions_one_that_pushes(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text() + PUSH)
    found = command("check", job).stdout
    assert f"load: {SENTENCE}" in found
    assert QUESTION.format("sampled design") in found
    record = json.loads(command("check", job, "--json").stdout)
    assert record["loads"] == [SENTENCE]
    assert any(sentence.startswith(QUESTION.format("sampled design")) for sentence in record["warnings"])
    job.write_text(job.read_text().replace('"350 N"', '"-350 N"'))
    found = command("check", job).stdout
    assert "load: 350 N inward, resists the outward stroke, from 60 mm before" in found
    assert "do more work" not in found


def test_a_run_has_the_same_numbers_on_the_terminal_and_in_its_report(tmp_path: Path, command: Command) -> None:
    job = fronts.job_file(tmp_path)
    job.write_text(job.read_text().replace('{ equals = "280 mm" }', '{ min = "200 mm", max = "280 mm" }') + PUSH)
    place, file = tmp_path / "runs", tmp_path / "report.html"
    assert command("optimise", job, "--runs", place, "--no-figures").exit_code == 0
    shown = command("front", "latest", "--runs", place).output
    told = re.findall(r"more work on the machine than they absorb, by .*? per cycle", shown)
    assert len(told) == 1
    reported = command("report", "latest", "--runs", place, "--design", 1, "--out", file)
    assert told[0] in file.read_text(encoding="utf-8")
    for done in (reported, command("analyse", "latest", "--runs", place, "--design", 1)):
        assert done.exit_code == 0, done.output
        assert "sampled" not in done.output


def test_a_report_of_a_design_says_both_too() -> None:
    push = PositionTable(
        positions=(0.0, 0.06), forces=(350.0, 350.0), datum="outer dead centre", during="outward stroke"
    )
    found = fronts.front(fronts.FOUR[:2], designs=4, mechanism=replace(fronts.MACHINE, loads=(push,)))
    result = result_of(found, "kept")
    assert any(sentence.startswith(QUESTION.format("design")) for sentence in result.warnings)
    facts, *warned = job_section(Subject(found.problem, result, 1, run="kept", versions={})).blocks
    assert isinstance(facts, Facts)
    assert f"load: {SENTENCE}" in facts.rows["Given"]
    assert any(isinstance(each, Paragraph) and QUESTION.format("design") in each.text for each in warned)
