"""Textbook approximations for one design, compared with the exact model: two-mass rod, series, k F tan(alpha)."""

import math
from typing import Annotated

import numpy as np

from ....model.arrays import Array
from ....model.classical.approximations import (
    Errors,
    approximation_errors_over_offset,
    compare_approximations,
    relative_error,
    rotating_and_reciprocating_masses,
)
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import ACCELERATION, LENGTH, TORQUE, Kind
from ...figures.panel_figure import Line, Panel, PanelFigure, crank_angle_panel
from ...render.blocks import (
    Block,
    Table,
    Text,
    Unit,
    column,
    dimensions_text,
    heading,
    joined,
    note,
    value_from_record,
    values_from_record,
)
from ...render.numerals import format_number
from ..record_types import Note, Record

Share = Annotated[float | None, Note("null where the exact value is zero everywhere")]


class Approximation(Record):
    """Approximation and its error: maximum difference over the cycle, relative to the exact peak."""

    name: str
    error_percent: Share
    error_over_offset_percent: list[Share]
    """Errors at each offset of the answer."""


class AccelerationOf(Approximation):
    """Approximate slider acceleration."""

    peak_acceleration_m_s2: float


class TorqueOf(Approximation):
    """Approximate inertia torque."""

    peak_torque_Nm: float


class Approximations(Record):
    """Textbook models compared with the exact one: inertia only, at constant speed."""

    rotating_mass_kg: float
    reciprocating_mass_kg: float
    exact_peak_acceleration_m_s2: float
    exact_peak_torque_Nm: float
    offset_mm: list[float]
    """Offsets for the errors, including that of the design."""
    accelerations: list[AccelerationOf]
    torques: list[TorqueOf]


_TABULATED, _DRAWN = 5, 25  # offsets
_SHORT = {"two masses by mass centre": "two masses", "two masses, half and half": "half and half"}


def _errors_over_offset(mechanism: Mechanism, linkage: Linkage, count: int) -> Errors:
    """Return the errors at offsets from zero to the design's. If (rod - crank) / 2 is greater, they end there."""
    offset = float(linkage.offset)
    far = max(abs(offset), 0.5 * (float(linkage.rod) - float(linkage.crank)))
    return approximation_errors_over_offset(
        mechanism, linkage, math.copysign(1.0, offset) * np.linspace(0.0, far, count)
    )


def numbers(mechanism: Mechanism, linkage: Linkage) -> Approximations:
    """Return for each approximation its peak, its error for this design, and its error as a function of offset.

    Errors: maximum difference over the cycle relative to the exact peak, in percent; None if the peak is zero. They
    cover inertia only, at constant speed. Raises `InputError` if the crank has no speed.
    """
    comparison = compare_approximations(mechanism, linkage, np.linspace(0.0, 2.0 * math.pi, 1440, endpoint=False))
    rotating, reciprocating = rotating_and_reciprocating_masses(mechanism, linkage)
    offsets = _errors_over_offset(mechanism, linkage, _TABULATED)

    return {
        "rotating_mass_kg": rotating,
        "reciprocating_mass_kg": reciprocating,
        "exact_peak_acceleration_m_s2": _greatest_magnitude(comparison.acceleration),
        "exact_peak_torque_Nm": _greatest_magnitude(comparison.torque),
        "offset_mm": (1e3 * offsets.offset + 0.0).tolist(),  # for a negative offset the first one is -0.0
        "accelerations": [
            {
                "name": name,
                "peak_acceleration_m_s2": _greatest_magnitude(curve),
                "error_percent": _percent(relative_error(curve, comparison.acceleration)),
                "error_over_offset_percent": list(map(_percent, offsets.accelerations[name].tolist())),
            }
            for name, curve in comparison.accelerations.items()
        ],
        "torques": [
            {
                "name": name,
                "peak_torque_Nm": _greatest_magnitude(curve),
                "error_percent": _percent(relative_error(curve, comparison.torque)),
                "error_over_offset_percent": list(map(_percent, offsets.torques[name].tolist())),
            }
            for name, curve in comparison.torques.items()
        ],
    }


