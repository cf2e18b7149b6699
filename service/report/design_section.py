"""Chosen design in a report: drawing, requirements, stationarity, trade-offs, and all its numbers."""

import math
from functools import partial
from typing import get_args

from ...model.errors import InputError
from ...model.swing.swing import CRANK_TURN
from ...objectives.kinds import column_key_in_system, metric_key, unit_text
from ...objectives.machine_needs import Consequence
from ...objectives.registry import QUANTITIES
from ..designs.columns import Column, all_columns
from ..designs.display_units import row_without_noise
from ..designs.length_with_tolerance import format_toleranced
from ..designs.trade_offs import trade_offs_of
from ..drawings.design_drawing import design_drawing
from ..figures.front_figures import datasheet_of
from ..figures.shape_painting import drawing_figure
from ..render.numerals import format_cell
from .document import Block, Paragraph, Picture, Section, Table
from .subject import Subject

_MET = 1e-6  # tolerance of a slack in its unit: constraints are met within rounding


def design_section(subject: Subject) -> Section:
    """Return requirements, stationarity, trade-offs and curves of the design."""
    return Section(
        subject.label[:1].upper() + subject.label[1:],
        (
            *_requirement_blocks(subject),
            *(
                Paragraph(f"Beyond the allowable value: {unit_text(line)}.", "bad")
                for line in subject.violation_sentences
            ),
            *_optimality_blocks(subject),
            Picture(
                "The design over a turn of the crank"
                if subject.design.part.motion in (None, CRANK_TURN)
                else "The design over its swing",
                partial(
                    datasheet_of, subject.front, subject.number - 1, subject.label, subject.system, subject.changed
                ),
            ),
        ),
    )


def numbers_section(subject: Subject) -> Section:
    """Return every column that applies to the design's machine, rounded and as stored."""
    columns, absent = _applicable_columns(subject)
    lengths = _dimensions_with_tolerance(subject)
    at_bound = {column.key for column in columns if column.key.startswith("slack_") and _is_active(subject, column)}
    row = row_without_noise(subject.row)
    rows = tuple(
        (
            column.title,
            lengths.get(column.key, "0" if column.key in at_bound else format_cell(row[column.key])),
            unit_text(column.unit),
            column.key,
        )
        for column in columns
    )
    objectives = {objective.column for objective in subject.result.objectives}
    return Section(
        "Every number of the design",
        (
            Paragraph(
                "Objectives in bold. Dimensions have the digits of their tolerances. The last column is the name "
                "under which files give every digit.",
                "note",
            ),
            *([Paragraph(f"Not defined for this machine: {', '.join(absent)}.", "note")] if absent else []),
            Table(
                "",
                ("quantity", "value", "unit", "column"),
                rows,
                (0.38, 0.17, 0.09, 0.36),
                frozenset({1}),
                frozenset(place for place, column in enumerate(columns) if column.key in objectives),
                small=True,
            ),
        ),
    )


def _applicable_columns(subject: Subject) -> tuple[list[Column], list[str]]:
    """Return the columns that apply to a design's machine, and titles of the others, such as a loss without friction.

    Quantities that the job uses are never omitted.
    """
    part, mechanism = subject.design.part, subject.design.mechanism
    quantity_of_column = {
        column_key_in_system(quantity.field, subject.system)[0]: quantity
        for quantity in (*QUANTITIES.values(), *part.own)
    }
    required = {item.column for item in subject.result.objectives} | {
        slack.removeprefix("slack_") for slack in _bounds_by_slack_column(subject)
    }
    columns, absent = [], []
    for column in all_columns(subject.row):
        value, quantity = subject.row[column.key], quantity_of_column.get(column.key)
        is_absent = value is None or (isinstance(value, float) and math.isnan(value))
        if quantity is not None and column.key not in required:
            is_absent = is_absent or any(quantity.unmet_need(mechanism, word) for word in get_args(Consequence))
        if is_absent and column.key not in required:
            absent.append(column.title)
        else:
            columns.append(column)
    return columns, absent


