"""`slidercrank compare`: comparison of the fronts of several runs."""

from __future__ import annotations

import contextlib
import json as json_format
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError, SlidercrankError
from ..designs.display_units import result_in
from ..designs.picking_options import minimised_values
from ..jobs.find_run import find_run
from ..render.terminal import print_table, table
from ..runs.result import Result, wanted_record
from ..runs.run_folder import disk, runs_place
from ..runs.stored_runs import job_file, read_run
from ..text.options import Figures, Json, Runs, Units
from ..text.screen import print_answer, print_message
from .ending import NoDesigns

if TYPE_CHECKING:
    from rich.console import Console

    from ...optimise.decisions.compare import Comparison

_COLUMNS = {
    "run": "{place} {run}",
    "method": "{method}",
    "seed": "{seed}",
    "designs": "{designs}",
    "in union\nfront": "{in_union}",
    "hyper-\nvolume": "{hypervolume:.5f}",
    "% of\nunion's": "{percent:.3f}",
    "evaluated": "{evaluations}",
    "s": "{seconds:.1f}",
}
"""Heads of the table, and what stands below them."""


@dataclass(frozen=True)
class _ComparedRun:
    """A run with its name in the comparison, its method, and its objectives in the first run's order."""

    name: str
    method: str
    result: Result


