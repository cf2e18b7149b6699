"""Report on one design, from its summary to the versions of the software that computed it."""

import time

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import count_with_noun, metric_key, unit_text
from ...objectives.lengths_and_time_ratio import STROKE
from ...objectives.swing_quantities import ACTUATOR_TRAVEL, SWING_ANGLE
from ..designs.changed_design import Variation
from ..designs.columns import choice_column_keys, find_column
from ..render.numerals import format_cell, format_cell_with_unit
from ..text.job_in_words import machine_in_words
from .decision_section import decision_section
from .design_section import design_section, linkage_picture, numbers_section
from .document import Facts, Report, Section
from .job_and_front import front_section, job_section, search_section
from .measured_section import measured_section
from .sensitivity_and_tolerance_sections import sensitivity_section, tolerance_section
from .subject import Subject
from .swing_section import SwingOfSubject, lever_section


def design_report(subject: Subject, *, created: float | None = None) -> Report:
    """Return the report on a design. created: time of the report, s since 1970; None for now."""
    when = time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime(created))
    motion, decision = subject.design.part.motion, decision_section(subject)
    swing = None if motion is None or motion.of_lever else SwingOfSubject(subject, motion)
    is_decided = subject.bookmark is not None and subject.bookmark.decided
    tolerances = None if motion is not None else tolerance_section(subject)
    if swing is not None:
        tolerances = swing.tolerances()
    return Report(
        title=f"{subject.result.name}: {subject.name}",
        subtitle=f"{'Chosen design' if is_decided else 'Design report'} for review; run {subject.run}",
        date=when,
        sections=(
            _summary_section(subject),
            *([] if decision is None else [decision]),
            job_section(subject),
            search_section(subject, when),
            front_section(subject),
            design_section(subject),
            *([lever_section(subject, motion)] if motion is not None and motion.driver == "cylinder" else []),
            *([] if swing is None else [swing.numbers_section()]),
            *([] if tolerances is None else [tolerances]),
            *([] if subject.measured is None else [measured_section(subject, subject.measured)]),
            sensitivity_section(subject),
            numbers_section(subject),
        ),
    )


def _summary_section(subject: Subject) -> Section:
    row = subject.row
    keys = {metric_key(key) for key in row}
    size_names = [item.name for item in (STROKE, ACTUATOR_TRAVEL, SWING_ANGLE) if item.field in keys]
    columns = [find_column(name, list(row)) for name in (*DIMENSIONS, *size_names)]
    lengths = [
        f"{item.title} {subject.format_cell(item.key, row[item.key])} {unit_text(item.unit)}" for item in columns
    ]
    rows = {
        "Lengths": [", ".join(lengths)],
        "Objectives": [
            f"{item.title} {format_cell_with_unit(row[item.column], item.unit)}" for item in subject.result.objectives
        ],
        "Choices": [_format_choice(subject, key) for key in choice_column_keys(row)] if subject.problem.choices else [],
        "Beyond the allowable values": [unit_text(line) for line in subject.violation_sentences],
        "Machine": _machine_lines(subject),
        "What it is": _best_objectives(subject)
        if subject.changed is None
        else _change_sentences(subject, subject.changed),
    }
    facts = Facts({title: lines for title, lines in rows.items() if lines})
    return Section("Summary", (facts, linkage_picture(subject)))


def _format_choice(subject: Subject, key: str) -> str:
    """Return a choice, or a value derived from it, in words."""
    column, value = find_column(key, list(subject.row)), subject.row[key]
    custom = next((quantity for quantity in subject.problem.own if quantity.field == key), None)
    title, unit = (column.title, column.unit) if custom is None else (custom.title, custom.unit.symbol)
    return f"{title} {value}" if isinstance(value, str) else f"{title} {format_cell_with_unit(value, unit)}"


def _machine_lines(subject: Subject) -> list[str]:
    """Return the lines on a design's machine that differ from the job's, due to variables or choices."""
    stated = machine_in_words(subject.problem, subject.problem.mechanism)
    lines = machine_in_words(subject.problem, subject.design.mechanism)
    return [unit_text(line) for line in lines if line not in stated]


def _best_objectives(subject: Subject) -> list[str]:
    """Return the objectives in which a design on the front is best."""
    marks = [name for name, place in subject.result.extremes.items() if place == subject.number - 1]
    words = [f"best on the front in {name.replace('_', ' ')}" for name in marks]
    if subject.result.knee == subject.number - 1 and len(subject.result.objectives) > 1:
        words.append("knee of the front: nearest to the best values of all objectives")
    return words


def _change_sentences(subject: Subject, changed: Variation) -> list[str]:
    """Return sentences on the changes to a design on the front, and on their effect."""
    before = subject.result.designs[subject.number - 1]
    changes = [
        f"{name} {format_cell_with_unit(subject.row[column.key], column.unit)} instead of "
        f"{format_cell_with_unit(before[column.key], column.unit)}"
        for name, column in ((name, find_column(name, list(before))) for name in DIMENSIONS)
        if format_cell(subject.row[column.key]) != format_cell(before[column.key])
    ]
    sentences = [f"design {subject.number} of {len(subject.result.designs)} with other lengths: {', '.join(changes)}"]
    if changed.outside:
        sentences.append(
            f"outside the ranges of the job: {', '.join(key.removesuffix('_mm') for key in changed.outside)}"
        )
    if changed.broken:
        sentences.append("misses requirements of the job; see below")
    sentences += subject.deviations
    better, beaten = len(changed.dominated_by), len(changed.dominates)
    if better:
        sentences.append(f"{count_with_noun(better, 'design')} of the front at least as good in every objective")
    elif beaten and not changed.broken:
        sentences.append(f"dominates {count_with_noun(beaten, 'design')} of the front")
    else:
        sentences.append("no listed design is better in every objective")
    return sentences
