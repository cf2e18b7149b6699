"""`slidercrank check` and `slidercrank schema`: job files before anything runs."""

from __future__ import annotations

import warnings
from typing import Annotated, Any

from ...model.errors import InputWarning
from ..runs.result import json_text
from ..text.options import JobFile, Json
from ..text.screen import console, print_output


def check(
    job: Annotated[JobFile, "Job file, .toml or .json."],
    json: Json = False,
) -> None:
    """Check a job file and report how it is understood."""
    from ...objectives.own.quantity import OwnQuantity
    from ...optimise.job import load_job, read_job
    from ..text.job_in_words import freedom_in_words, job_in_words

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # among the answer
        problem = load_job(job)
    for quantity in problem.own:
        if isinstance(quantity, OwnQuantity):
            quantity.require_function()
    summary = job_in_words(problem, read_job(job))
    if json:
        print_output(json_text(summary))
        return
    screen = console()
    screen.print(f"{job} is a valid job: {summary['name']}", style="bold", soft_wrap=True)
    parts: dict[str, list[str]] = {
        "change": [_in_words(**change) for change in summary["changes"]],
        **{name: summary[name] for name in ("given", "files", "tolerances", "costs", "variables")},
        "requirements": summary["rules"],
        "objectives": summary["objectives"],
        "freedom": [freedom_in_words(problem)],
        "search": [summary["search"]],
        "note": summary["notes"],
    }
    for line in summary["warnings"]:
        screen.print(f"  {'warning':<14}{line}", style="yellow", soft_wrap=True)
    for title, lines in parts.items():
        for index, line in enumerate(lines):
            screen.print(f"  {title if index == 0 else '':<14}{line}", soft_wrap=True)


def _in_words(sentence: str, path: str, value: Any, label: str) -> str:
    """Return a change that settles a warning, as a line of a job file."""
    from ...optimise.job.messages import toml

    return label if value is None else f"{label}: {path} = {toml(value)}"


def schema() -> None:
    """Print the JSON Schema of job files."""
    from ...optimise.job import job_schema

    print_output(json_text(job_schema()))
