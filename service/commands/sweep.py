"""`slidercrank sweep`: quantities over one or two of crank, rod, offset and speed."""

from __future__ import annotations

from typing import Annotated, Any

from ..questions.discovery import WIDER
from ..render.terminal import print_blocks
from ..text.options import Figures, JobFile, Json, Units
from ..text.screen import answer, say, write_figure
from .input_options import helped, options_of
from .job_or_run import turning_problem

QUESTION = WIDER["sweep"]


@helped(QUESTION)
def sweep(
    job: Annotated[JobFile, "Job file, .toml or .json."],
    *,
    inputs: Annotated[dict[str, Any], options_of(QUESTION)],
    figures: Annotated[Figures, "Save a figure of the sweep as sweep.png in this folder."] = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Answer the question, and draw the answer."""
    problem = turning_problem(job, "sweep")
    found = QUESTION.ask(problem, inputs, words=QUESTION.flags)
    answer(json, found.record(units)["rows"], lambda screen: print_blocks(screen, found.blocks, units))
    for note in () if json else found.notes:
        say(note)
    if figures is not None:
        from ..questions.sweep.figure import sweep_figure

        write_figure(figures / "sweep.png", lambda: sweep_figure(*found.found, title=problem.name, system=units))
