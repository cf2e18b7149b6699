"""Strength of crank and rod of one design: stresses, safeties, pins, wear, and where the stress is greatest."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from rich.console import Console

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.links import Bar
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turns import TURN, cycle_turns
from ....model.signals.first_greatest import angle_in_cycle
from ....model.strength.bar_stress import bar_stress
from ....model.strength.places import Along
from ....model.strength.stress_cycle import stress_peaks
from ....objectives.bars import LINKS, NEAR
from ....objectives.link_stress import STATIC, STATIC_SAFETY, eye_stresses
from ....objectives.quantity import Group
from ....objectives.registry import QUANTITIES
from ....objectives.tables.missing_values import missing_value_reason
from ...designs.violations import violated_by
from ...figures.numerals import shown
from ...figures.sheets import Line, Panel, Sheet, over_turn
from ...text import tables as text
from ...text.tables import plain
from ..peaks import row_of

_SIGNS = ("tension", "compression")


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return the quantities of strength that the machine has, and of each bar the greatest tension and compression.

    With the crank angle and the place along the bar from the crank pin; and of each eye the greatest stress with its
    crank angle; `violated` as of a design. None: a quantity without a value; the safety of what is not compressed is
    infinite. Raises `InputError` for a machine without material and pins.
    """
    _require(mechanism)
    design = row_of(linkage)
    found: dict[str, Any] = {}
    for of in QUANTITIES.values():
        if of.group is Group.STRENGTH and not (of.lacks(mechanism, "undefined") or of.lacks(mechanism, "zero")):
            value = float(of.unit.factor * of.evaluate(mechanism, design).values[0])
            found[of.field] = None if missing_value_reason(of, value, mechanism, linkage) else value
    eyes, cycle = eye_stresses(mechanism, design), TURN * cycle_turns(mechanism)
    bars: dict[str, dict[str, Any]] = {name: _extremes(mechanism, linkage, name) for name in _bars(mechanism)}
    for name, bar in bars.items():
        for pin, (stress, angle) in eyes[name].items():
            bar[f"eye_at_{pin}_MPa"] = plain(1e-6 * stress)
            bar[f"eye_at_{pin}_at_crank_angle_deg"] = plain(math.degrees(angle_in_cycle(angle, cycle)))
    return found | {"violated": violated_by(mechanism, found), "bars": bars}


def _require(mechanism: Mechanism) -> None:
    if reason := STATIC_SAFETY.lacks(mechanism, "undefined"):
        raise InputError(f"the strength of a design is that of its crank and rod: {reason}")


def _bars(mechanism: Mechanism) -> list[str]:
    return [name for name in LINKS if isinstance(getattr(mechanism, name), Bar)]


def _extremes(mechanism: Mechanism, linkage: Linkage, name: str) -> dict[str, float | None]:
    """Return the greatest stresses along a bar, its eyes apart, and where; None of a sign that it never has."""
    found: dict[str, float | None] = {}
    cycle = TURN * cycle_turns(mechanism)
    for place, (sign, criterion) in enumerate(zip(_SIGNS, STATIC, strict=True)):
        along = (Along(LINKS[name].part),)
        (peak,) = stress_peaks(mechanism, along, row_of(linkage), np.array([criterion]), kept=1)
        share, _, *angles = peak.places[0, 0]
        value = peak.values[0, 0]
        if not value > 0.0:  # of the other sign all along and all the time
            share, angles = math.nan, [math.nan, math.nan]
            value = math.nan
        found |= {
            f"greatest_{sign}_MPa": plain(1e-6 * value),
            f"greatest_{sign}_at_crank_angle_deg": plain(math.degrees(angle_in_cycle(angles[place], cycle))),
            f"greatest_{sign}_from_crank_pin_mm": plain(1e3 * share * float(getattr(linkage, name))),
        }
    return found


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    by_field = {of.field: of for of in QUANTITIES.values()}
    lines: list[text.Line] = [
        (by_field[key].title, value, by_field[key].unit.symbol, "") for key, value in numbers.items() if key in by_field
    ]
    text.show_lines(console, "Strength of crank and rod", lines)
    heads = ("where", ">greatest,\nMPa", ">at crank\nangle, deg", ">from crank\npin, mm")
    rows = text.table(*heads, ruled=True)
    for name, bar in numbers["bars"].items():
        for sign in _SIGNS:
            places = (bar[f"greatest_{sign}_{key}"] for key in ("MPa", "at_crank_angle_deg", "from_crank_pin_mm"))
            rows.add_row(f"along the {name}, {sign}", *(_told(one) for one in places))
    for name, bar in numbers["bars"].items():
        for pin in (NEAR, LINKS[name].far):
            places = (bar[f"eye_at_{pin}_{key}"] for key in ("MPa", "at_crank_angle_deg"))
            rows.add_row(f"eye of the {name} at the {pin.replace('_', ' ')}", *(_told(one) for one in places))
    text.print_table(console, rows)


def _told(number: float | None) -> str:
    return "–" if number is None else f"{number:.6g}"


def figure(mechanism: Mechanism, linkage: Linkage) -> Sheet:
    """Return the stress of each bar: both faces where it is greatest, and its ends along the bar.

    Raises `InputError` for a machine without material and pins, and for a design that friction locks.
    """
    _require(mechanism)
    panels: list[Panel] = []
    for name in _bars(mechanism):
        stress = bar_stress(mechanism, LINKS[name].part, row_of(linkage))
        if not len(stress.theta):
            raise InputError("friction locks the design, so that its stresses are not determined; change its friction")
        length, worst = 1e3 * float(getattr(linkage, name)), stress.worst
        degrees = np.degrees(stress.theta)
        faces = [
            Line(label, degrees, 1e-6 * stress.stress[n, worst], n) for n, label in enumerate(("one face", "the other"))
        ]
        where = shown(length * stress.shares[worst])
        panels.append(over_turn(f"{name} stress at {where} mm, MPa", *faces))
        along = [
            Line(label, length * stress.shares, 1e-6 * end, n)
            for n, (label, end) in enumerate(zip(("least", "greatest"), stress.envelope, strict=True))
        ]
        panels.append(Panel(f"{name} stress over the turn, MPa", "from the crank pin, mm", tuple(along)))
    return Sheet("Strength of crank and rod", "", tuple(panels), width=6.4, height=2.25)