def _greatest_magnitude(curve: Array) -> float:
    return float(np.abs(curve).max())


def _percent(share: float) -> float | None:
    return 100.0 * share if math.isfinite(share) else None


def blocks(numbers: Approximations) -> list[Block]:
    """Return a line for each approximation."""
    offsets = [column(f"{100 * k // (_TABULATED - 1)} %") for k in range(_TABULATED)]
    columns = (column("model", left=True), column("peak"), column("unit", left=True), column("error"), *offsets)
    rows: list[tuple[Text, ...]] = []
    rows.append(("slider acceleration, exact", *_exact_row(numbers, "exact_peak_acceleration_m_s2", ACCELERATION)))
    rows += [
        _approximation_row(approximation, "peak_acceleration_m_s2", ACCELERATION)
        for approximation in numbers["accelerations"]
    ]
    rows.append(("inertia torque, exact", *_exact_row(numbers, "exact_peak_torque_Nm", TORQUE)))
    rows += [_approximation_row(approximation, "peak_torque_Nm", TORQUE) for approximation in numbers["torques"]]
    return [
        heading("Approximate models: inertia only, constant speed"),
        Table(columns, tuple(rows), ruled=True),
        note(
            "Errors: greatest over the cycle, relative to the exact peak; on the right for other offsets, in % of "
            "{most}.",
            most=values_from_record(numbers, "offset_mm", digits=4)[-1],
        ),
    ]


def _exact_row(numbers: Approximations, key: str, kind: Kind) -> tuple[Text, ...]:
    return value_from_record(numbers, key, digits=5), Unit(kind), *[""] * (1 + _TABULATED)


def _approximation_row(approximation: Approximation, key: str, kind: Kind) -> tuple[Text, ...]:
    errors = (approximation["error_percent"], *approximation["error_over_offset_percent"])
    cells = ("-" if percent is None else f"{percent:.3g} %" for percent in errors)
    return f"  {approximation['name']}", value_from_record(approximation, key, digits=5), Unit(kind), *cells


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return exact and approximate acceleration and inertia torque, and the maximum errors over offset."""
    comparison = compare_approximations(mechanism, linkage, np.linspace(0.0, 2.0 * math.pi, 721))
    errors = _errors_over_offset(mechanism, linkage, _DRAWN)
    degrees, offsets = np.degrees(comparison.crank_angle), np.abs(errors.offset)
    torques = [(_SHORT.get(name, name), 1 + n, name) for n, name in enumerate(comparison.torques)]
    panels = [
        crank_angle_panel(
            "slider acceleration",
            Line("exact", degrees, comparison.acceleration),
            *(Line(name, degrees, curve, 1) for name, curve in comparison.accelerations.items()),
            kind=ACCELERATION,
        ),
        crank_angle_panel(
            "inertia torque",
            Line("exact", degrees, comparison.torque),
            *(Line(label, degrees, comparison.torques[name], style) for label, style, name in torques),
            kind=TORQUE,
        ),
        Panel(
            "greatest error in acceleration, % of its peak",
            "offset",
            tuple(Line(name, offsets, 100.0 * curve, 1) for name, curve in errors.accelerations.items()),
            x_kind=LENGTH,
        ),
    ]
    if np.all(errors.peak_torque > 0.0):
        lines = tuple(Line(label, offsets, 100.0 * errors.torques[name], style) for label, style, name in torques)
        panels.append(Panel("greatest error in torque, %", "offset", lines, x_kind=LENGTH))
    subtitle = joined([dimensions_text(linkage), f"{format_number(mechanism.speed)} rad/s; inertia only"])
    title = "Approximate and exact models"
    return PanelFigure(title, subtitle, tuple(panels), columns=2, width=7.6, height=3.0)
