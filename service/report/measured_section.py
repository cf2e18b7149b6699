"""Measured curves beside the computed curves of the design."""

from dataclasses import replace
from functools import partial

from ...objectives.kinds import System, count_with_noun
from ...objectives.tables.measured_curves import Measured
from ..figures.panel_drawing import draw_panel_figure
from ..figures.panel_figure import PanelFigure
from ..questions.measured.analysis import curve_value, figure, file_notes, numbers
from ..render.blocks import Unit
from ..render.formatting import format_text
from .document import Block, Paragraph, Picture, Section, Table
from .subject import Subject

_PANELS = 6
_ADDED = "Shifts that, added to the measured curves, give the best fit; not applied above"


def measured_section(subject: Subject, measured: Measured) -> Section:
    """Return the deviation of each measured curve, the best-fit shifts, and the figure."""
    mechanism, linkage = subject.design.mechanism, subject.design.linkage
    deviations_found = numbers(mechanism, linkage, measured=measured)
    deviations, shifts = [], []
    for entry in deviations_found["curves"].values():
        names = ("rms", "mean", "largest", "largest_at_crank_angle", "best_crank_angle_shift", "best_shift", "left_rms")
        values = [curve_value(entry, name, missing="–") for name in names]
        title, unit = entry["title"], format_text(Unit(values[0].kind), subject.system)
        texts = [format_text(value, subject.system, bare=True, printed=True) for value in values]
        deviations.append((title, str(entry["samples"]), *texts[:4], unit))
        shifts.append((title, *texts[4:], unit))
    blocks: tuple[Block, ...] = (
        Table(
            f"Measured minus computed, {count_with_noun(deviations_found['rows'], 'row')}",
            ("curve", "samples", "RMS", "mean", "largest", "at, deg", "unit"),
            tuple(deviations),
            (0.32, 0.12, 0.12, 0.12, 0.12, 0.1, 0.1),
            frozenset({1, 2, 3, 4, 5}),
        ),
        Table(
            _ADDED,
            ("curve", "crank angle, deg", "value", "remaining RMS", "unit"),
            tuple(shifts),
            (0.36, 0.2, 0.17, 0.17, 0.1),
            frozenset({1, 2, 3}),
        ),
        *(Paragraph(f"{line}.", "note") for line in file_notes(deviations_found)),
        *_pictures_by_page(figure(mechanism, linkage, measured=measured), subject.system),
    )
    return Section("Measured curves", blocks)


def _pictures_by_page(panel_figure: PanelFigure, system: System) -> list[Picture]:
    """Return pictures, each with as many panels as fit well on a page."""
    parts = [panel_figure.panels[start : start + _PANELS] for start in range(0, len(panel_figure.panels), _PANELS)]
    return [
        Picture(
            "Measured and computed", partial(draw_panel_figure, replace(panel_figure, panels=part), system), raster=True
        )
        for part in parts
    ]
