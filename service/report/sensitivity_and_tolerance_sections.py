"""Sensitivity of the design to its dimensions and to the tolerances of the job."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from ...model.tolerance.error_distributions import limits_of_sources
from ...objectives.kinds import System, metric_unit_in
from ..questions.sensitivity.figure import tornado_figure, tornado_rows
from ..questions.tolerances.analysis import PositionError, numbers
from ..questions.tolerances.figure import error_bands, tolerances_figure
from ..render.numerals import format_cell, format_length
from .document import Block, Facts, Paragraph, Picture, Section, Table
from .subject import Subject

_MOST = 24
"""Number of quantities in a figure on a page."""


def sensitivity_section(subject: Subject) -> Section:
    """Return the change of every quantity with each dimension."""
    design = subject.design
    rows = tornado_rows(design.mechanism, design.linkage, design.part.motion)
    draw = partial(tornado_figure, rows, subject.system, width=7.4, limit=_MOST)
    return Section("Sensitivity", (Picture("Change of quantities with the dimensions", draw),))


def tolerance_section(subject: Subject) -> Section | None:
    """Return the section on the effect of the tolerances on the slider position; None for a job without tolerances."""
    mechanism, linkage = subject.design.mechanism, subject.design.linkage
    if not np.any(limits_of_sources(mechanism, linkage)):
        return None
    record = numbers(mechanism, linkage)
    blocks: tuple[Block, ...] = (
        Facts(_tolerance_facts(record, subject.system)),
        _source_table(record, subject.system),
        Picture(
            "Position error over a turn", lambda: tolerances_figure(error_bands(mechanism, linkage), subject.system)
        ),
        Paragraph(
            f"Random machines: {record['monte_carlo']['samples']}, seed {record['monte_carlo']['seed']}; normal "
            "errors, limits at three standard deviations.",
            "note",
        ),
    )
    return Section("Tolerances", blocks)


def _tolerance_facts(record: Mapping[str, Any], system: System) -> dict[str, list[str]]:
    def size_and_angle(name: str) -> str:
        size, angle = record[f"{name}_mm"], record[f"{name}_angle_deg"]
        if size is None:
            return "undefined: a linkage within the tolerances does not rotate fully"
        return f"{format_length(size, system)} at {format_cell(angle)} deg"

    spread = record["monte_carlo"]["percentiles_greatest_mm"]
    percents = [f"{percent} % within {format_length(value, system)}" for percent, value in spread.items()]
    return {
        "Worst case, first order": [size_and_angle("worst_case")],
        "Worst case, exact": [size_and_angle("exact_worst_case")],
        "Root-sum-square": [size_and_angle("root_sum_square")],
        "Random machines": percents or ["none that rotates fully"],
        "Yield": [
            f"{format_cell(one['yield_percent'])} % within {format_length(one['limit_mm'], system)} ({one['limit']})"
            for one in record["yields"]
        ],
    }


def _source_table(record: PositionError, system: System) -> Table:
    unit, factor = metric_unit_in("mm", system)
    rows = tuple(
        (
            str(row["source"]),
            f"{format_cell(row['limit_deg'])} deg"
            if row["limit_mm"] is None
            else format_length(row["limit_mm"], system),
            format_cell(row["contribution_mm"] * factor),
            f"{row['share_of_worst_case_percent']:.1f}",
            f"{row['share_of_variance_percent']:.1f}",
        )
        for row in record["contributions"]
    )
    return Table(
        "Sources of the position error at the worst crank angle",
        ("source", "limit", f"adds, {unit}", "of worst case, %", "of variance, %"),
        rows,
        (0.32, 0.17, 0.15, 0.18, 0.18),
        frozenset({1, 2, 3, 4}),
    )
