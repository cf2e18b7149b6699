"""`slidercrank balance`: the counterweight, and a rod balance, of least shaking."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...objectives.kinds import LENGTH, MASS, Kind
from ..designs.shown_units import record_in
from ..text.options import Dimensions, Figures, JobFile, Json, Length, Mass, Units, given_value
from ..text.screen import answer, say, write_figure
from .job_or_run import turning_problem

if TYPE_CHECKING:
    from ...optimise.sizing.counterweight import RodSpace


@dataclass(frozen=True)
class Masses:
    """Where masses may be added, how heavy they may be, and what they are judged by besides the force."""

    radius: Annotated[Length, "Place of the counterweight's centre.  [default: as in JOB, or the crank]"] = None
    mass: Annotated[Mass, "Greatest mass of the counterweight, such as 2 kg."] = None
    rod_radius: Annotated[Length, "Space around the crank pin for a balance mass on the rod."] = None
    rod_mass: Annotated[Mass, "Greatest mass of it."] = None
    arm: Annotated[Length, "Count the shaking moment too, as moment / arm; needs a rod balance."] = None

    def value(self, name: str, kind: Kind) -> float | None:
        """Return one of them, SI."""
        return given_value(f"--{name.replace('_', '-')}", getattr(self, name), kind, sign="positive")

    def rod_space(self) -> RodSpace | None:
        """Return the space for a balance mass on the rod. Raises `InputError` for its radius or mass alone."""
        from ...optimise.sizing.counterweight import RodSpace

        radius, mass = self.value("rod_radius", LENGTH), self.value("rod_mass", MASS)
        if radius is None and mass is None:
            return None
        if radius is None or mass is None:
            have, need = ("--rod-mass", "--rod-radius") if radius is None else ("--rod-radius", "--rod-mass")
            raise InputError(f"a rod balance needs --rod-radius and --rod-mass; got {have} alone; add {need}")
        return RodSpace(radius=radius, mass=mass)


def balance(
    job: Annotated[JobFile, "A job file: speed and masses come from it."],
    *,
    size: Dimensions,
    measure: Annotated[
        str, typer.Option(metavar="MEASURE"), 'What is to be least over the cycle: "peak" or "rms".'
    ] = "peak",
    masses: Masses,
    figures: Annotated[Figures, "Draw the hodograph before and after into balance.png there."] = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the counterweight, instead of that of JOB, of least shaking force, and a balance mass on the rod.

    Inertia forces at constant crank speed, over all crank angles; gravity and load are left out.
    """
    from ...optimise.sizing import counterweight as balancing
    from ..questions.counterweight import analysis
    from ..render.terminal import print_blocks

    problem = turning_problem(job, "balance")
    linkage, mechanism = size.linkage(problem), problem.mechanism.nominal
    at = masses.value("radius", LENGTH) or mechanism.counterweight.radius or float(linkage.crank)
    heaviest = masses.value("mass", MASS)
    words: Any = measure.strip().casefold()
    found = balancing.balance(
        mechanism,
        linkage,
        measure=words,
        arm=masses.value("arm", LENGTH),
        radius=at,
        most=None if heaviest is None else heaviest * at,
        rod=masses.rod_space(),
    )
    numbers = analysis.numbers(found, words)
    answer(json, record_in(numbers, units), lambda screen: print_blocks(screen, analysis.blocks(numbers), units))
    if not found.converged:
        say(f"not proven to be the best: {found.objective:.6g} N, and no less than {found.bound:.6g} N is possible")
    if figures is not None:
        write_figure(figures / "balance.png", lambda: analysis.figure(found, title=problem.name), units)
