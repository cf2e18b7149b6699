"""Fronts against each other: every figure by plain loops on random sets, and what must hold for any."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.decisions.price_of_robustness import compare_fronts
from tests.optimise.independent import Array


def random_fronts(seed: int, m: int) -> list[Array]:
    """Return three sets in units of different size; some designs are shared."""
    random = np.random.default_rng(seed)
    sets = [random.random((n, m)) * 10.0 ** np.arange(m) - 3.0 for n in (9, 14, 6)]
    sets[1] = np.concatenate([sets[1], sets[0][:3]])
    return sets


def weakly(p: Array, q: Array, room: list[float]) -> bool:
    """Return whether p is at least as good as q in everything, to a tolerance each."""
    return all(p[i] <= q[i] + room[i] for i in range(len(p)))


def beats(p: Array, q: Array, room: list[float]) -> bool:
    """Return whether p dominates q by more than the tolerance."""
    return weakly(p, q, room) and any(p[i] < q[i] - room[i] for i in range(len(p)))


@pytest.mark.parametrize("tolerance", [0.0, 0.05])
@pytest.mark.parametrize("m", [1, 2, 3, 4])
def test_all_figures_agree_with_plain_loops(m: int, tolerance: float) -> None:
    for seed in range(4):
        fronts = random_fronts(seed, m)
        found = compare_fronts(fronts, tolerance=tolerance)
        everything = [point for front in fronts for point in front]
        best = [q for q in everything if not any(beats(p, q, [0.0] * m) for p in everything)]
        low = [min(float(point[i]) for point in best) for i in range(m)]
        assert found.ideal == pytest.approx(low, rel=1e-15)
        alone = all((point == best[0]).all() for point in best)
        widest = everything if alone else best  # a single best design has no range
        spans = [max(float(p[i]) for p in widest) - min(float(p[i]) for p in widest) for i in range(m)]
        assert found.span == pytest.approx(spans, rel=1e-12)
        room = [tolerance * float(size) for size in found.span]
        for a in range(3):
            kept = [q for q in fronts[a] if not any(beats(p, q, room) for p in everything)]
            assert found.in_union[a] == len(kept)
            for b in range(3):
                covered = [q for q in fronts[b] if any(weakly(p, q, room) for p in fronts[a])]
                assert found.coverage[a, b] == pytest.approx(len(covered) / len(fronts[b]), rel=1e-15)
                epsilon = max(
                    min(max((p[i] - q[i]) / found.span[i] for i in range(m)) for p in fronts[a]) for q in fronts[b]
                )
                assert found.epsilon[a, b] == pytest.approx(epsilon, rel=1e-12, abs=1e-15)


def test_hypervolumes_are_those_of_a_count_of_points() -> None:
    """A regular grid of 400 x 400 cells counts areas to about the length of their edge: 2 / 400."""
    fronts = [front[:, :2] for front in random_fronts(3, 2)]
    found = compare_fronts(fronts)
    side = (np.arange(400) + 0.5) / 400.0 * 1.1
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    counted = []
    for front in (*fronts, np.concatenate(fronts)):
        scaled = (front - found.ideal) / found.span
        inside = np.zeros(len(x), dtype=bool)
        for point in scaled:
            inside |= (x >= point[0]) & (y >= point[1])
        counted.append(float(inside.mean()))
    assert [*found.hypervolumes, found.union] == pytest.approx(counted, abs=2.0 / 400.0)
    assert found.shares == pytest.approx(found.hypervolumes / found.union, rel=1e-15)


def test_epsilon_is_what_makes_one_front_cover_the_other() -> None:
    fronts = random_fronts(8, 3)
    found = compare_fronts(fronts)
    for a in range(3):
        for b in range(3):
            for change, covers in ((1e-9, True), (-1e-9, False)):
                better = fronts[a] - (found.epsilon[a, b] + change) * found.span
                assert all((better <= q + 1e-12).all(axis=1).any() for q in fronts[b]) == covers


def test_a_front_equals_itself() -> None:
    front = random_fronts(1, 3)[0]
    found = compare_fronts([front, front])
    assert found.coverage.tolist() == [[1.0, 1.0], [1.0, 1.0]]
    assert found.epsilon == pytest.approx(np.zeros((2, 2)), abs=1e-15)
    assert found.shares == pytest.approx([1.0, 1.0], rel=1e-15)
    assert not found.dominates.any()
    assert found.in_union[0] == found.in_union[1]


def test_a_better_front_dominates_and_the_tolerance_forgives() -> None:
    angle = np.linspace(0.0, 0.5 * math.pi, 30)
    arc = np.stack([1.0 - np.cos(angle), 1.0 - np.sin(angle)], axis=1)
    found = compare_fronts([arc, arc + 1e-4])
    assert found.dominates.tolist() == [[False, True], [False, False]]
    assert found.in_union.tolist() == [30, 0]
    assert found.epsilon[1, 0] == pytest.approx(1e-4, rel=1e-6)
    forgiving = compare_fronts([arc, arc + 1e-4], tolerance=2e-4)
    assert not forgiving.dominates.any()
    assert forgiving.in_union.tolist() == [30, 30]


def test_nothing_depends_on_units_or_zero() -> None:
    fronts = random_fronts(4, 3)
    one = compare_fronts(fronts, tolerance=0.01)
    two = compare_fronts(
        [front * np.array([1e-3, 57.0, 1e4]) + np.array([5.0, -2.0, 1.0]) for front in fronts], tolerance=0.01
    )
    for name in ("hypervolumes", "shares", "in_union", "coverage", "epsilon", "dominates"):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-9, abs=1e-12)


def test_what_cannot_be_compared_is_said() -> None:
    front = random_fronts(0, 2)[0]
    with pytest.raises(InputError, match="at least two fronts; got 1"):
        compare_fronts([front])
    with pytest.raises(InputError, match="must have designs"):
        compare_fronts([front, front[:0]])
    with pytest.raises(InputError, match="different numbers"):
        compare_fronts([front, front[:, :1]])
    with pytest.raises(InputError, match="fraction of the range, zero or more; got -1"):
        compare_fronts([front, front], tolerance=-1.0)
