"""Section of a report on a lever moved by a cylinder: the numbers of its swing."""

from ...model.swing.swing import Swing
from ..questions.lever.analysis import blocks, compute_shared_options, numbers
from ..render.blocks import Table as Numbers
from ..render.formatting import table_cells
from .document import Block, Paragraph, Section, Table
from .subject import Subject


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
