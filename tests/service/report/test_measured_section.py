"""Measured curves in a report: every number of them, in either system, on pages that hold them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from slidercrank.objectives.tables.measured_curves import Measured, samples_of_measured_table
from slidercrank.optimise.problem.design_analysis import Analysis
from slidercrank.service.designs.design_curves import cycle_csv
from slidercrank.service.designs.measured_curves_file import parse_measured_curves
from slidercrank.service.questions.measured.analysis import numbers
from slidercrank.service.render.numerals import format_number
from slidercrank.service.report.design_report import design_report
from slidercrank.service.report.document import Paragraph, Picture, Section, Table
from slidercrank.service.report.html import html_file
from slidercrank.service.report.measured_section import measured_section
from slidercrank.service.report.pdf import pdf_file
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import result_of
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.report.paper import paper


@pytest.fixture(scope="module")
def subject() -> Subject:
    """Return a design of a front made without a search."""
    found = fronts.front(fronts.FOUR[:2], designs=4)
    return Subject(found.problem, result_of(found, "kept"), 2, run="kept", versions={})


def samples(subject: Subject) -> Measured:
    design = subject.design
    analysis = Analysis(design.mechanism, design.linkage, {}, {}, ())
    cycle = analysis.cycle(40)
    table = {"crank_angle_rad": cycle.crank_angle_rad + 0.1, "torque_Nm": cycle.torque_Nm - 3.0, "room": cycle.load_N}
    return samples_of_measured_table(table, design.mechanism, design.linkage)


@pytest.mark.parametrize("system", ["metric", "inch"])
def test_every_number_is_in_its_tables(subject: Subject, system: str) -> None:
    measured = samples(subject)
    section = measured_section(replace(subject, system=system), measured)  # type: ignore[arg-type]
    deviation, shift, note, picture = section.blocks
    assert isinstance(deviation, Table)
    assert isinstance(shift, Table)
    assert isinstance(note, Paragraph)
    assert isinstance(picture, Picture)
    (entry,) = numbers(subject.design.mechanism, subject.design.linkage, measured=measured)["curves"].values()
    factor, unit = (1.0, "N m") if system == "metric" else (8.850745791327183, "lbf in")
    values = [format_number(factor * entry[f"{name}_Nm"], 6) for name in ("rms", "mean", "largest")]
    assert deviation.rows == (
        ("drive torque", "40", *values, format_number(entry["largest_at_crank_angle_deg"], 6), unit),
    )
    assert shift.rows[0][1] == format_number(entry["best_crank_angle_shift_deg"], 6)
    assert entry["best_crank_angle_shift_deg"] == pytest.approx(np.degrees(-0.1), abs=1e-5)
    assert shift.rows[0][2] == format_number(factor * entry["best_shift_Nm"], 6)
    assert note.text == "Columns that are empty or not a curve, omitted: room."
    (panel,) = picture.draw().axes
    assert panel.get_title(loc="left") == f"drive torque, {unit}"


def test_a_report_has_them_where_they_are_given(subject: Subject) -> None:
    titles = [section.title for section in design_report(subject).sections]
    made = design_report(replace(subject, measured=samples(subject)))
    with_them = [section.title for section in made.sections]
    assert [title for title in with_them if title != "Measured curves"] == titles
    assert len(with_them) == len(titles) + 1
    assert b"Measured minus computed, 40 rows" in html_file(made)


@pytest.mark.slow
def test_all_curves_at_once_are_spread_over_pages(subject: Subject) -> None:
    design = subject.design
    measured = parse_measured_curves(cycle_csv(design.mechanism, design.linkage), design.mechanism, design.linkage)
    section: Section = measured_section(subject, measured)
    pictures = [block for block in section.blocks if isinstance(block, Picture)]
    assert len(measured.values) == 18
    assert len(pictures) == 3
    only = replace(design_report(subject), sections=(section,))
    assert min(inset.scale for page in paper(pdf_file(only)) for inset in page.insets) > 0.4


def test_the_command_writes_them_and_refuses_a_bad_file(tmp_path: Path, kept: Path, command: Command) -> None:
    file, out = tmp_path / "measured.csv", tmp_path / "report.html"
    arguments = ("report", "latest", "--runs", kept, "--design", 1, "--measured", file, "--out", out)
    file.write_text("crank_angle_deg,slider_position_mm\n0,300\n90,x\n")
    refused = command(*arguments)
    assert refused.exit_code == 2
    assert 'row 3, column "slider_position_mm": must be a number; got "x"' in refused.stderr
    assert not out.exists()
    file.write_text("crank_angle_deg,slider_position_mm\n0,300\n90,200\n")
    assert command(*arguments).exit_code == 0
    assert "Measured minus computed, 2 rows" in out.read_text()
    assert (
        "Interpretation of the file: 2 rows of crank_angle_deg, slider_position_mm; first 0, 300; " in out.read_text()
    )
