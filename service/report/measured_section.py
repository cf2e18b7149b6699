"""Measured curves beside the computed ones of the design."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from ...objectives.counted import counted
from ...objectives.kinds import unit_text
from ...objectives.tables.measured import Measured
from ..designs.shown_units import record_in
from ..figures.numerals import rounded
from ..figures.panels import draw_sheet
from ..figures.sheets import Sheet
from ..topics.measured.analysis import figure, left_out, numbers, told
from .document import Block, Paragraph, Picture, Section, Table
from .subject import Subject

_PANELS = 6
_ADDED = "Shifts that, added to what was measured, fit best; not applied above"


def measured_section(subject: Subject, measured: Measured) -> Section:
    """Return the deviation of each measured curve, the shifts that fit best, and the figure."""
    mechanism, linkage = subject.design.mechanism, subject.design.linkage
    found = numbers(mechanism, linkage, measured=measured)
    curves = [told(entry) for entry in record_in(found, subject.system)["curves"].values()]
    deviations = tuple(
        (
            str(curve["title"]),
            str(curve["samples"]),
            *(rounded(curve[name]) for name in ("rms", "mean", "largest", "largest_at_crank_angle")),
            unit_text(unit),
        )
        for curve, unit in curves
    )
    shifts = tuple(
        (
            str(curve["title"]),
            *(rounded(curve[name]) for name in ("best_crank_angle_shift", "best_shift", "left_rms")),
            unit_text(unit),
        )
        for curve, unit in curves
    )
    blocks: tuple[Block, ...] = (
        Table(
            f"Measured minus computed, {counted(found['rows'], 'row')}",
            ("curve", "samples", "RMS", "mean", "largest", "at, deg", "unit"),
            deviations,
            (0.32, 0.12, 0.12, 0.12, 0.12, 0.1, 0.1),
            frozenset({1, 2, 3, 4, 5}),
        ),
        Table(
            _ADDED,
            ("curve", "crank angle, deg", "value", "RMS left", "unit"),
            shifts,
            (0.36, 0.2, 0.17, 0.17, 0.1),
            frozenset({1, 2, 3}),
        ),
        *(Paragraph(f"{line}.", "note") for line in left_out(found)),
        *_pictures(figure(mechanism, linkage, measured=measured)),
    )
    return Section("Measured curves", blocks)


def _pictures(sheet: Sheet) -> list[Picture]:
    """Return the panels, as many in a picture as a page shows well."""
    parts = [sheet.panels[start : start + _PANELS] for start in range(0, len(sheet.panels), _PANELS)]
    return [
        Picture("Measured and computed", partial(draw_sheet, replace(sheet, panels=part)), raster=True)
        for part in parts
    ]
