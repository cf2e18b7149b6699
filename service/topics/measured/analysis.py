"""Deviation of measured curves from the computed ones of one design, and the shifts that fit them best."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from rich.console import Console

from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turns import cycle_turns
from ....objectives.counted import counted
from ....objectives.tables.curve_extremes import cuts_of, defined_curves
from ....objectives.tables.deviation import Deviation, deviations
from ....objectives.tables.measured import Measured
from ...designs.columns import split_unit
from ...figures.numerals import shown, with_unit
from ...figures.sheets import DASHED, SAMPLES, Array, Line, Panel, Sheet, over_turn, turn
from ...text.tables import plain, print_table, table

_DRAWN = 3000  # samples of a panel, spread over the measured ones
_NAMED = 12  # of the columns that were left out
_UNDETERMINED = "undetermined where friction locks"


def numbers(mechanism: Mechanism, linkage: Linkage, *, measured: Measured) -> dict[str, Any]:
    """Return the deviation of each measured curve, measured minus computed, by the curve's name.

    best_crank_angle_shift_deg and best_shift: what is to be added to the measured crank angles and values so that the
    least root mean square is left, left_rms. None stands for what friction leaves undetermined, and for shifts that
    the samples do not determine.
    """
    found = deviations(mechanism, linkage, measured.crank_angle, measured.values)
    return {
        "rows": len(measured.crank_angle),
        "rows_without_crank_angle": measured.without_angle,
        "crank_angle_from_time": measured.by_time,
        "left_out": list(measured.left_out),
        "curves": {one.name: _entry(one) for one in found},
    }


def _entry(found: Deviation) -> dict[str, Any]:
    def value(name: str, number: float | None) -> dict[str, float | None]:
        shown = None if number is None else plain(found.shown.factor * number)
        return {f"{name}{found.shown.suffix}": shown}

    def angle(name: str, number: float | None) -> dict[str, float | None]:
        return {f"{name}_deg": None if number is None else plain(math.degrees(number))}

    fit = found.fit
    return {
        "title": found.title,
        "samples": found.count,
        **value("rms", found.rms),
        **value("mean", found.mean),
        **value("largest", found.largest),
        **angle("largest_at_crank_angle", found.crank_angle),
        **angle("best_crank_angle_shift", None if fit is None else fit.crank_angle),
        **value("best_shift", None if fit is None else fit.value),
        **value("left_rms", None if fit is None else fit.rms),
    }


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the deviation of each curve, then the shifts that fit best, and what was left out."""
    source = ", crank angles from the time at constant speed" if numbers["crank_angle_from_time"] else ""
    head = f"Measured minus computed, {counted(numbers['rows'], 'row')}{source}; RMS and mean over the samples"
    console.print(head, style="bold", soft_wrap=True)
    rows = table("curve", ">samples", ">RMS", ">mean", ">largest", ">at,\ndeg", "unit", ruled=True)
    fits = table("curve", ">crank angle,\ndeg", ">value", ">RMS left", "unit", ruled=True)
    for entry in numbers["curves"].values():
        given, unit = told(entry)
        at = given["largest_at_crank_angle"]
        cells = [_text(given[name]) for name in ("rms", "mean", "largest")]
        rows.add_row(given["title"], str(given["samples"]), *cells, "" if at is None else f"{at:.2f}", unit)
        shifts = [given[name] for name in ("best_crank_angle_shift", "best_shift", "left_rms")]
        fits.add_row(
            given["title"],
            *("none" if value is None else f"{value:+.6g}" for value in shifts[:2]),
            "" if shifts[2] is None else f"{shifts[2]:.6g}",
            unit,
        )
    print_table(console, rows)
    console.print()
    console.print("Shifts that, added to what was measured, fit best; not applied above", style="bold", soft_wrap=True)
    print_table(console, fits)
    for line in left_out(numbers):
        console.print(line, soft_wrap=True, markup=False)


def told(entry: Mapping[str, Any]) -> tuple[dict[str, Any], str]:
    """Return the numbers of a curve by their names without units, and the unit of its values."""
    unit = next(split_unit(key)[1] for key in entry if split_unit(key)[0] == "rms")
    return {split_unit(key)[0]: value for key, value in entry.items()}, unit


def left_out(numbers: Mapping[str, Any]) -> list[str]:
    """Return sentences on the rows and columns that were left out."""
    rows, names = numbers["rows_without_crank_angle"], numbers["left_out"]
    lines = [f"Rows without a crank angle, left out: {rows}"] if rows else []
    if names:
        some = [name if name.isprintable() else ascii(name) for name in names[:_NAMED]]
        more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
        lines.append(f"Columns that are no curve or empty, left out: {', '.join(some)}{more}")
    return lines


def _text(value: float | None) -> str:
    return "undefined" if value is None else f"{value:.6g}"


def figure(mechanism: Mechanism, linkage: Linkage, *, measured: Measured) -> Sheet:
    """Return a panel for each measured curve: computed, also shifted to fit, samples, and the largest deviation."""
    degrees = np.degrees(np.mod(measured.crank_angle, cycle_turns(mechanism) * 2.0 * np.pi))
    panels = tuple(
        _panel(found, _curves(mechanism, linkage, found), degrees, measured.values[found.name])
        for found in deviations(mechanism, linkage, measured.crank_angle, measured.values)
    )
    subtitle = f"{linkage.label}; line: computed, dashed: shifted to fit, dots: measured, ring: largest deviation"
    return Sheet("Measured and computed", subtitle, panels, columns=min(2, len(panels)), width=5.2)


def _curves(mechanism: Mechanism, linkage: Linkage, found: Deviation) -> list[Line]:
    """Return the computed curve, and where there is a fit, the same where the samples would then lie."""

    def line(style: int, angle: float, value: float) -> Line:
        turns = cycle_turns(mechanism)
        theta = turn(cuts_of(mechanism, linkage) - angle, turns=turns)
        at = np.mod(theta + angle, turns * 2.0 * np.pi)
        (curve,) = (curve.values for curve in defined_curves(mechanism, linkage, at) if curve.name == found.name)
        return Line("", np.degrees(theta), found.shown.factor * (curve - value), style=style)

    fit = found.fit
    return [line(0, 0.0, 0.0), *([] if fit is None else [line(DASHED, fit.crank_angle, fit.value)])]


def _panel(found: Deviation, computed: list[Line], at: Array, samples: Array) -> Panel:
    factor = found.shown.factor
    there = np.flatnonzero(np.isfinite(samples))
    drawn = there[np.unique(np.linspace(0, len(there) - 1, min(len(there), _DRAWN)).astype(np.intp))]
    lines = [*computed, Line("", at[drawn], factor * samples[drawn], style=SAMPLES)]
    note, noted = _UNDETERMINED, tuple[float, ...]()
    if math.isfinite(found.rms):
        place, sample = np.degrees([found.crank_angle]), factor * np.array([found.sample])
        lines.append(Line("", place, sample, points=True))
        note, noted = f"RMS {{}}, largest {{}} at {shown(place[0])}°", (factor * found.rms, factor * found.largest)
    return over_turn(with_unit(found.title, found.shown.symbol), *lines, note=note, noted=noted)
