"""Strength of one design's crank and rod: stresses, safety factors, pins, wear, location of the maximum stress."""

import math
from typing import Annotated, Any, NotRequired

import numpy as np

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import TURN, cycle_turns
from ....model.machine.links_and_joints import Bar
from ....model.machine.mechanism import Mechanism
from ....model.signals.panel_polynomials import wrap_into_cycle
from ....model.strength.bar_stress import bar_stress
from ....model.strength.stress_cycle import stress_peaks
from ....model.strength.stress_locations import LinkBody
from ....objectives.bar_pieces import LINKS, NEAR, STATIC
from ....objectives.kinds import ANGLE, LENGTH, PRESSURE
from ....objectives.link_strength import STATIC_SAFETY, greatest_eye_stresses
from ....objectives.quantity import Group
from ....objectives.registry import QUANTITIES
from ....objectives.tables.all_quantities import missing_value_reason
from ...designs.judged_requirements import violations_of
from ...figures.panel_figure import Line, Panel, PanelFigure, crank_angle_panel
from ...render.blocks import Block, Table, Text, Value, column, number_list, value_from_record, words
from ...text.tables import finite_or_none
from ..peaks import lengths_row
from ..record_types import Keys, Note, PossiblyInfinite

_SIGNS = ("tension", "compression")
_OfEye = Annotated[float | None, Note("null where a pin as wide as the bar leaves no material")]
_OfSign = Annotated[float | None, Note("null for a sign that never occurs")]


def _bar_keys(name: str) -> Any:
    stress_keys = {f"greatest_{sign}_{suffix}": _OfSign for sign in _SIGNS for suffix in _ALONG}
    eyes = {f"eye_at_{pin}_{suffix}": _OfEye for pin in (NEAR, LINKS[name].far) for suffix in _ALONG[:2]}
    text = "Greatest stresses along a bar outside its eyes, and in each eye, with place and crank angle."
    return NotRequired[Annotated[dict[str, Any], Keys(f"StressOf{name.capitalize()}", text, stress_keys | eyes)]]


