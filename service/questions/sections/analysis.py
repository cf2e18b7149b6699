"""Widths and depths of crank and rod of one design, for least mass: numbers and text."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....optimise.problem.problem import Problem
from ....optimise.sizing.sections import size_sections
from ...render.blocks import Block, Sentence, Table, Value, column, recorded, sentence, words

_ACTIVE = 1e-3  # percent of mass per percent of a limit, to be worth a remark


def numbers(mechanism: Mechanism, linkage: Linkage, *, problem: Problem | None, **_: Any) -> dict[str, Any]:
    """Return the sections of least mass, ready for JSON; pins are those of the design.

    Raises `InputError` without limits, and as `size_sections` does.
    """
    if problem is None or problem.sections is None or mechanism.strength is None:
        raise InputError("sizing sections needs the table [sections]; got none; add it with a material and pins")
    pins = {pin: getattr(mechanism.strength, pin) for pin in ("crank_pivot", "crank_pin", "slider_pin")}
    found = size_sections(mechanism, linkage, mechanism.strength.material, replace(problem.sections, **pins))
    bars = (("crank", found.crank), ("rod", found.rod))
    return {
        **{f"{name}_mm": 1e3 * float(getattr(linkage, name)) for name in ("crank", "rod", "offset")},
        **{f"{name}_{side}_mm": 1e3 * getattr(bar, side) for name, bar in bars for side in ("width", "depth")},
        **{f"{name}_mass_kg": bar.mass(float(getattr(linkage, name))) for name, bar in bars},
        "mass_kg": found.mass,
        "settled": found.settled,
        "iterations": found.iterations,
        "utilisation": found.utilisation,
        "mass_percent_per_percent": found.sensitivity,
    }


def blocks(numbers: dict[str, Any]) -> list[Block]:
    """Return the numbers for people."""

    def size(of: str) -> Sentence:
        sides = {side: recorded(numbers, f"{of}_{side}_mm", digits=4) for side in ("width", "depth")}
        return sentence(f"{of}: width {{width}}, depth {{depth}}", **sides)

    settled = "" if numbers["settled"] else "; sections and dynamics have not settled"
    together = f"mass of both: {{mass}}, after {numbers['iterations']} iterations{settled}"
    rows = []
    for name, used in numbers["utilisation"].items():
        rate = Value(numbers["mass_percent_per_percent"][name], digits=3)
        saved = words("{rate} % of mass", rate=rate) if (rate.number or 0.0) > _ACTIVE else ""
        rows.append((name, Value(100.0 * used, digits=4), saved))
    columns = column("limit", left=True), column("used, %"), column("1 % more of it saves")
    mass = recorded(numbers, "mass_kg", digits=5)
    return [size("crank"), size("rod"), sentence(together, mass=mass), Table(columns, tuple(rows))]
