"""Widths and depths of the crank and the rod for minimum mass of one design: numbers and text."""

from dataclasses import replace
from typing import Annotated, Any

from ....model.errors import InputError
from ....model.linkage.dimensions import DIMENSIONS
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....optimise.problem.problem import Problem
from ....optimise.sizing.sections import size_sections
from ...render.blocks import Block, Sentence, Table, Value, column, sentence, value_from_record, words
from ..record_types import Keys, Note

_SECTIONS = Keys(
    "Sections",
    "Rectangular bars of minimum mass.",
    {
        **{
            f"{name}_mm": (float, lambda _, linkage, name=name: 1e3 * float(getattr(linkage, name)))
            for name in DIMENSIONS
        },
        **{
            f"{bar}_{side}_mm": (
                float,
                lambda sections, _, bar=bar, side=side: 1e3 * getattr(getattr(sections, bar), side),
            )
            for bar in ("crank", "rod")
            for side in ("width", "depth")
        },
        "crank_mass_kg": (float, lambda sections, linkage: sections.crank.mass(float(linkage.crank))),
        "rod_mass_kg": (float, lambda sections, linkage: sections.rod.mass(float(linkage.rod))),
        "mass_kg": (Annotated[float, Note("Of both.")], lambda sections, _: sections.mass),
        "settled": (
            Annotated[bool, Note("Whether the iteration between sections and dynamics has converged.")],
            lambda sections, _: sections.is_converged,
        ),
        "iterations": (int, lambda sections, _: sections.iterations),
        "utilisation": (
            Annotated[dict[str, float], Note("Utilisation of each limit: 1 if it is reached.")],
            lambda sections, _: sections.utilisation,
        ),
        "mass_percent_per_percent": (
            Annotated[dict[str, float], Note("Mass saved by raising each limit by 1 %.")],
            lambda sections, _: sections.sensitivity,
        ),
    },
)
Sections = Annotated[dict[str, Any], _SECTIONS]
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
    return _SECTIONS.of(sections, linkage)


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
