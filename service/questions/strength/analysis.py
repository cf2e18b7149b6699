"""Strength of crank and rod of one design: stresses, safeties, pins, wear, and where the stress is greatest."""

from __future__ import annotations

import math
from typing import Annotated, Any, NotRequired

import numpy as np

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.links import Bar
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turns import TURN, cycle_turns
from ....model.signals.first_greatest import angle_in_cycle
from ....model.strength.bar_stress import bar_stress
from ....model.strength.places import WholeBar
from ....model.strength.stress_cycle import stress_peaks
from ....objectives.bars import LINKS, NEAR
from ....objectives.kinds import ANGLE, LENGTH, PRESSURE
from ....objectives.link_stress import STATIC, STATIC_SAFETY, eye_stresses
from ....objectives.quantity import Group
from ....objectives.registry import QUANTITIES
from ....objectives.tables.missing_values import missing_value_reason
from ...designs.violations import violated_by
from ...figures.sheets import Line, Panel, Sheet, over_turn
from ...render.blocks import Block, Table, Text, Value, column, number_list, recorded, words
from ...text.tables import plain
from ..answers import Boundless, Keys, Note
from ..peaks import row_of

_SIGNS = ("tension", "compression")
_OfEye = Annotated[float | None, Note("null where a pin as wide as the bar leaves nothing of it")]
_OfSign = Annotated[float | None, Note("null of a sign that it never has")]


def _bar_keys(name: str) -> Any:
    along = {f"greatest_{sign}_{of}": _OfSign for sign in _SIGNS for of in _ALONG}
    eyes = {f"eye_at_{pin}_{of}": _OfEye for pin in (NEAR, LINKS[name].far) for of in _ALONG[:2]}
    text = "Greatest stresses along a bar, its eyes apart, and in each eye: where and at which crank angle."
    return NotRequired[Annotated[dict[str, Any], Keys(f"StressOf{name.capitalize()}", text, along | eyes)]]


_ALONG = ("MPa", "at_crank_angle_deg", "from_crank_pin_mm")
_QUANTITIES = {
    of.field: NotRequired[Annotated[Boundless, Note(f"{of.sentence} null without a value")]]
    for of in QUANTITIES.values()
    if of.group is Group.STRENGTH
}
StrengthNumbers = Annotated[
    dict[str, Any],
    Keys(
        "StrengthNumbers",
        "Quantities of strength that the machine has, by how much it goes beyond allowable values, and its bars.",
        {
            **_QUANTITIES,
            "violated": dict[str, float],
            "bars": Annotated[
                dict[str, Any], Keys("Bars", "Links that are bars.", {of: _bar_keys(of) for of in LINKS})
            ],
        },
    ),
]


def numbers(mechanism: Mechanism, linkage: Linkage) -> StrengthNumbers:
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
        raise InputError(f"strength needs material and pins for crank and rod: {reason}")


def _bars(mechanism: Mechanism) -> list[str]:
    return [name for name in LINKS if isinstance(getattr(mechanism, name), Bar)]


def _extremes(mechanism: Mechanism, linkage: Linkage, name: str) -> dict[str, float | None]:
    """Return the greatest stresses along a bar, its eyes apart, and where; None of a sign that it never has."""
    found: dict[str, float | None] = {}
    cycle = TURN * cycle_turns(mechanism)
    for place, (sign, criterion) in enumerate(zip(_SIGNS, STATIC, strict=True)):
        along = (WholeBar(LINKS[name].part),)
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


def blocks(numbers: dict[str, Any]) -> list[Block]:
    """Return the numbers for people."""
    titles = {of.field: of.title for of in QUANTITIES.values()}
    shown = [(titles[key], recorded(numbers, key), "") for key in numbers if key in titles]
    rows: list[tuple[Text, ...]] = []

    def row(where: str, bar: dict[str, Any], *keys: str) -> tuple[Text, ...]:
        return where, *(recorded(bar, key, missing="–") for key in keys)

    for name, bar in numbers["bars"].items():
        for sign in _SIGNS:
            of = f"greatest_{sign}"
            keys = f"{of}_MPa", f"{of}_at_crank_angle_deg", f"{of}_from_crank_pin_mm"
            rows.append(row(f"along the {name}, {sign}", bar, *keys))
    for name, bar in numbers["bars"].items():
        for pin in (NEAR, LINKS[name].far):
            where = f"eye of the {name} at the {pin.replace('_', ' ')}"
            rows.append((*row(where, bar, f"eye_at_{pin}_MPa", f"eye_at_{pin}_at_crank_angle_deg"), ""))
    columns = (
        column("where", left=True),
        column("greatest", PRESSURE),
        column("at crank angle", ANGLE),
        column("from crank pin", LENGTH),
    )
    return [*number_list("Strength of crank and rod", shown), Table(columns, tuple(rows), ruled=True)]


def figure(mechanism: Mechanism, linkage: Linkage) -> Sheet:
    """Return the stress of each bar: both faces where it is greatest, and its ends along the bar.

    Raises `InputError` for a machine without material and pins, and for a design that friction locks.
    """
    _require(mechanism)
    panels: list[Panel] = []
    for name in _bars(mechanism):
        stress = bar_stress(mechanism, LINKS[name].part, row_of(linkage))
        if not len(stress.theta):
            raise InputError("friction locks the design, so its stresses are undefined; reduce its friction")
        length, worst = float(getattr(linkage, name)), stress.worst
        degrees = np.degrees(stress.theta)
        faces = [Line(label, degrees, stress.stress[n, worst], n) for n, label in enumerate(("one face", "the other"))]
        at = words("{name} stress at {where}", name=name, where=Value(length * stress.shares[worst], LENGTH, 4))
        panels.append(over_turn(at, *faces, kind=PRESSURE))
        along = [
            Line(label, length * stress.shares, end, n)
            for n, (label, end) in enumerate(zip(("least", "greatest"), stress.envelope, strict=True))
        ]
        over = f"{name} stress over the turn"
        panels.append(Panel(over, "from the crank pin", tuple(along), kind=PRESSURE, along=LENGTH))
    return Sheet("Strength of crank and rod", "", tuple(panels), width=6.4, height=2.25)
