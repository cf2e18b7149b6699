"""Shaking force and moment on the frame as text, with and without the counterweight."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...text.lines import Line, show_lines
from .numbers import CURVES

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    lines: list[Line] = []
    for name, unit, _ in CURVES:
        for which, word in (("peak", "peak"), ("rms", "RMS")):
            remarks = []
            if which == "peak":
                remarks.append(f"at {numbers[f'peak_{name}_angle_deg']:.2f} deg")
            without = numbers[f"{which}_{name}_without_counterweight_{unit}"]
            if without is not None:
                remarks.append(f"{without:.6g} without counterweight")
            value = numbers[f"{which}_{name}_{unit}"]
            title = f"{word} {name.replace('_', ' ')}"
            lines.append((title, value, "N m" if unit == "Nm" else unit, ", ".join(remarks)))
    show_lines(
        console, "Balance (inertia forces on the frame; gravity and load left out; moment about the pivot)", lines
    )
