"""Commands for questions about one design, such as `slidercrank inverse`, and for sizing its parts."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from ...objectives.kinds import System
from ..designs.display_units import convert_record
from ..questions.design_question import BoundQuestion
from ..questions.discovery import DESIGN_QUESTIONS, QUESTION_COMMANDS
from ..runs.result import curves_csv
from ..runs.run_folder import write_file
from ..text.options import (
    DesignOfRun,
    Dimensions,
    JobFile,
    JobOrRun,
    Json,
    Runs,
    Units,
    require_ending,
    require_matplotlib,
)
from ..text.screen import print_message, print_record, show_activity, write_figure
from .design_of_job_or_run import machine_from_arguments, rotating_problem
from .question_options import option_of_input


def build_design_command(name: str) -> Callable[..., None]:
    """Return the command of a question, for `for_typer`."""
    question, says = DESIGN_QUESTIONS[name], QUESTION_COMMANDS[name]

    def command(
        job: JobOrRun = None,
        *,
        size: Dimensions,
        inputs: dict[str, str | None],
        design: DesignOfRun = None,
        files: dict[str, Path],
        runs: Runs = None,
        units: Units = "metric",
        json: Json = False,
    ) -> None:
        curves, figure = files.get("curves"), require_matplotlib(files.get("figure"))
        require_ending("--curves", curves, ".csv")
        require_ending("--figure", figure, ".png")
        mechanism, linkage, problem = machine_from_arguments(name, job, size, design, runs)
        words = {item.name: item.flag for item in question.inputs}
        bound_question = question.bind_to_problem(mechanism, linkage, problem, inputs, words)
        notes = _print_result(bound_question, units, json)
        for note in () if json else notes:
            print_message(note)
        if curves is not None:
            write_file(curves, curves_csv(bound_question.output_of("curves", units)))
            print_message(f"{curves}: {says.curves}")
        if figure is not None:
            write_figure(figure, lambda: bound_question.output_of("figure", units))

    helps = (
        {"curves": f"Write {says.curves} as CSV.", "figure": "Draw the curves to a PNG file."} if says.curves else {}
    )
    written = (_file_option(file, help) for file, help in helps.items())
    command.__doc__ = f"{says.help} {says.alone}"
    command.__annotations__ |= {
        "job": Annotated[JobOrRun, says.job],
        "inputs": Annotated[dict[str, Any], tuple(map(option_of_input, question.inputs))],
        "files": Annotated[dict[str, Any], tuple(written)],
    }
    return command


def build_sizing_command(name: str) -> Callable[..., None]:
    """Return the command of a sizing question, for `for_typer`."""
    question, says = DESIGN_QUESTIONS[name], QUESTION_COMMANDS[name]

    def command(
        job: JobFile,
        *,
        size: Dimensions,
        inputs: dict[str, str | None],
        files: dict[str, Path],
        units: Units = "metric",
        json: Json = False,
    ) -> None:
        curves, folder = files.get("curves"), require_matplotlib(files.get("figures"))
        require_ending("--curves", curves, ".csv")
        problem = rotating_problem(job, says.called or name)
        words = {item.name: item.flag for item in question.inputs}
        bound_question = question.bind_to_problem(
            problem.mechanism.nominal, size.linkage(problem), problem, inputs, words
        )
        for note in _print_result(bound_question, units, json):
            print_message(note)
        if curves is not None:
            write_file(curves, curves_csv(bound_question.output_of("curves", units)))
            print_message(f"{curves}: {says.curves}")
        if folder is not None and says.figure is not None:
            write_figure(folder / f"{says.figure[0]}.png", lambda: bound_question.output_of("figure", units), units)

    written = [_file_option("curves", f"Write {says.curves} as CSV.")] if says.curves else []
    if says.figure:
        help = f"Save a figure of {says.figure[1]} as {says.figure[0]}.png in this folder."
        written.append(_file_option("figures", help, "DIR"))
    command.__doc__ = says.help
    command.__annotations__ |= {
        "job": Annotated[JobFile, says.job],
        "inputs": Annotated[dict[str, Any], tuple(map(option_of_input, question.inputs))],
        "files": Annotated[dict[str, Any], tuple(written)],
    }
    return command


def _print_result(bound_question: BoundQuestion, units: System, json: bool) -> list[str]:
    """Print the answer; return additional messages."""
    from ..render.terminal import print_blocks

    with show_activity("computing"):
        record = bound_question.numbers()
    print_record(
        json, convert_record(record, units), lambda screen: print_blocks(screen, bound_question.blocks(record), units)
    )
    return bound_question.notes(record)


def _file_option(name: str, help: str, metavar: str = "FILE") -> inspect.Parameter:
    hint = Annotated[Path | None, typer.Option(metavar=metavar, help=help)]
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=hint)


inverse, lever, swing = map(build_design_command, ("inverse", "lever", "swing"))
allocate, balance, law, sections = map(build_sizing_command, ("allocate", "counterweight", "law", "sections"))
