"""Fronts of several runs compared: measures, which run is better where, and differences between the jobs."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ....model.errors import InputError
from ....model.linkage.dimensions import DIMENSIONS
from ....objectives.kinds import TIME, System
from ....optimise.decisions.price_of_robustness import Comparison, compare_fronts
from ...designs.design_selection_options import minimised_values
from ...designs.display_units import convert_objective
from ...designs.front_comparison import comparison_sentences, cost_of_change
from ...preview.partial_job import ranges_of
from ...render.blocks import Block, Phrase, Sentence, Table, Text, Value, column, heading, note, sentence
from ...runs.result import Result, StoredObjective, objective_record
from ..front_or_job_question import Answer
from .runs import ComparedRun

_SYSTEMS: tuple[System, ...] = ("metric", "inch")
_LEFT_OUT = ("name", "description")
_SEARCHED = ("variables", "choice", "objectives", "robust", "optimiser", "sections", "costs")
"""Tables of a job that affect the search, not the requirements on a design."""
_MOST_NAMES = 8


def analyse(runs: Sequence[ComparedRun], *, tolerance: float = 1e-6, **_: Any) -> Answer:
    """Return measures of the fronts, sentences, and differences between the jobs.

    Runs with different objectives, or with undefined ones, have no measures; `is_satisfied` is False if the objectives
    differ. Raises `InputError` for fewer than two runs and for a repeated run.
    """
    if len(runs) < 2:
        raise InputError("a comparison needs at least two runs; got one; name another")
    for index, run in enumerate(runs):
        if any(run.place == other.place for other in runs[:index]):
            raise InputError(f"a run may be named only once; got {run.name} twice; leave one out")
    solved = [run for run in runs if run.result.designs]
    message = _objectives_message(solved)
    comparison = None
    if len(solved) > 1 and not message:
        solved = [replace(run, result=_reorder_objectives(run.result, solved[0].result)) for run in solved]
        values = [minimised_values(run.result) for run in solved]
        if all(np.isfinite(front).all() for front in values):
            comparison = compare_fronts(values, tolerance=tolerance)
    places = differences_between_jobs([run.tables for run in runs if run.tables is not None])
    sentences = {system: _better_sentences(solved, system) for system in _SYSTEMS}
    parts = [run.name for run in solved], [run.result for run in solved]
    costs = {system: cost_of_change(*parts, system) for system in _SYSTEMS}
    caution = _different_jobs_sentence(len(runs), places) if sentences["metric"] else []

    def record(units: System) -> dict[str, Any]:
        measures = {} if comparison is None else _front_measures(solved, comparison, units)
        found = [{"place": place, "values": list(values)} for place, values in places]
        return measures | {"sentences": [*costs[units], *caution, *sentences[units]], "differences": found}

    blocks: list[Block] = [] if comparison is None else [_heading(solved)]
    blocks += _better_blocks(runs, costs)
    blocks += [sentence("{text}.", text=f"{text[:1].upper()}{text[1:]}") for text in caution]
    blocks += _better_blocks(runs, sentences)
    blocks += [] if comparison is None else [*_verdict_blocks(solved, comparison), *_measure_tables(solved, comparison)]
    names = [run.name for run in runs if run.tables is not None]
    return Answer(
        record=record, blocks=[*blocks, *_difference_table(names, places)], is_satisfied=not message, message=message
    )


def _different_jobs_sentence(count: int, places: Sequence[tuple[str, Sequence[str | None]]]) -> list[str]:
    """Return a sentence that names the differing data and requirements of the jobs; empty if they are equal."""
    names = list(dict.fromkeys(_path_name(place) for place, _ in places if place.split(".")[0] not in _SEARCHED))
    if not names:
        return []
    more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    jobs = "the two jobs" if count == 2 else "the jobs"
    return [f"{jobs} state different problems: {', '.join(names[:_MOST_NAMES])}{more}; only the numbers are compared"]


def _path_name(place: str) -> str:
    """Return the name of a path in a job: "speed", "load", or the quantity or formula of a bound."""
    table, _, key = place.partition(".")
    if table == "constraints":  # a formula may contain a point
        return re.sub(r"\.(min|max|equals)$", "", key).replace("_", " ")
    return (key.split(".")[0] if table == "mechanism" else table).replace("_", " ")


def _objectives_message(runs: Sequence[ComparedRun]) -> str:
    """Return the rule if a run's objectives differ from those of the first run, otherwise an empty text."""
    for run in runs[1:]:
        if {_objective_identity(item) for item in run.result.objectives} != {
            _objective_identity(item) for item in runs[0].result.objectives
        }:
            words = [f"{one.name} has {_objectives_text(one.result)}" for one in (runs[0], run)]
            return f"the runs must have the same objectives; {', '.join(words)}"
    return ""


