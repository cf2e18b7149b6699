"""`slidercrank sections`: widths and depths of crank and rod of one design, for least mass."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from ..render.terminal import table
from ..text.options import Dimensions, JobFile, Json
from ..text.screen import answer, waiting
from .job_or_run import turning_problem

if TYPE_CHECKING:
    from rich.console import Console

    from ...model.linkage.linkage import Linkage
    from ...optimise.sizing.sections import Sections

_ACTIVE = 1e-3  # percent of mass per percent of a limit, to be worth a remark


def sections(
    job: Annotated[JobFile, "A job file with a table [sections]."],
    *,
    size: Dimensions,
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
    answer(json, _numbers(found, linkage), lambda screen: _show(screen, found))


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


def _show(screen: Console, found: Sections) -> None:
    for name, bar in (("crank", found.crank), ("rod", found.rod)):
        screen.print(f"{name}: width {1e3 * bar.width:.4g} mm, depth {1e3 * bar.depth:.4g} mm", soft_wrap=True)
    settled = "" if found.settled else "; sections and dynamics have not settled"
    screen.print(f"mass of both: {found.mass:.5g} kg, after {found.iterations} iterations{settled}", soft_wrap=True)
    rows = table("limit", ">used, %", ">1 % more of it saves")
    for name, used in found.utilisation.items():
        rate = found.sensitivity[name]
        rows.add_row(name, f"{100.0 * used:.4g}", f"{rate:.3g} % of mass" if rate > _ACTIVE else "")
    screen.print(rows)