def compare(
    run: Annotated[list[str], typer.Argument(metavar="RUN..."), "Two or more runs, named as in `front`."],
    tolerance: Annotated[float, typer.Option(min=0.0), "Fraction of an objective's range that counts as equal."] = 1e-6,
    figures: Annotated[Figures, "Also draw the fronts, in this folder."] = None,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Compare the fronts of several runs: hypervolume, coverage, epsilon, dominance, effort.

    The runs must have the same objectives; their constraints and machines may differ.
    """
    from ...optimise.decisions import compare as comparison

    compared = _read(run, runs_place(runs))
    measures = comparison.compare([minimised_values(item.result) for item in compared], tolerance=tolerance)
    compared = [replace(item, result=result_in(item.result, units)) for item in compared]
    pictures = [] if figures is None else [_draw(compared, figures)]
    print_answer(json, _record(compared, measures), lambda screen: _show(screen, compared, measures))
    for picture in pictures:
        print_message(f"{picture}")


def _read(names: Sequence[str], place: Path) -> list[_ComparedRun]:
    if len(names) < 2:
        raise InputError("a comparison needs at least two runs; got one; name another")
    compared: list[_ComparedRun] = []
    folders: list[Path] = []
    for name in names:
        folder = find_run(name, place)
        if folder.resolve() in folders:
            raise InputError(f"a run may be named only once; got {folder.name} twice; leave one out")
        folders.append(folder.resolve())
        result = read_run(folder)
        if not result.designs:
            raise NoDesigns(replace(result, message=f"{folder.name}: {result.message}; leave it out"))
        if compared:
            result = _align_objectives(result, folder.name, compared[0])
        compared.append(_ComparedRun(folder.resolve().name, _method(folder), result))
    return compared


def _align_objectives(result: Result, name: str, first: _ComparedRun) -> Result:
    """Return a result with its objectives in the order of the first one. Raises `InputError` if they differ."""
    by_key = {(item.quantity, item.sense, item.target): item for item in result.objectives}
    order = [(item.quantity, item.sense, item.target) for item in first.result.objectives]
    if set(by_key) != set(order):
        raise InputError(
            f"the runs must have the same objectives; {first.name} has {_words(first.result)}, {name} has "
            f"{_words(result)}"
        )
    return replace(result, objectives=tuple(by_key[key] for key in order))


def _words(result: Result) -> str:
    return ", ".join(
        f"{item.sense} {item.quantity}" + ("" if item.target is None else f" {item.target:g} {item.unit}".rstrip())
        for item in result.objectives
    )


def _method(folder: Path) -> str:
    """Return the method of a run, from its record, else from its job."""
    with disk(folder):
        record = json_format.loads((folder / "front.json").read_text(encoding="utf-8"))
    if isinstance(record.get("method"), str):
        return str(record["method"])
    from ...optimise.job import parse_job, read_job

    job = job_file(folder)
    with contextlib.suppress(SlidercrankError):  # written for another version: the fronts compare all the same
        return "unknown" if job is None else parse_job(read_job(job), folder=folder).settings.method
    return "unknown"


def _draw(compared: Sequence[_ComparedRun], folder: Path) -> Path:
    import numpy as np

    from ..figures.comparison import MOST_RUNS, PlottedRun, comparison_matrix
    from ..figures.style import save

    objectives = compared[0].result.objectives
    if len(objectives) < 2:
        raise InputError("a figure needs at least two objectives; these runs have one; leave out --figures")
    if len(compared) > MOST_RUNS:
        raise InputError(f"a figure may show at most {MOST_RUNS} runs; got {len(compared)}; leave out some")
    drawn = [
        PlottedRun(
            f"{item.name} ({item.method})",
            np.array(
                [[row[objective.column] for objective in objectives] for row in item.result.designs], dtype=np.float64
            ),
        )
        for item in compared
    ]
    with disk(folder):
        folder.mkdir(parents=True, exist_ok=True)
        save(comparison_matrix(drawn, objectives), folder / "comparison.png")
    return folder / "comparison.png"


def _record(compared: Sequence[_ComparedRun], comparison: Comparison) -> dict[str, Any]:
    return {
        "objectives": [wanted_record(objective) for objective in compared[0].result.objectives],
        "tolerance": comparison.tolerance,
        "union_hypervolume": comparison.union,
        "runs": [
            {
                "run": item.name,
                "name": item.result.name,
                "method": item.method,
                "seed": item.result.seed,
                "status": item.result.status,
                "designs": int(comparison.sizes[index]),
                "in_union": int(comparison.in_union[index]),
                "hypervolume": float(comparison.hypervolumes[index]),
                "share_of_union": float(comparison.shares[index]),
                "evaluations": item.result.evaluations,
                "seconds": item.result.seconds,
            }
            for index, item in enumerate(compared)
        ],
        "coverage": comparison.coverage.tolist(),
        "epsilon": comparison.epsilon.tolist(),
        "dominates": comparison.dominates.tolist(),
    }


def _show(screen: Console, compared: Sequence[_ComparedRun], comparison: Comparison) -> None:
    screen.print(f"{len(compared)} runs: {_words(compared[0].result)}", style="bold", soft_wrap=True)
    screen.print(
        "Objectives are scaled by their ranges over the combined front. Hypervolume is a fraction of the box that "
        "extends to 1.1 ranges.\n",
        style="dim",
        soft_wrap=True,
    )
    rows = [
        [form.format(place=place, percent=100.0 * run["share_of_union"], **run) for form in _COLUMNS.values()]
        for place, run in enumerate(_record(compared, comparison)["runs"], 1)
    ]
    _print(screen, list(_COLUMNS), rows)
    numbers = [str(place) for place in range(1, len(compared) + 1)]
    for title, values, form in (
        (
            "Coverage: % of the column's designs that the row's designs weakly dominate",
            100.0 * comparison.coverage,
            ".1f",
        ),
        ("Additive epsilon: largest shortfall of the row against the column, in ranges", comparison.epsilon, ".2e"),
    ):
        screen.print(f"\n{title}", soft_wrap=True)
        cells = [
            [numbers[a], *("" if a == b else format(values[a, b], form) for b in range(len(numbers)))]
            for a in range(len(numbers))
        ]
        _print(screen, ["", *numbers], cells)
    screen.print()
    for sentence in _verdict(compared, comparison):
        screen.print(sentence, soft_wrap=True)


def _verdict(compared: Sequence[_ComparedRun], comparison: Comparison) -> list[str]:
    names = [item.name for item in compared]
    sentences = []
    open_pairs = 0
    for a in range(len(names)):
        for b in range(a + 1, len(names)):
            first, second = (a, b) if comparison.dominates[a, b] else (b, a)
            if comparison.dominates[first, second]:
                sentences.append(f"{names[first]} dominates {names[second]}: it matches or beats all its designs.")
            elif comparison.coverage[a, b] == comparison.coverage[b, a] == 1.0:
                sentences.append(f"{names[a]} and {names[b]} have the same front, within the tolerance.")
            else:
                open_pairs += 1
    if open_pairs:
        pairs = "the two" if len(names) == 2 else "all other pairs" if sentences else "any two"
        sentences.append(f"Neither of {pairs} dominates: each has designs that the other does not match.")
    return sentences


def _print(screen: Console, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    first, *other_heads = heads
    printed = table(first, *(f">{head}" for head in other_heads), ruled=True, padding=(0, 1, 0, 0), pad_edge=True)
    for column in printed.columns:
        column.vertical = "bottom"
    for row in rows:
        printed.add_row(*row)
    print_table(screen, printed)
