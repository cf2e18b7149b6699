"""`slidercrank balance`: the counterweight, and a rod balance, of least shaking."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...objectives.kinds import LENGTH, MASS
from ..designs.shown_units import record_in
from ..text.options import Dimensions, Figures, JobFile, Json, Length, Mass, Units, given_value
from ..text.screen import answer, say, write_figure
from .job_or_run import turning_problem

if TYPE_CHECKING:
    from ...optimise.sizing.counterweight import RodSpace


def balance(
    job: Annotated[JobFile, "A job file: speed and masses come from it."],
    *,
    size: Dimensions,
    measure: Annotated[
        str, typer.Option(metavar="MEASURE"), 'What is to be least over the cycle: "peak" or "rms".'
    ] = "peak",
    radius: Annotated[Length, "Place of the counterweight's centre.  [default: as in JOB, or the crank]"] = None,
    mass: Annotated[Mass, "Greatest mass of the counterweight, such as 2 kg."] = None,
    rod_radius: Annotated[Length, "Space around the crank pin for a balance mass on the rod."] = None,
    rod_mass: Annotated[Mass, "Greatest mass of it."] = None,
    arm: Annotated[Length, "Count the shaking moment too, as moment / arm; needs a rod balance."] = None,
    figures: Annotated[Figures, "Draw the hodograph before and after into balance.png there."] = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the counterweight, instead of that of JOB, of least shaking force, and a balance mass on the rod.

    Inertia forces at constant crank speed, over all crank angles; gravity and load are left out.
    """
    from ...optimise.sizing import counterweight as balancing
    from ..render.terminal import print_blocks
    from ..topics.counterweight import analysis

    problem = turning_problem(job, "balance")
    linkage, mechanism = size.linkage(problem), problem.mechanism.nominal
    given = partial(given_value, sign="positive")
    at = given("--radius", radius, LENGTH) or mechanism.counterweight.radius or float(linkage.crank)
    heaviest = given("--mass", mass, MASS)
    words: Any = measure.strip().casefold()
    found = balancing.balance(
        mechanism,
        linkage,
        measure=words,
        arm=given("--arm", arm, LENGTH),
        radius=at,
        most=None if heaviest is None else heaviest * at,
        rod=_space(given("--rod-radius", rod_radius, LENGTH), given("--rod-mass", rod_mass, MASS)),
    )
    numbers = analysis.numbers(found, words)
    answer(json, record_in(numbers, units), lambda screen: print_blocks(screen, analysis.blocks(numbers), units))
    if not found.converged:
        say(f"not proven to be the best: {found.objective:.6g} N, and no less than {found.bound:.6g} N is possible")
    if figures is not None:
        write_figure(figures / "balance.png", lambda: analysis.figure(found, title=problem.name), units)


def _space(radius: float | None, mass: float | None) -> RodSpace | None:
    from ...optimise.sizing.counterweight import RodSpace

    if radius is None and mass is None:
        return None
    if radius is None or mass is None:
        have, need = ("--rod-mass", "--rod-radius") if radius is None else ("--rod-radius", "--rod-mass")
        raise InputError(f"a rod balance needs --rod-radius and --rod-mass; got {have} alone; add {need}")
    return RodSpace(radius=radius, mass=mass)
