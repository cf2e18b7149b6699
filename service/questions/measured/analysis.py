"""Deviation of measured curves from the computed ones of one design, and the best-fitting shifts."""

import math
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np

from ....model.arrays import Array
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import cycle_turns
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import ANGLE, count_with_noun, name_and_kind_of_key
from ....objectives.tables.curve_deviation import Deviation, curve_deviations
from ....objectives.tables.curve_extremes import crank_angles_of_cuts, defined_curves
from ....objectives.tables.cycle_curves import KINDS
from ....objectives.tables.measured_curves import Measured
from ...figures.panel_figure import DASHED, SAMPLES, Line, Panel, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import (
    Block,
    Sentence,
    Table,
    Text,
    Unit,
    Value,
    column,
    dimensions_text,
    heading,
    value_from_record,
    words,
)
from ...render.numerals import format_number
from ...text.tables import finite_or_none
from ..record_types import Keys, Note, Record, keys_of_kinds

_Fit = Annotated[float | None, Note("null where the samples do not determine a shift")]
_CURVE = {
    "title": str,
    "samples": int,
    **keys_of_kinds(("rms", "mean", "largest", "best_shift", "left_rms"), KINDS),
    "largest_at_crank_angle_deg": Annotated[float | None, Note("null where friction leaves the curve undetermined")],
    "best_crank_angle_shift_deg": _Fit,
}
_Curve = Annotated[dict[str, Any], Keys("CurveDeviation", "Measured minus computed values of a curve.", _CURVE, 9)]


class Deviations(Record):
    """Deviation of measured curves from the computed ones.

    Shifts give the best fit when added to the measured values.
    """

    rows: int
    understood: str
    """Data read from the file."""
    rows_without_crank_angle: int
    crank_angle_from_time: bool
    left_out: list[str]
    """Columns that are empty or do not name a curve."""
    curves: dict[str, _Curve]
    """By name."""


_DRAWN = 3000  # number of samples in a panel, spread over the measured ones
_NAMED = 12  # maximum number of omitted columns that are named
_UNDETERMINED = "undefined where friction locks"


def numbers(mechanism: Mechanism, linkage: Linkage, *, measured: Measured) -> Deviations:
    """Return the deviation of each measured curve, measured minus computed, by the curve's name.

    best_crank_angle_shift_deg and best_shift: amounts to add to the measured crank angles and values for the smallest
    root mean square, left_rms. None stands for values that friction leaves undetermined, and for shifts that the
    samples do not determine.
    """
    found_deviations = curve_deviations(mechanism, linkage, measured.crank_angle, measured.values)
    return {
        "rows": len(measured.crank_angle),
        "understood": measured.understood,
        "rows_without_crank_angle": measured.without_angle,
        "crank_angle_from_time": measured.by_time,
        "left_out": list(measured.left_out),
        "curves": {deviation.name: _deviation_entry(deviation) for deviation in found_deviations},
    }


def _deviation_entry(deviation: Deviation) -> dict[str, Any]:
    def value(name: str, number: float | None) -> dict[str, float | None]:
        return {f"{name}{unit.suffix}": None if number is None else finite_or_none(unit.factor * number)}

    def angle(name: str, number: float | None) -> dict[str, float | None]:
        return {f"{name}_deg": None if number is None else finite_or_none(math.degrees(number))}

    fit, unit = deviation.fit, deviation.kind.metric
    return {
        "title": deviation.title,
        "samples": deviation.count,
        **value("rms", deviation.rms),
        **value("mean", deviation.mean),
        **value("largest", deviation.largest),
        **angle("largest_at_crank_angle", deviation.crank_angle),
        **angle("best_crank_angle_shift", None if fit is None else fit.crank_angle),
        **value("best_shift", None if fit is None else fit.value),
        **value("left_rms", None if fit is None else fit.rms),
    }