def _objective_identity(objective: StoredObjective) -> tuple[str, str, float | None]:
    return objective.quantity, objective.sense, objective.target


def _reorder_objectives(result: Result, first: Result) -> Result:
    """Return a result with its objectives in the order of the first result."""
    by_key = {_objective_identity(item): item for item in result.objectives}
    return replace(result, objectives=tuple(by_key[_objective_identity(item)] for item in first.objectives))


def _objectives_text(result: Result, system: System = "metric", *, titles: bool = False) -> str:
    return ", ".join(
        f"{item.sense} {item.title if titles else item.quantity}"
        + ("" if item.target is None else f" {item.target:g} {item.unit}".rstrip())
        for item in (convert_objective(objective, system) for objective in result.objectives)
    )


def _better_sentences(solved: Sequence[ComparedRun], system: System) -> list[str]:
    """Return which run is better where, in words; empty if only one run has designs."""
    if len(solved) < 2:
        return []
    return comparison_sentences([run.name for run in solved], [run.result for run in solved], system)


def _better_blocks(runs: Sequence[ComparedRun], sentences: Mapping[System, Sequence[str]]) -> list[Block]:
    """Return sentences that say where each run is better; a folder name at the start keeps its case."""
    folders = tuple(run.name for run in runs if isinstance(run.place, Path))
    texts = [
        [text if text.startswith(folders) else f"{text[:1].upper()}{text[1:]}" for text in sentences[system]]
        for system in _SYSTEMS
    ]
    return [sentence("{text}.", text=Phrase(*pair)) for pair in zip(*texts, strict=True)]


def _front_measures(solved: Sequence[ComparedRun], comparison: Comparison, units: System) -> dict[str, Any]:
    return {
        "objectives": [objective_record(convert_objective(item, units)) for item in solved[0].result.objectives],
        "tolerance": comparison.tolerance,
        "union_hypervolume": comparison.union,
        "runs": [
            {
                "run": run.name,
                "name": run.result.name,
                "method": run.method,
                "seed": run.result.seed,
                "status": run.result.status,
                "designs": int(comparison.sizes[index]),
                "in_union": int(comparison.in_union[index]),
                "hypervolume": float(comparison.hypervolumes[index]),
                "share_of_union": float(comparison.shares[index]),
                "evaluations": run.result.evaluations,
                "seconds": run.result.seconds,
            }
            for index, run in enumerate(solved)
        ],
        "coverage": comparison.coverage.tolist(),
        "epsilon": comparison.epsilon.tolist(),
        "dominates": comparison.dominates.tolist(),
    }


def _heading(solved: Sequence[ComparedRun]) -> Block:
    objectives = Phrase(*(_objectives_text(solved[0].result, system, titles=True) for system in _SYSTEMS))
    return heading("{count} runs: {objectives}", count=str(len(solved)), objectives=objectives)


def _measure_tables(solved: Sequence[ComparedRun], comparison: Comparison) -> list[Block]:
    """Return the measures of the fronts and of each pair as tables."""
    titles = ("run", "method", "seed", "designs", "in union front", "hypervolume", "% of union's", "evaluated")
    rows: list[tuple[Text, ...]] = [
        (
            f"{index + 1} {run.name}",
            run.method,
            str(run.result.seed),
            str(comparison.sizes[index]),
            str(comparison.in_union[index]),
            Value(float(comparison.hypervolumes[index]), decimals=5),
            Value(100.0 * float(comparison.shares[index]), decimals=3),
            str(run.result.evaluations),
            Value(run.result.seconds, TIME, decimals=1),
        )
        for index, run in enumerate(solved)
    ]
    columns = [column(title, left=index == 0) for index, title in enumerate(titles)]
    coverage = "Coverage: % of the column's designs that the row's designs weakly dominate"
    epsilon = "Additive epsilon: largest shortfall of the row against the column, in ranges"
    return [
        note(
            "Objectives are scaled by their ranges over the combined front. Hypervolume is a fraction of the box that "
            "extends to 1.1 ranges."
        ),
        Table((*columns, column("time", TIME)), tuple(rows), ruled=True),
        *_pair_table(coverage, [[Value(100.0 * value, decimals=1) for value in row] for row in comparison.coverage]),
        *_pair_table(epsilon, [[Value(value, digits=3) for value in row] for row in comparison.epsilon]),
    ]


def _pair_table(title: str, values: Sequence[Sequence[Value]]) -> list[Block]:
    """Return a number for each pair of runs, labelled with their positions in the list of runs."""
    places = [str(index) for index in range(1, len(values) + 1)]
    rows: list[tuple[Text, ...]] = []
    for index, row in enumerate(values):
        cells: list[Text] = [places[index], *row]
        cells[1 + index] = ""  # diagonal: a run and itself
        rows.append(tuple(cells))
    return [heading(title), Table((column(), *map(column, places)), tuple(rows), ruled=True)]


