"""`slidercrank allocate`: tolerances of least cost within a limit of the position error."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Any

import typer

from ...model.errors import InputError
from ...objectives.kinds import LENGTH
from ..designs.selection import value_of
from ..designs.shown_units import record_in
from ..text.options import Dimensions, Figures, JobFile, Json, Units
from ..text.screen import answer, say, write_figure
from .job_or_run import turning_problem


def allocate(
    job: Annotated[JobFile, "A job file with [costs]."],
    limit: Annotated[str, typer.Option(metavar="LENGTH"), 'Position error that is allowed, such as "0.1 mm".'],
    *,
    size: Dimensions,
    kind: Annotated[
        str, typer.Option(metavar="KIND"), 'How errors add up: "worst case" or "rss" (root-sum-square).'
    ] = "worst case",
    figures: Annotated[Figures, "Draw error and costs into allocation.png there."] = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Find the tolerances of least manufacturing cost that keep the position error within a limit.

    At every crank angle of the part of the stroke that [tolerances] counts. What has no cost in [costs] keeps its
    tolerance, and takes its part of the limit; so do the clearances.
    """
    from ...optimise.sizing import tolerance_allocation as convex
    from ..questions.allocation import analysis
    from ..render.terminal import print_blocks

    problem = turning_problem(job, "allocate")
    if problem.costs is None:
        raise InputError(
            "an allocation needs what the tolerances cost; got a job without [costs]; "
            'add for example [costs] crank = { cost = 8.0, at = "0.05 mm" }'
        )
    linkage = size.linkage(problem)
    most = value_of("--limit", limit, LENGTH, sign="positive")
    mechanism = problem.mechanism.nominal
    words: Any = kind.strip().casefold().replace("-", " ").replace("_", " ")
    found = convex.allocate(linkage, problem.costs, most, words, mechanism=mechanism)
    numbers = analysis.numbers(found, linkage, problem.costs, mechanism)
    answer(json, record_in(numbers, units), lambda screen: print_blocks(screen, analysis.blocks(numbers), units))
    if not found.converged:
        say(f"not proven to be the cheapest: the optimality conditions are met to {found.residual:.1e} only")
    if figures is not None:
        from ..questions.allocation.figure import allocation_curves, allocation_figure

        curves = allocation_curves(found, linkage, problem.costs, mechanism)
        write_figure(figures / "allocation.png", partial(allocation_figure, curves, units))
