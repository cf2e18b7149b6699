"""Sections of a report on a swinging design or lever: numbers, extremes of curves, sources of errors."""

import math
from functools import cached_property

from ...model.swing.request_and_summary import SwingSummary, error_shares, summarise_swing
from ...model.swing.swing import Swing
from ...objectives.kinds import metric_unit_in
from ...objectives.tables.swing_curves import driven_side_name, kind_of_driven_side_error
from ..questions.lever.analysis import blocks, compute_shared_options, numbers
from ..questions.swing.analysis import blocks as swing_blocks
from ..questions.swing.analysis import swing_record, swing_title
from ..render.blocks import Table as Numbers
from ..render.formatting import table_cells, table_headings
from ..render.numerals import format_cell, format_length
from .document import Block, Paragraph, Section, Table
from .subject import Subject


class SwingOfSubject:
    """Swing of the reported design, computed once."""

    def __init__(self, subject: Subject, swing: Swing) -> None:
        self._subject, self._swing = subject, swing

    @cached_property
    def summary(self) -> SwingSummary:
        """Numbers of the swing."""
        design = self._subject.design
        return summarise_swing(design.mechanism, design.linkage, self._swing)

    def numbers_section(self) -> Section:
        """Return the numbers of the swing, and the extremes of its curves."""
        record, system = swing_record(self._subject.design.mechanism, self.summary), self._subject.system
        tables = [block for block in swing_blocks(record) if isinstance(block, Numbers)]
        numbers, extremes = (table_cells(table, system, printed=True) for table in tables)
        named, wide = ("", "value", "unit", "where"), (0.38, 0.14, 0.08, 0.4)
        blocks: list[Block] = [
            Table(swing_title(record), named, numbers, wide, frozenset({1})),
            *(Paragraph(f"{note[0].upper()}{note[1:]}.", "note") for note in record["notes"]),
        ]
        title, widths = "Extremes of the curves over both strokes", (0.25, 0.11, 0.1, 0.12, 0.12, 0.1, 0.12, 0.08)
        blocks.append(Table(title, table_headings(tables[1], system), extremes, widths, frozenset(range(1, 7))))
        return Section("The swing", tuple(blocks))

    def tolerances(self) -> Section | None:
        """Return the error sources on the driven side; None for a job without tolerances."""
        worst, design, system = self.summary.position_error, self._subject.design, self._subject.system
        if worst is None:
            return None
        shares = error_shares(design.mechanism, design.linkage, self.summary.swing, worst.crank_angle)
        total, unit_of_error = (
            sum(share.error for share in shares),
            kind_of_driven_side_error(self.summary.swing).metric,
        )
        unit, factor = metric_unit_in(unit_of_error.symbol, system)
        rows = tuple(
            (
                share.source,
                f"{format_cell(math.degrees(share.limit))} deg"
                if share.source == "crank angle"
                else format_length(1e3 * share.limit, system, 6),
                format_cell(factor * unit_of_error.factor * share.error),
                f"{100.0 * share.error / total:.1f}",
            )
            for share in shares
        )
        driven_quantity = "crank angle" if driven_side_name(self.summary.swing) == "crank" else "slider position"
        sentence = (
            f"The {driven_quantity} is off by {format_cell(factor * unit_of_error.factor * worst.value)} {unit} at "
            f"most, at a crank angle of {format_cell(math.degrees(worst.crank_angle))} deg: worst case of all sources, "
            "to first order."
        )
        table = Table(
            f"Sources of the error of the {driven_quantity} there",
            ("source", "limit", f"adds, {unit}", "share, %"),
            rows,
            (0.4, 0.2, 0.2, 0.2),
            frozenset({1, 2, 3}),
        )
        return Section("Tolerances", (Paragraph(sentence), table))


def lever_section(subject: Subject, swing: Swing) -> Section:
    """Return the numbers of the swing, as the command `lever` has them."""
    design, system = subject.design, subject.system
    request = compute_shared_options(design.mechanism, design.linkage, swing=swing)["request"]
    record = numbers(design.mechanism, design.linkage, request=request)
    tables = [block for block in blocks(record) if isinstance(block, Numbers)]
    report_tables: list[Block] = [
        Table(
            "The lever and its cylinder",
            ("", "value", "unit", "where"),
            table_cells(table, system, printed=True),
            _WIDTHS,
        )
        for table in tables
    ]
    notes = (Paragraph(f"{note[0].upper()}{note[1:]}.", "note") for note in record["notes"])
    return Section("The swing", (*report_tables, *notes))


_WIDTHS = (0.38, 0.14, 0.08, 0.4)