def blocks(numbers: Deviations) -> list[Block]:
    """Return the deviation of each curve, then the best-fit shifts, and the omitted data."""
    source = ", crank angles derived from time at constant speed" if numbers["crank_angle_from_time"] else ""
    deviations: list[tuple[Text, ...]] = []
    fits: list[tuple[Text, ...]] = []
    for entry in numbers["curves"].values():
        values = [curve_value(entry, name) for name in ("rms", "mean", "largest")]
        at = curve_value(entry, "largest_at_crank_angle", decimals=2, missing="")
        title, unit = entry["title"], Unit(values[0].kind)
        deviations.append((title, str(entry["samples"]), *values, at, unit))
        shifts = [
            curve_value(entry, name, sign=True, missing="none") for name in ("best_crank_angle_shift", "best_shift")
        ]
        fits.append((title, *shifts, curve_value(entry, "left_rms", missing=""), unit))
    curve, unit_column = column("curve", left=True), column("unit", left=True)
    sizes = [column(name) for name in ("samples", "RMS", "mean", "largest")]
    return [
        heading(
            f"Measured minus computed, {count_with_noun(numbers['rows'], 'row')}{source}; RMS and mean over the samples"
        ),
        Table((curve, *sizes, column("at", ANGLE), unit_column), tuple(deviations), ruled=True),
        heading("Shifts that, added to the measured curves, give the best fit; not applied above"),
        Table(
            (curve, column("crank angle", ANGLE), column("value"), column("remaining RMS"), unit_column),
            tuple(fits),
            ruled=True,
        ),
        *map(Sentence, file_notes(numbers)),
    ]


def curve_value(entry: Mapping[str, Any], name: str, **look: Any) -> Value:
    """Return a number of a curve by its name without unit. look: further fields of `Value`."""
    return value_from_record(entry, next(key for key in entry if name_and_kind_of_key(key)[0] == name), **look)


def file_notes(numbers: Mapping[str, Any]) -> list[str]:
    """Return sentences on the data read from a file, and on omitted rows and columns."""
    rows, names = numbers["rows_without_crank_angle"], numbers["left_out"]
    lines = [f"Interpretation of the file: {numbers['understood']}"] if numbers["understood"] else []
    if rows:
        lines.append(f"Rows without a crank angle, omitted: {rows}")
    if names:
        listed = [name if name.isprintable() else ascii(name) for name in names[:_NAMED]]
        remainder = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
        lines.append(f"Columns that are empty or not a curve, omitted: {', '.join(listed)}{remainder}")
    return lines


def figure(mechanism: Mechanism, linkage: Linkage, *, measured: Measured) -> PanelFigure:
    """Return a panel for each measured curve: computed, shifted to fit, samples, and the largest deviation."""
    degrees = np.degrees(np.mod(measured.crank_angle, cycle_turns(mechanism) * 2.0 * np.pi))
    panels = tuple(
        _deviation_panel(
            deviation, _computed_curves(mechanism, linkage, deviation), degrees, measured.values[deviation.name]
        )
        for deviation in curve_deviations(mechanism, linkage, measured.crank_angle, measured.values)
    )
    subtitle = words(
        "{sizes}; line: computed, dashed: shifted to fit, dots: measured, ring: largest deviation",
        sizes=dimensions_text(linkage),
    )
    return PanelFigure("Measured and computed", subtitle, panels, columns=min(2, len(panels)), width=5.2)


def _computed_curves(mechanism: Mechanism, linkage: Linkage, deviation: Deviation) -> list[Line]:
    """Return the computed curve and, if there is a fit, the same curve shifted to the samples."""

    def line(style: int, angle: float, value: float) -> Line:
        turns = cycle_turns(mechanism)
        theta = sampled_crank_angles(crank_angles_of_cuts(mechanism, linkage) - angle, turns=turns)
        at = np.mod(theta + angle, turns * 2.0 * np.pi)
        (curve,) = (curve.values for curve in defined_curves(mechanism, linkage, at) if curve.name == deviation.name)
        return Line("", np.degrees(theta), curve - value, style=style)

    fit = deviation.fit
    return [line(0, 0.0, 0.0), *([] if fit is None else [line(DASHED, fit.crank_angle, fit.value)])]


def _deviation_panel(deviation: Deviation, computed: list[Line], at: Array, samples: Array) -> Panel:
    finite = np.flatnonzero(np.isfinite(samples))
    drawn = finite[np.unique(np.linspace(0, len(finite) - 1, min(len(finite), _DRAWN)).astype(np.intp))]
    lines = [*computed, Line("", at[drawn], samples[drawn], style=SAMPLES)]
    note: Text = _UNDETERMINED
    if math.isfinite(deviation.rms):
        place = np.degrees([deviation.crank_angle])
        lines.append(Line("", place, np.array([deviation.sample]), points=True))
        rms, largest = (Value(value, deviation.kind, 4, bare=True) for value in (deviation.rms, deviation.largest))
        note = words(f"RMS {{rms}}, largest {{largest}} at {format_number(place[0])}°", rms=rms, largest=largest)
    return crank_angle_panel(deviation.title, *lines, kind=deviation.kind, note=note)
