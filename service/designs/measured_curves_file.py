"""Measured curves in a file, as written by data loggers and spreadsheets."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import Kind
from ...objectives.tables.measured_curves import Measured, meaningful_columns, samples_of_measured_table
from ...objectives.units import to_si, unit_in_heading
from ...optimise.job.text_table import decode_file_text, read_file_bytes, read_table

_LARGEST = 300_000_000  # bytes: millions of rows
_NAME = "a measured file"


def text_of_measured_file(path: Path) -> str:
    """Return the text of a file. Raises `InputError` for a file that cannot be read, is too large or is not text."""
    return decode_file_text(read_file_bytes(path, f"{_NAME}, {path},", _LARGEST), _NAME)


def parse_measured_curves(text: str, mechanism: Mechanism, linkage: Linkage) -> Measured:
    """Return the samples in the text of a file.

    Raises `InputError` if the text is not a table, or has impossible values.
    """
    table = read_table(text, _NAME, ragged=True)
    names = [name for name in table.heads if name]
    curve_names = meaningful_columns(names, mechanism, linkage, _unit_in_si)
    places = [place for place, name in enumerate(table.heads) if name in curve_names]
    columns = dict(
        zip((table.heads[place] for place in places), table.number_columns(places, missing=places), strict=True)
    )
    nothing = np.full(len(table), np.nan)
    measured = samples_of_measured_table(
        {name: columns.get(name, nothing) for name in names}, mechanism, linkage, _unit_in_si
    )
    return replace(measured, understood=table.summary_text(places))


def _unit_in_si(text: str, kind: Kind) -> float | None:
    """Return the SI value of any unit that jobs may use; None for a unit of another kind."""
    symbol = unit_in_heading(text.replace("_", " "), kind)
    return None if symbol is None else to_si(f"1 {symbol}", kind)
