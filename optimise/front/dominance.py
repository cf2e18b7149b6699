"""Dominance between designs: no worse in every objective, better in one; all objectives are minimised."""

import math

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ...model.kernel.batches import run_in_chunks
from ...model.kernel.kernel import Cube, Flags, IntegerTable, Table, kernel

_WORD = 63  # designs per integer word of mask bits, whose sign bit is unused
_CHUNK = 2048  # designs that one thread filters at a time
# With fewer objectives, or with more designs, an n log n filter is faster.
_OBJECTIVES, _MANY = 4, 40_000


def nondominated(values: Array) -> IntArray:
    """Return the ascending indices of designs that no other design dominates; of equal designs, the first.

    Designs are sorted by the first objective, so only earlier designs may dominate a later one. For each other
    objective, bits mark the designs up to a given rank. The intersection over all objectives contains the few designs
    that may be as good as the one with these ranks. Only these are compared with it.
    """
    count, objectives = values.shape
    if not count:
        return np.zeros(0, dtype=np.int64)
    if objectives == 1:
        return np.array([int(np.argmin(values[:, 0]))])
    if objectives < _OBJECTIVES or count > _MANY or not np.isfinite(values).all():
        import moocore

        return np.flatnonzero(moocore.is_nondominated(np.ascontiguousarray(values), keep_weakly=False))
    order = np.argsort(values[:, 0])
    equal = np.diff(values[order, 0]) == 0.0
    if equal.any():
        tied = np.append(equal, False) | np.append(False, equal)
        those = np.sort(order[tied])
        order[tied] = those[np.lexsort(values[those].T[::-1])]
    ordered = np.ascontiguousarray(values[order, 1:].T)
    ranked = np.argsort(ordered, axis=1)
    words = -(-count // _WORD)
    bits, upto = np.zeros((len(ordered) * words, words), np.int64), np.empty(ordered.shape, np.int64)
    _mark_prefixes(ordered, ranked, bits, upto)
    by_word = np.pad(ordered, ((0, 0), (0, words * _WORD - count))).reshape(-1, words, _WORD)
    undominated = np.ones(count, np.bool_)
    run_in_chunks(
        count, lambda begin, end: _mark_undominated(by_word, bits, upto, begin, end, undominated), size=_CHUNK
    )
    return np.sort(order[undominated])


@kernel
def _mark_prefixes(ordered: Table, ranked: IntegerTable, bits: IntegerTable, upto: IntegerTable) -> None:
    """Set, for each word of the order by an objective, the bits of the designs up to its end.

    upto: row of bits for the last design that is as good as this one in an objective.
    """
    count, words = ranked.shape[1], bits.shape[1]
    for column in range(ranked.shape[0]):
        last = count - 1
        for place in range(count - 1, -1, -1):
            if ordered[column, ranked[column, place]] < ordered[column, ranked[column, last]]:
                last = place
            upto[column, ranked[column, place]] = column * words + last // _WORD
        for word in range(words):
            row = column * words + word
            if word:
                for i in range(words):
                    bits[row, i] = bits[row - 1, i]
            for place in range(word * _WORD, min((word + 1) * _WORD, count)):
                design = ranked[column, place]
                bits[row, design // _WORD] |= 1 << (design % _WORD)


@kernel
def _mark_undominated(
    by_word: Cube, bits: IntegerTable, upto: IntegerTable, begin: int, end: int, undominated: Flags
) -> None:
    """Mark the designs from `begin` to `end` for which no earlier design is as good in all of these objectives."""
    candidates = np.empty(bits.shape[1], np.int64)
    for i in range(begin, end):
        words, first, second = 1 + i // _WORD, upto[0, i], upto[1, i]
        for w in range(words):
            candidates[w] = bits[first, w] & bits[second, w]
        for column in range(2, by_word.shape[0]):
            row = upto[column, i]
            for w in range(words):
                candidates[w] &= bits[row, w]
        candidates[words - 1] &= (1 << (i % _WORD)) - 1  # designs before this one
        for w in range(words):
            for column in range(by_word.shape[0]):
                if not candidates[w]:
                    break
                value, as_good = by_word[column, words - 1, i % _WORD], 0
                for k in range(_WORD):
                    as_good |= (by_word[column, w, k] <= value) << k
                candidates[w] &= as_good
            if candidates[w]:
                undominated[i] = False
                break


@kernel
def _mark_dominating(points: Table, rivals: Table, clearly: float, slightly: float, dominates: Flags) -> None:
    for i in range(points.shape[0]):
        for k in range(rivals.shape[0]):
            worst, best, comparable = -np.inf, np.inf, True
            for j in range(rivals.shape[1]):
                difference = points[i, j] - rivals[k, j]
                worst, best, comparable = (
                    max(worst, difference),
                    min(best, difference),
                    comparable and not math.isnan(difference),
                )
            if comparable and ((worst <= 0.0 and -best > clearly) or (worst <= clearly and -best > slightly)):
                dominates[i] = True
                break


def dominating(points: Array, rivals: Array, *, clearly: float, slightly: float = np.inf) -> Mask:
    """Return which points (n, m) dominate any rival (k, m) and are better by more than `clearly` in some objective.

    slightly: a point that is better by more than this in one objective may be worse by up to `clearly` in others.
    """
    dominates = np.zeros(len(points), dtype=bool)
    points, rivals = np.ascontiguousarray(points), np.ascontiguousarray(rivals)
    run_in_chunks(
        len(points),
        lambda begin, end: _mark_dominating(points[begin:end], rivals, clearly, slightly, dominates[begin:end]),
    )
    return dominates
