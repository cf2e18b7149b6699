"""`slidercrank sections`: widths and depths of crank and rod of one design, for least mass."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from ..designs.shown_units import record_in
from ..render.blocks import Block, Sentence, Table, Value, column, recorded, sentence, words
from ..render.terminal import print_blocks
from ..text.options import Dimensions, JobFile, Json, Units
from ..text.screen import answer, waiting
from .job_or_run import turning_problem

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...optimise.sizing.sections import Sections

_ACTIVE = 1e-3  # percent of mass per percent of a limit, to be worth a remark


def sections(
    job: Annotated[JobFile, "A job file with a table [sections]."],
    *,
    size: Dimensions,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Size crank and rod of one design as rectangular bars of least mass.

    They keep the stress, fatigue, buckling and bearing limits of the job's [sections] under the forces that the machine
    puts on them, their own mass included. What JOB says of the links' masses is not used. Dimensions that JOB fixes
    need not be repeated.
    """
    from ...optimise.job import load_sections
    from ...optimise.sizing.sections import size_sections

    problem = turning_problem(job, "sections")
    material, limits = load_sections(job)
    linkage = size.linkage(problem)
    with waiting("sizing the sections"):
        found = size_sections(problem.mechanism.nominal, linkage, material, limits)
    numbers = _numbers(found, linkage)
    answer(json, record_in(numbers, units), lambda screen: print_blocks(screen, _blocks(numbers), units))


def _numbers(found: Sections, linkage: Linkage) -> dict[str, Any]:
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


def _blocks(numbers: dict[str, Any]) -> list[Block]:
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