_ALONG = ("MPa", "at_crank_angle_deg", "from_crank_pin_mm")
_QUANTITIES = {
    of.field: NotRequired[Annotated[PossiblyInfinite, Note(f"{of.sentence} null without a value")]]
    for of in QUANTITIES.values()
    if of.group is Group.STRENGTH
}
StrengthNumbers = Annotated[
    dict[str, Any],
    Keys(
        "StrengthNumbers",
        "Strength quantities of the machine, their excess over allowable values, and its bars.",
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
    """Return the machine's strength quantities, and the maximum tension and compression of each bar.

    Each comes with its crank angle and its distance along the bar from the crank pin. Also returns the maximum stress
    of each eye with its crank angle, and `violated` as for a design. None: an undefined quantity; the safety factor of
    an uncompressed bar is infinite. Raises `InputError` for a machine without material and pins.
    """
    _require_section(mechanism)
    design = lengths_row(linkage)
    record: dict[str, Any] = {}
    for quantity in QUANTITIES.values():
        if quantity.group is Group.STRENGTH and not (
            quantity.unmet_need(mechanism, "undefined") or quantity.unmet_need(mechanism, "zero")
        ):
            value = float(quantity.unit.factor * quantity.evaluate(mechanism, design).values[0])
            record[quantity.field] = None if missing_value_reason(quantity, value, mechanism, linkage) else value
    eyes, cycle = greatest_eye_stresses(mechanism, design), TURN * cycle_turns(mechanism)
    bars: dict[str, dict[str, Any]] = {name: _bar_extremes(mechanism, linkage, name) for name in _bar_names(mechanism)}
    for name, bar in bars.items():
        for pin, (stress, angle) in eyes[name].items():
            bar[f"eye_at_{pin}_MPa"] = finite_or_none(1e-6 * stress)
            bar[f"eye_at_{pin}_at_crank_angle_deg"] = finite_or_none(math.degrees(wrap_into_cycle(angle, cycle)))
    return record | {"violated": violations_of(mechanism, record), "bars": bars}


def _require_section(mechanism: Mechanism) -> None:
    if reason := STATIC_SAFETY.unmet_need(mechanism, "undefined"):
        raise InputError(f"strength needs material and pins for crank and rod: {reason}")


def _bar_names(mechanism: Mechanism) -> list[str]:
    return [name for name in LINKS if isinstance(getattr(mechanism, name), Bar)]


def _bar_extremes(mechanism: Mechanism, linkage: Linkage, name: str) -> dict[str, float | None]:
    """Return the maximum stresses along a bar without its eyes, with locations; None for a sign that never occurs."""
    extremes: dict[str, float | None] = {}
    cycle = TURN * cycle_turns(mechanism)
    for place, (sign, criterion) in enumerate(zip(_SIGNS, STATIC, strict=True)):
        stress_path = (LinkBody(LINKS[name].part),)
        (peak,) = stress_peaks(mechanism, stress_path, lengths_row(linkage), np.array([criterion]), limit=1)
        share, _, *angles = peak.places[0, 0]
        value = peak.values[0, 0]
        if not value > 0.0:  # the stress has the other sign everywhere and always
            share, angles = math.nan, [math.nan, math.nan]
            value = math.nan
        extremes |= {
            f"greatest_{sign}_MPa": finite_or_none(1e-6 * value),
            f"greatest_{sign}_at_crank_angle_deg": finite_or_none(math.degrees(wrap_into_cycle(angles[place], cycle))),
            f"greatest_{sign}_from_crank_pin_mm": finite_or_none(1e3 * share * float(getattr(linkage, name))),
        }
    return extremes


def blocks(numbers: dict[str, Any]) -> list[Block]:
    """Return the answer in human-readable form."""
    titles = {stem.field: stem.title for stem in QUANTITIES.values()}
    lines = [(titles[key], value_from_record(numbers, key), "") for key in numbers if key in titles]
    rows: list[tuple[Text, ...]] = []

    def row(place: str, bar: dict[str, Any], *keys: str) -> tuple[Text, ...]:
        return place, *(value_from_record(bar, key, missing="–") for key in keys)

    for name, bar in numbers["bars"].items():
        for sign in _SIGNS:
            stem = f"greatest_{sign}"
            keys = f"{stem}_MPa", f"{stem}_at_crank_angle_deg", f"{stem}_from_crank_pin_mm"
            rows.append(row(f"along the {name}, {sign}", bar, *keys))
    for name, bar in numbers["bars"].items():
        for pin in (NEAR, LINKS[name].far):
            eye = f"eye of the {name} at the {pin.replace('_', ' ')}"
            rows.append((*row(eye, bar, f"eye_at_{pin}_MPa", f"eye_at_{pin}_at_crank_angle_deg"), ""))
    columns = (
        column("where", left=True),
        column("greatest", PRESSURE),
        column("at crank angle", ANGLE),
        column("from crank pin", LENGTH),
    )
    return [*number_list("Strength of crank and rod", lines), Table(columns, tuple(rows), ruled=True)]


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return the stress of each bar: both faces at the maximum stress, and the extremes along the bar.

    Raises `InputError` for a machine without material and pins, and for a design that friction locks.
    """
    _require_section(mechanism)
    panels: list[Panel] = []
    for name in _bar_names(mechanism):
        stress = bar_stress(mechanism, LINKS[name].part, lengths_row(linkage))
        if not len(stress.theta):
            raise InputError("friction locks the design, so its stresses are undefined; reduce its friction")
        length, worst = float(getattr(linkage, name)), stress.index_of_largest_stress
        degrees = np.degrees(stress.theta)
        fibre_lines = [
            Line(label, degrees, stress.stress[n, worst], n) for n, label in enumerate(("one face", "the other"))
        ]
        at = words("{name} stress at {where}", name=name, where=Value(length * stress.shares[worst], LENGTH, 4))
        panels.append(crank_angle_panel(at, *fibre_lines, kind=PRESSURE))
        envelope_lines = [
            Line(label, length * stress.shares, end, n)
            for n, (label, end) in enumerate(zip(("least", "greatest"), stress.envelope, strict=True))
        ]
        title = f"{name} stress over the turn"
        panels.append(Panel(title, "from the crank pin", tuple(envelope_lines), kind=PRESSURE, x_kind=LENGTH))
    return PanelFigure("Strength of crank and rod", "", tuple(panels), width=6.4, height=2.25)
