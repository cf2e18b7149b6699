"""`slidercrank sweep`: quantities over one or two parameters of crank, rod, offset and speed."""

from __future__ import annotations

from typing import Annotated, Any

from ..questions.discovery import FRONT_OR_JOB_QUESTIONS
from ..render.terminal import print_blocks
from ..text.options import Figures, JobFile, Json, Units
from ..text.screen import print_message, print_record, write_figure
from .input_options import options_of, with_question_help
from .job_or_run import turning_problem

QUESTION = FRONT_OR_JOB_QUESTIONS["sweep"]


@with_question_help(QUESTION)
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
    swept = QUESTION.ask(problem, inputs, words=QUESTION.flags)
    print_record(json, swept.record(units)["rows"], lambda screen: print_blocks(screen, swept.blocks, units))
    for note in () if json else swept.notes:
        print_message(note)
    if figures is not None:
        from ..questions.sweep.figure import sweep_figure

        write_figure(
            figures / "sweep.png", lambda: sweep_figure(*swept.search_result, title=problem.name, system=units)
        )