def _dimensions_with_tolerance(subject: Subject) -> dict[str, str]:
    """Return the dimensions that have a tolerance, by column, with the digits that it justifies."""
    texts = {}
    for key, tolerance in subject.tolerances.items():
        value = subject.row.get(key)
        if isinstance(value, float):
            texts[key] = format_toleranced(value, tolerance).replace("-", "−")
    return texts


def _requirement_blocks(subject: Subject) -> list[Block]:
    slacks = [column for column in all_columns(subject.row) if column.key.startswith("slack_")]
    if not slacks:
        return [Paragraph("The job sets no requirements besides the ranges of the dimensions.", "note")]
    rows, all_met, bounds, deviations = [], True, _bounds_by_slack_column(subject), subject.deviations
    allowed = {
        rule.slack for rule in subject.requirements if rule.allowed and rule.missed_by(subject.metric_row) == 0.0
    }
    for column in slacks:
        slack, value = subject.row[column.key], subject.row.get(column.key.removeprefix("slack_"))
        active = _is_active(subject, column)
        is_met = active or (isinstance(slack, float) and slack >= 0.0)
        is_allowed = metric_key(column.key) in allowed
        all_met = all_met and (is_met or is_allowed)
        state = "met, active" if active and is_met else "met" if is_met else "allowed" if is_allowed else "not met"
        title = column.title.removeprefix("slack of ")
        distance = "0" if active else format_cell(slack)
        bound = bounds.get(column.key, "")
        rows.append((title, bound, format_cell(value), distance, unit_text(column.unit), state))
    met = "; ".join(["All requirements are met", *deviations]) + "."
    verdict = met if all_met else "Not all requirements are met: see below."
    return [
        Paragraph(verdict, "good" if all_met else "bad"),
        Table(
            "Requirements: the slack is the distance to the nearer bound",
            ("quantity", "asked", "value", "slack", "unit", "state"),
            tuple(rows),
            (0.32, 0.2, 0.13, 0.13, 0.09, 0.13),
            frozenset({2, 3}),
        ),
    ]


def _bounds_by_slack_column(subject: Subject) -> dict[str, str]:
    """Return the bounds of each requirement on the design, including those from its choices, by slack column."""
    bounds = {}
    for item in subject.requirements:
        key, factor = column_key_in_system(item.slack, subject.system)
        ends = [("at least", item.lower), ("at most", item.upper)]
        if item.lower == item.upper:
            ends = [("equal to", item.lower)]
        bounds[key] = " and ".join(f"{word} {format_cell(end * factor)}" for word, end in ends if end is not None)
    return bounds


def _is_active(subject: Subject, column: Column) -> bool:
    """Whether a slack is zero within rounding."""
    slack, value = subject.row[column.key], subject.row.get(column.key.removeprefix("slack_"))
    size = max(1.0, abs(value)) if isinstance(value, float) and math.isfinite(value) else 1.0
    return isinstance(slack, float) and abs(slack) <= _MET * size


def _optimality_blocks(subject: Subject) -> list[Block]:
    residual, status = subject.row.get("residual"), subject.row.get("status")
    blocks: list[Block] = []
    if subject.changed is not None:
        blocks.append(Paragraph("This design is not on the front; no better one was searched for.", "note"))
    if status == "stationary":
        condition = "while the requirements hold"
        text = f"Stationary: no small change improves every objective {condition} (residual {format_cell(residual)})."
        blocks.append(Paragraph(text, "good"))
    elif status is not None:
        text = f"Best found, but not shown to be stationary (residual {format_cell(residual)})."
        blocks.append(Paragraph(text, "plain"))
    if len(subject.result.objectives) < 2 or subject.changed is not None:
        return blocks
    try:
        sentences = trade_offs_of(subject.front, subject.number - 1, subject.design, subject.system)
    except InputError as error:
        return [*blocks, Paragraph(f"Trade-off rates: {error}.", "note")]
    if sentences:
        blocks.append(Paragraph("Trade-offs here, to first order: " + unit_text("; ".join(sentences)) + "."))
    return blocks


def linkage_picture(subject: Subject) -> Picture:
    """Return the scale drawing of the design."""
    name, label = subject.result.name, subject.label
    return Picture(
        "The linkage, to scale",
        lambda: drawing_figure(design_drawing(subject.design, name=name, design=label, system=subject.system)),
        tallest=3.6,
    )
