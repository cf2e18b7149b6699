"""Reference for quantities as Markdown, from the description in each quantity."""

from __future__ import annotations

import re
from collections.abc import Iterator

from docs.site.schema_tables import cell
from slidercrank.objectives.quantity import Group, Quantity
from slidercrank.objectives.registry import FACTS

_INTRODUCTION = """# Quantities

Every quantity may be an objective or a constraint in a [job](../jobs.md), and is a column of the front. This
page is generated from the quantities themselves; `slidercrank.quantities()` gives the same in Python. Formulas use the
symbols of [theory.md](../theory.md): crank r, connecting rod l, offset e, crank angle theta, slider position x, speed
omega.

![The linkage with its signs: crank angle, offset, slider position, transmission angle](../sketch.svg)

"Needs" states what a job must have, and the value of the quantity without it: undefined, zero, or equal to another one.
Peaks are peaks over the continuous crank angle. A quantity is never negative unless its sign is explained. Quantities
that need `[motion]` belong to a crank that swings; those that need `[target_motion]` belong to a
[desired motion](../jobs.md#a-desired-motion).
"""
_TABLES = {"motion": '[motion] kind = "swing"', "target_motion": "[target_motion]"}
_WITHOUT = {"undefined": "undefined without it", "zero": "zero without it", "equal": "equal to `{instead}` without it"}
_VALUE = r'[a-z_]+ = (?:\{[^}]*\}|"[^"]*"|[\d.]+)'
_JOB = re.compile(rf"\[+[a-z_.]+\]+(?: {_VALUE}(?:, {_VALUE})*)?")
"""Part of a job within a sentence: a table, with keys and values."""


def quantity_reference() -> str:
    """Return the page: for each group, a table of its quantities and then a section for each."""
    parts = [_INTRODUCTION]
    for group in Group:
        members = [quantity for quantity in FACTS.values() if quantity.group is group]
        if members:
            parts += [f"## {group.value}\n", *_table(members), *(section(quantity) for quantity in members)]
    return "\n".join(parts)


def _table(members: list[Quantity]) -> Iterator[str]:
    yield "| quantity | title | unit |\n|---|---|---|"
    for quantity in members:
        yield f"| [`{quantity.name}`](#{quantity.name}) | {cell(quantity.title)} | {units(quantity)} |"
    yield ""


def section(quantity: Quantity) -> str:
    """Return the section of a quantity: definition, formula, unit, sign, needs and an example."""
    required = "".join(f"\n    - {need}" for need in needs(quantity))
    facts = {
        "Formula": f"`{quantity.formula}`",
        "Unit": f"{units(quantity)}; column `{quantity.field}`",
        "Sign": "may be negative" if quantity.signed else "",
        "Better": {"low": "lower", "high": "higher", "": "neither"}[quantity.better],
        "Needs": required,
        "Default": _floor(quantity),
        "Allowable": f"the {quantity.allowed_by}" if quantity.allowed_by else "",
        "Example": f"`{requirement(quantity)}`",
        "More": f"[theory, section {quantity.section}](../theory.md#{_anchor(quantity.section)})",
    }
    listed = "\n".join(f"- **{name}**: {text}" for name, text in facts.items() if text)
    said = " ".join(filter(None, (quantity.sentence, quantity.advice)))
    return f"### {quantity.name}\n\n{said}\n\n{listed}\n"


def units(quantity: Quantity) -> str:
    """Return the metric unit of a quantity, with the inch unit if it differs."""
    metric, inch = quantity.kind.metric.symbol, quantity.kind.inch
    return f"{metric} ({inch.symbol})" if inch is not None and inch.symbol != metric else metric or "none"


def requirement(quantity: Quantity) -> str:
    """Return a line for a job's constraints with a usual value, on the side that a requirement limits."""
    side = {"low": "max", "high": "min", "": "equals"}[quantity.better]
    usual = quantity.usual_value
    return f"{quantity.name} = {{ {side} = {usual if isinstance(usual, float) else chr(34) + usual + chr(34)} }}"


def needs(quantity: Quantity) -> Iterator[str]:
    """Yield the needs of a quantity in a job, with the remedy and the value of the quantity without them."""
    if quantity.table:
        yield f"`{_TABLES[quantity.table]}`"
    for need in quantity.needs:
        rule, *others = need.missing.replace("{instead}", f"`{quantity.instead}`").split("; ")
        remedies = [_JOB.sub(lambda found: f"`{found[0]}`", text) for text in others if not text.startswith("got ")]
        without = _WITHOUT[need.consequence].replace("{instead}", quantity.instead)
        yield f"{'; '.join([rule, *remedies])}. *{without[0].upper()}{without[1:]}.*"


def _floor(quantity: Quantity) -> str:
    if quantity.floor is None:
        return ""
    face = quantity.kind.metric
    return f"at least {face.factor * quantity.floor:.4g} {face.symbol}".rstrip() + ", if the job sets no other limit"


def _anchor(heading: str) -> str:
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