def _verdict_blocks(solved: Sequence[ComparedRun], comparison: Comparison) -> list[Block]:
    names = [run.name for run in solved]
    sentences, samples = list[str](), list[str]()
    open_pairs = 0
    for a, b in combinations(range(len(names)), 2):
        first, second = (a, b) if comparison.dominates[a, b] else (b, a)
        if comparison.dominates[first, second]:
            winner, loser = names[first], names[second]
            sentences.append(f"{winner} dominates {loser}: it matches or beats every design of {loser}.")
        elif comparison.coverage[a, b] == comparison.coverage[b, a] == 1.0:
            sentences.append(f"{names[a]} and {names[b]} have the same front, within the tolerance.")
        else:
            open_pairs += 1
            samples += _samples_sentence(solved[a], solved[b]) or _samples_sentence(solved[b], solved[a])
    if open_pairs:
        pairs = "the two" if len(names) == 2 else "all other pairs" if sentences else "any two"
        sentences.append(f"Neither of {pairs} dominates: each has designs that the other does not match.")
    return [sentence("{text}", text=text) for text in (*sentences, *samples)]


def _samples_sentence(inner: ComparedRun, outer: ComparedRun) -> list[str]:
    """Return why neither front dominates although one job allows all designs of the other; empty for other jobs."""
    if inner.tables is None or outer.tables is None:
        return []
    keys = {f"variables.{name}" for name in DIMENSIONS}
    places = [place for place, _ in differences_between_jobs([inner.tables, outer.tables])]
    if any(place not in keys and place.partition(".")[0] != "optimiser" for place in places):
        return []
    inner_ranges, outer_ranges = ranges_of(inner.tables), ranges_of(outer.tables)
    if inner_ranges is None or outer_ranges is None:
        return []
    pairs = [(inner_ranges[name], outer_ranges[name]) for name in DIMENSIONS]
    if any(own.lower < other.lower or own.upper > other.upper for own, other in pairs):
        return []
    cause = f"{inner.name} and {outer.name} have the same ranges, so their true fronts are the same"
    if inner_ranges != outer_ranges:
        cause = f"The ranges of {outer.name} contain those of {inner.name}, so its true front is nowhere worse"
    sizes = f"{len(inner.result.designs)} and {len(outer.result.designs)} designs"
    return [f"{cause}: the two fronts are samples of {sizes}, which do not coincide."]


def _difference_table(names: Sequence[str], places: Sequence[tuple[str, Sequence[str | None]]]) -> list[Block]:
    """Return the differences between the jobs of runs as a table."""
    title = Sentence("What differs between the jobs", "heading", space_before=True)
    if len(names) < 2:
        return []
    if not places:
        return [title, sentence("The jobs differ only in their names.")]
    columns = (column(head, left=True) for head in ("Place in the job", *names))
    rows = ((_place_in_words(place), *(value or "–" for value in values)) for place, values in places)
    return [title, Table(tuple(columns), tuple(rows))]


def _place_in_words(place: str) -> str:
    """Return a path in a job in words: "load 1 force", "constraints time ratio min"."""
    table, _, key = place.partition(".")
    parts = (table, *key.rpartition(".")[::2]) if table == "constraints" else place.split(".")  # formulas have points
    return " ".join(filter(None, parts)).replace("_", " ")


def differences_between_jobs(jobs: Sequence[Mapping[str, Any]]) -> list[tuple[str, tuple[str | None, ...]]]:
    """Return the paths at which the tables of jobs differ, such as "load.1.force", with the value in each job.

    The value is None if a job has no value at that path. Names and descriptions are omitted.
    """
    flat = [dict(_leaves(job, "")) for job in jobs]
    places = dict.fromkeys(place for leaves in flat for place in leaves)
    rows = [(place, tuple(leaves.get(place) for leaves in flat)) for place in places]
    return [(place, values) for place, values in rows if place not in _LEFT_OUT and len(set(values)) > 1]


def _leaves(value: Any, place: str) -> list[tuple[str, str]]:
    """Return the values within a table, each with its path.

    Items in lists of tables are numbered from 1; ranges are "a to b".
    """
    if isinstance(value, Mapping):
        return [leaf for key, part in value.items() for leaf in _leaves(part, f"{place}.{key}" if place else str(key))]
    if isinstance(value, list | tuple) and any(isinstance(part, Mapping) for part in value):
        return [leaf for number, part in enumerate(value, 1) for leaf in _leaves(part, f"{place}.{number}")]
    if isinstance(value, list | tuple):
        return [(place, (" to " if len(value) == 2 else ", ").join(map(_value_text, value)))]
    return [(place, _value_text(value))]


def _value_text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.12g}" if isinstance(value, float) else str(value)
