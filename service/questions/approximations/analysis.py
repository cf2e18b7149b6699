"""Textbook approximations of one design against the exact model: two-mass rod, series, k F tan(alpha)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ....model.classical.comparison import Errors, compare, errors_over_offset, relative_error
from ....model.classical.lumped import rotating_and_reciprocating
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import ACCELERATION, LENGTH, TORQUE
from ...figures.sheets import Line, Panel, Sheet, over_turn
from ...render.blocks import Block, Table, Text, Unit, column, dimensions, heading, joined, note, recorded, recorded_all
from ...render.numerals import shown

_TOLD, _DRAWN = 5, 25  # offsets
_SHORT = {"two masses by mass centre": "two masses", "two masses, half and half": "half and half"}


def _over_offset(mechanism: Mechanism, linkage: Linkage, count: int) -> Errors:
    """Return the errors at offsets from zero to the design's own, or to (rod - crank) / 2 if greater."""
    own = float(linkage.offset)
    far = max(abs(own), 0.5 * (float(linkage.rod) - float(linkage.crank)))
    return errors_over_offset(mechanism, linkage, math.copysign(1.0, own) * np.linspace(0.0, far, count))


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return for each approximation its peak, its error at this design, and its error over offset.

    Errors: the greatest difference over the cycle as a share of the exact peak, in per cent; None where all is zero.
    Of inertia alone, at constant speed. Raises `InputError` without a crank speed.
    """
    found = compare(mechanism, linkage, np.linspace(0.0, 2.0 * math.pi, 1440, endpoint=False))
    rotating, reciprocating = rotating_and_reciprocating(mechanism, linkage)
    offsets = _over_offset(mechanism, linkage, _TOLD)

    def entry(name: str, curve: Any, exact: Any, errors: Any, unit: str) -> dict[str, Any]:
        return {
            "name": name,
            f"peak_{unit}": float(np.abs(curve).max()),
            "error_percent": _percent(relative_error(curve, exact)),
            "error_over_offset_percent": [_percent(value) for value in errors.tolist()],
        }

    return {
        "rotating_mass_kg": rotating,
        "reciprocating_mass_kg": reciprocating,
        "exact_peak_acceleration_m_s2": float(np.abs(found.acceleration).max()),
        "exact_peak_torque_Nm": float(np.abs(found.torque).max()),
        "offset_mm": (1e3 * offsets.offset + 0.0).tolist(),  # of a negative offset the first one is -0.0
        "accelerations": [
            entry(name, curve, found.acceleration, offsets.accelerations[name], "acceleration_m_s2")
            for name, curve in found.accelerations.items()
        ],
        "torques": [
            entry(name, curve, found.torque, offsets.torques[name], "torque_Nm")
            for name, curve in found.torques.items()
        ],
    }


def _percent(share: float) -> float | None:
    return 100.0 * share if math.isfinite(share) else None


def blocks(numbers: dict[str, Any]) -> list[Block]:
    """Return a line for each approximation."""
    offsets = [column(f"{100 * k // (_TOLD - 1)} %") for k in range(_TOLD)]
    columns = (column("model", left=True), column("peak"), column("unit", left=True), column("error"), *offsets)
    rows: list[tuple[Text, ...]] = []
    for what, kind, key, exact in (
        ("slider acceleration", ACCELERATION, "accelerations", "exact_peak_acceleration_m_s2"),
        ("inertia torque", TORQUE, "torques", "exact_peak_torque_Nm"),
    ):
        rows.append((f"{what}, exact", recorded(numbers, exact, digits=5), Unit(kind), *[""] * (1 + _TOLD)))
        for entry in numbers[key]:
            peak = next(name for name in entry if name.startswith("peak_"))
            errors = (entry["error_percent"], *entry["error_over_offset_percent"])
            cells = ("-" if percent is None else f"{percent:.3g} %" for percent in errors)
            rows.append((f"  {entry['name']}", recorded(entry, peak, digits=5), Unit(kind), *cells))
    return [
        heading("Approximate models, inertia alone, at constant speed"),
        Table(columns, tuple(rows), ruled=True),
        note(
            "Errors: greatest over the cycle, share of the exact peak; "
            "on the right with other offsets, in % of {most}.",
            most=recorded_all(numbers, "offset_mm", digits=4)[-1],
        ),
    ]


def figure(mechanism: Mechanism, linkage: Linkage) -> Sheet:
    """Return acceleration and inertia torque, exact and approximate, and the greatest errors over offset."""
    found = compare(mechanism, linkage, np.linspace(0.0, 2.0 * math.pi, 721))
    errors = _over_offset(mechanism, linkage, _DRAWN)
    degrees, offsets = np.degrees(found.crank_angle), np.abs(errors.offset)
    torques = [(_SHORT.get(name, name), 1 + n, name) for n, name in enumerate(found.torques)]
    panels = [
        over_turn(
            "slider acceleration",
            Line("exact", degrees, found.acceleration),
            *(Line(name, degrees, curve, 1) for name, curve in found.accelerations.items()),
            kind=ACCELERATION,
        ),
        over_turn(
            "inertia torque",
            Line("exact", degrees, found.torque),
            *(Line(label, degrees, found.torques[name], style) for label, style, name in torques),
            kind=TORQUE,
        ),
        Panel(
            "greatest error of acceleration, % of its peak",
            "offset",
            tuple(Line(name, offsets, 100.0 * curve, 1) for name, curve in errors.accelerations.items()),
            along=LENGTH,
        ),
    ]
    if np.all(errors.peak_torque > 0.0):
        lines = tuple(Line(label, offsets, 100.0 * errors.torques[name], style) for label, style, name in torques)
        panels.append(Panel("greatest error of torque, %", "offset", lines, along=LENGTH))
    subtitle = joined([dimensions(linkage), f"{shown(mechanism.speed)} rad/s; inertia alone"])
    title = "Approximate models against the exact one"
    return Sheet(title, subtitle, tuple(panels), columns=2, width=7.6, height=3.0)
