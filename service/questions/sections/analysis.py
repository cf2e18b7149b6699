"""Widths and depths of the crank and the rod for minimum mass of one design: numbers and text."""

from dataclasses import replace
from typing import Any

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....optimise.problem.problem import Problem
from ....optimise.sizing.sections import size_sections
from ...render.blocks import Block, Sentence, Table, Value, column, sentence, value_from_record, words
from ..record_types import Record


class Sections(Record):
    """Rectangular bars of minimum mass."""

    crank_mm: float
    rod_mm: float
    offset_mm: float
    crank_width_mm: float
    crank_depth_mm: float
    rod_width_mm: float
    rod_depth_mm: float
    crank_mass_kg: float
    rod_mass_kg: float
    mass_kg: float
    """Of both."""
    settled: bool
    """Whether the iteration between sections and dynamics has converged."""
    iterations: int
    utilisation: dict[str, float]
    """Utilisation of each limit: 1 if it is reached."""
    mass_percent_per_percent: dict[str, float]
    """Mass saved by raising each limit by 1 %."""


_ACTIVE = 1e-3  # percent of mass per percent of a limit, from which a remark is worthwhile


def numbers(mechanism: Mechanism, linkage: Linkage, *, problem: Problem | None, **_: Any) -> Sections:
    """Return the minimum-mass sections, ready for JSON; the pins are those of the design.

    Raises `InputError` if the job has no limits, and the errors of `size_sections`.
    """
    if problem is None or problem.sections is None or mechanism.strength is None:
        raise InputError(
            "sizing sections needs the table [sections]; this job has none; add it with a material and pins"
        )
    pins = {pin: getattr(mechanism.strength, pin) for pin in ("crank_pivot", "crank_pin", "slider_pin")}
    sections = size_sections(mechanism, linkage, mechanism.strength.material, replace(problem.sections, **pins))
    crank, rod = float(linkage.crank), float(linkage.rod)
    return {
        "crank_mm": 1e3 * crank,
        "rod_mm": 1e3 * rod,
        "offset_mm": 1e3 * float(linkage.offset),
        "crank_width_mm": 1e3 * sections.crank.width,
        "crank_depth_mm": 1e3 * sections.crank.depth,
        "rod_width_mm": 1e3 * sections.rod.width,
        "rod_depth_mm": 1e3 * sections.rod.depth,
        "crank_mass_kg": sections.crank.mass(crank),
        "rod_mass_kg": sections.rod.mass(rod),
        "mass_kg": sections.mass,
        "settled": sections.is_converged,
        "iterations": sections.iterations,
        "utilisation": sections.utilisation,
        "mass_percent_per_percent": sections.sensitivity,
    }


def blocks(numbers: Sections) -> list[Block]:
    """Return the answer in human-readable form."""

    def size(bar: str) -> Sentence:
        sides = {side: value_from_record(numbers, f"{bar}_{side}_mm", digits=4) for side in ("width", "depth")}
        return sentence(f"{bar}: width {{width}}, depth {{depth}}", **sides)

    remark = "" if numbers["settled"] else "; not converged"
    together = f"mass of both: {{mass}}, after {numbers['iterations']} iterations{remark}"
    rows = []
    for name, utilisation in numbers["utilisation"].items():
        rate = Value(numbers["mass_percent_per_percent"][name], digits=3)
        saved = words("{rate} % of mass", rate=rate) if (rate.number or 0.0) > _ACTIVE else ""
        rows.append((name, Value(100.0 * utilisation, digits=4), saved))
    columns = column("limit", left=True), column("utilisation, %"), column("raising it by 1 % saves")
    mass = value_from_record(numbers, "mass_kg", digits=5)
    return [size("crank"), size("rod"), sentence(together, mass=mass), Table(columns, tuple(rows))]
