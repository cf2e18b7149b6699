"""`slidercrank check`, `schema` and `quantities`: job files before a run, and the names allowed in them."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError, InputWarning
from ..runs.result import json_text
from ..text.options import JobFile, Json
from ..text.screen import console, print_output, print_record

if TYPE_CHECKING:
    from rich.console import Console


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
        "change": [_change_line(**change) for change in summary["changes"]],
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


def _change_line(sentence: str, path: str, value: Any, label: str) -> str:
    """Return a change that resolves a warning, as a line of a job file."""
    from ...optimise.job.mistake_messages import toml_text

    return label if value is None else f"{label}: {path} = {toml_text(value)}"


def schema() -> None:
    """Print the JSON Schema of job files."""
    from ...optimise.job import job_schema

    print_output(json_text(job_schema()))


TERMS = {
    "slow_stroke": "this column names the stroke that takes longer, which [constraints] may require",
    "loaded_stroke": "this column names the stroke in which the loads do more work against the motion",
    "residual": "this column measures how far a design is from the optimality conditions",
    "knee": "the knee is the design nearest to the ideal point",
    "yield": "the yield is the fraction of machines within a limit, from `analyse --show tolerances --limit`",
}
"""Words in results that are not quantities, each with its meaning."""


def quantities(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME", help="Quantities to explain. [default: list all]")
    ] = None,
    *,
    json: Json = False,
) -> None:
    """List the quantities for objectives and constraints, or explain some of them.

    Explains meaning, formula, unit and column, and the data that a job must contain.
    """
    from ..designs.quantity_facts import facts_of_all_quantities

    facts = {item["name"]: item for item in facts_of_all_quantities()}
    for name in names or ():
        if name not in facts:
            from ...objectives.units import closest_word

            near = closest_word(name, facts)
            remedy = f"did you mean {near}?" if near else "list all with `slidercrank quantities`"
            if name in TERMS:
                remedy = f"{TERMS[name]}; see docs/glossary.md"
            raise InputError(f"no quantity is called {name!r}; {remedy}")
    chosen = [facts[name] for name in dict.fromkeys(names or facts)]
    print_record(
        json,
        {"quantities": chosen},
        lambda screen: (_explain_quantities if names else _list_quantities)(screen, chosen),
    )


def _list_quantities(screen: Console, facts: list[dict[str, Any]]) -> None:
    """Print name, unit and title of quantities, by group."""
    widths = [max(len(item[key]) for item in facts) for key in ("name", "unit")]
    for group in dict.fromkeys(item["group"] for item in facts):
        screen.print(f"{group}:", style="bold", soft_wrap=True)
        for item in facts:
            if item["group"] == group:
                name, unit = (item[key].ljust(width) for key, width in zip(("name", "unit"), widths, strict=True))
                screen.print(f"  {name}  {unit}  {item['title']}", soft_wrap=True)


def _explain_quantities(screen: Console, facts: list[dict[str, Any]]) -> None:
    for item in facts:
        screen.print(f"{item['name']}: {item['title']}", style="bold", soft_wrap=True)
        screen.print(" ".join(filter(None, (item["sentence"], item["advice"]))), soft_wrap=True)
        lines = {
            "formula": item["formula"],
            "unit": item["unit"] or "none",
            "column": item["column"],
            "good side": item["better"],
            "needs": item["needs"].replace("; ", "\n             "),
        }
        for label, text in lines.items():
            if text:
                screen.print(f"  {label:<11}{text}", soft_wrap=True)
