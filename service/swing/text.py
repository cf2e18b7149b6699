"""A swing of one design in words and numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Console

from ..designs.columns import split_unit
from ..text.screen import say
from ..text.tables import Line, show_lines

_TITLES = {
    "start_crank_angle": "crank angle at the start",
    "end_crank_angle": "crank angle at the end",
    "start_slider_position": "slider position at the start",
    "end_slider_position": "slider position at the end",
    "drive_at_start_forth": "drive at the start, moving forth",
    "drive_at_start_back": "drive at the start, moving back",
    "drive_at_end_forth": "drive at the end, moving forth",
    "drive_at_end_back": "drive at the end, moving back",
    "energy_forth": "energy of the drive, forth",
    "energy_back": "energy of the drive, back",
    "stored_energy": "stored forth, without friction",
}


def show_swing(screen: Console, record: Mapping[str, Any]) -> None:
    """Write the numbers of a record, in the units of its keys."""
    parts = {name: (key, unit) for key in record for name, unit in [_split(key)]}
    how = "slowly" if record["law"] == "slow" else f"{record['law']} law, {record['duration_s']:g} s each way"
    lines: list[Line] = []
    for name, (key, unit) in parts.items():
        value = record[key]
        told = isinstance(value, str | list | bool) or name == "duration"
        if not told and "_at_crank_angle" not in name and "_at_slider_position" not in name:
            lines.append((_TITLES.get(name, name.replace("_", " ")), value, unit, _place(record, name)))
    lines.append(("held by friction alone, all over", "yes" if record["holds_by_friction"] else "no", "", ""))
    show_lines(screen, f"Swing driven at the {record['driver']}, {how}", lines)
    for note in record["notes"]:
        say(note)


def _split(key: str) -> tuple[str, str]:
    """Return a key without its unit, and the unit; energies and times have no column of their own."""
    stem, _, last = key.rpartition("_")
    if last in ("J", "s"):
        return stem, last
    name, unit, _ = split_unit(key)
    return name, unit


def _place(record: Mapping[str, Any], name: str) -> str:
    angle = record.get(f"{name}_at_crank_angle_deg")
    if angle is None:
        return ""
    key = next(key for key in record if key.startswith(f"{name}_at_slider_position_"))
    way = f"{record[f'{name}_way']}, " if f"{name}_way" in record else ""
    return f"{way}at {angle:.2f} deg, slider at {record[key]:.6g} {split_unit(key)[1]}"
