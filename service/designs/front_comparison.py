"""Comparison of several fronts in words: which extends furthest, which dominates which, and where."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array
from ...objectives.kinds import System, count_with_noun, metric_unit_in
from ..runs.result import Result, StoredObjective
from .design_selection_options import minimised_values

_SAME = 1e-6
"""Fraction of an objective's range that counts as equal: about the accuracy of designs."""
NEAR = 0.02
"""Fraction of an objective's range within which designs match: two samples of one front lie side by side."""
_TO = f"to {100 * NEAR:g} % of each range"


def comparison_sentences(names: Sequence[str], results: Sequence[Result], system: System = "metric") -> list[str]:
    """Compare fronts with one another in sentences.

    names: names of the runs. results: results with designs. Only objectives that all runs share, with the same sense,
    are compared.
    """
    shared = _shared_objectives(results)
    if not shared:
        return ["The runs share no objective, so they cannot be ranked"]
    fronts = [_minimised_shared_objectives(result, shared) for result in results]
    span = np.ptp(np.concatenate(fronts), axis=0)
    span[span == 0.0] = 1.0
    sentences = [
        _best_front_text(names, results, objective, index, fronts, span, system)
        for index, objective in enumerate(shared)
    ]
    for a in range(len(names)):
        for b in range(len(names)):
            if a != b:
                sentences += _unmatched_sentence(
                    names[a], names[b], results[a], shared, fronts[a] / span, fronts[b] / span, system
                )
    return sentences


def cost_of_change(names: Sequence[str], results: Sequence[Result], system: System = "metric") -> list[str]:
    """Return a sentence on the costs and gains of the second of two runs, in best values.

    names, results: as in `comparison_sentences`; no sentence for another number of runs, or if only targets are shared.
    """
    shared = [item for item in _shared_objectives(results) if item.target is None] if len(results) == 2 else []
    words: dict[str, list[str]] = {"costs": [], "gains": [], "does not change": []}
    best = (
        [_minimised_shared_objectives(result, shared).min(axis=0).tolist() for result in results]
        if shared
        else [[], []]
    )
    for objective, old, new in zip(shared, *best, strict=True):
        ends = [_with_unit(value, objective, system) for value in (old, new)]
        if not np.isfinite([old, new]).all():
            return []
        is_same = ends[0] == ends[1] or abs(new - old) <= _SAME * max(abs(old), abs(new))
        amount = "" if is_same else f"{_with_unit(abs(new - old), objective, system)} of "
        words["does not change" if is_same else "costs" if new > old else "gains"].append(f"{amount}{objective.title}")
    clauses = [f"{verb} {' and '.join(items)}" for verb, items in words.items() if items]
    return [f"at best, {names[1]} instead of {names[0]} {', '.join(clauses)}"] if clauses else []


def _shared_objectives(results: Sequence[Result]) -> list[StoredObjective]:
    kinds = [{(item.quantity, item.sense, item.target): item for item in result.objectives} for result in results]
    return [item for key, item in kinds[0].items() if all(key in objectives for objectives in kinds[1:])]


def _minimised_shared_objectives(result: Result, shared: Sequence[StoredObjective]) -> Array:
    """Return the shared objectives of a result (n, m), all minimised; infinite if undefined."""
    order = [item.quantity for item in result.objectives]
    values = minimised_values(result)[:, [order.index(item.quantity) for item in shared]]
    return np.asarray(np.where(np.isfinite(values), values, np.inf))


def _best_front_text(
    names: Sequence[str],
    results: Sequence[Result],
    objective: StoredObjective,
    index: int,
    fronts: Sequence[Array],
    span: Array,
    system: System,
) -> str:
    """Return the front with the best value of an objective, and the best values of the other fronts."""
    rows = [int(np.argmin(front[:, index])) for front in fronts]
    least = np.array([front[row, index] for front, row in zip(fronts, rows, strict=True)])
    values = [
        _with_unit(result.designs[row][objective.column], objective, system)
        for result, row in zip(results, rows, strict=True)
    ]
    shown = values[int(np.argmin(least))]  # values that read the same are equal
    first = [n for n in range(len(names)) if least[n] <= least.min() + _SAME * span[index] or values[n] == shown]
    title = f"best {objective.title}"
    if len(first) == len(names):
        return f"{title}: all reach {values[0]}"
    rest = [f"{values[n]} of {names[n]}" for n in range(len(names)) if n not in first]
    return f"{title}: {' and '.join(names[n] for n in first)} with {values[first[0]]}, against {', '.join(rest)}"


def _unmatched_sentence(
    name: str,
    other_name: str,
    result: Result,
    shared: Sequence[StoredObjective],
    front: Array,
    other_front: Array,
    system: System,
) -> list[str]:
    """Return the number of designs of one front that the other does not match, and where they lie."""
    free = designs_without_match(front, other_front)
    count, total = int(free.sum()), len(front)
    if count == 0:
        return [f"{other_name} matches or beats every design of {name}, {_TO}"]
    if count == total:
        return [f"{other_name} matches none of the {count_with_noun(total, 'design')} of {name}, {_TO}"]
    parts = [
        text
        for n, objective in enumerate(shared)
        if (text := _range_in_words(result, free, objective, front[:, n], system))
    ]
    place = f": where {', '.join(parts)}" if parts else ", spread over the whole front"
    return [f"{name} has {count} of {count_with_noun(total, 'design')} that {other_name} does not match, {_TO}{place}"]


def designs_without_match(front: Array, other_front: Array) -> NDArray[np.bool_]:
    """Return the designs (n, m) that no other design (k, m) matches or beats; scaled objectives, all minimised."""
    return np.array([not bool((other_front <= point + NEAR).all(axis=1).any()) for point in front])


def _range_in_words(
    result: Result, free: NDArray[np.bool_], objective: StoredObjective, values: Array, system: System
) -> str:
    """Return the part of an objective's range that contains the selected designs; empty if they cover most of it."""
    low, high = values[free].min(), values[free].max()
    is_between = (values >= low) & (values <= high)
    if is_between.mean() > 0.7:
        return ""
    cells = [result.designs[row][objective.column] for row in np.flatnonzero(free)]
    numbers = [float(cell) for cell in cells if isinstance(cell, float)]
    ends = [_with_unit(end, objective, system) for end in (min(numbers), max(numbers))]
    return f"{objective.title} is {ends[0]}" if ends[0] == ends[1] else f"{objective.title} is {ends[0]} to {ends[1]}"


def _with_unit(value: object, objective: StoredObjective, system: System) -> str:
    unit, factor = metric_unit_in(objective.unit, system)
    return f"{value * factor:.4g} {unit}".rstrip() if isinstance(value, float) else "not defined"
