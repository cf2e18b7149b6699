"""Samples cover the box and its faces, the same in every run."""

from __future__ import annotations

import numpy as np
import pytest

from slidercrank.optimise.search.sampling import (
    BOUNDARY_SHARE,
    draw_rows,
    first_samples,
    random_generator,
    sample_near_parents,
)


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_first_samples_lie_in_the_box_with_a_share_on_every_face(dimension: int) -> None:
    """The share of a coordinate on its two bounds is BOUNDARY_SHARE; five standard deviations of 4,096 draws."""
    points = first_samples(4096, dimension, 1, 0)
    assert points.shape == (4096, dimension)
    assert points.min() >= 0.0
    assert points.max() <= 1.0
    for column in points.T:
        for bound in (0.0, 1.0):
            share = BOUNDARY_SHARE / 2.0
            assert abs(np.mean(column == bound) - share) <= 5.0 * np.sqrt(share * (1.0 - share) / 4096)


def test_every_corner_is_sampled() -> None:
    points = first_samples(4096, 3, 1, 0)
    corners = points[((points == 0.0) | (points == 1.0)).all(axis=1)]
    assert len(np.unique(corners, axis=0)) == 8


def test_what_is_not_on_a_face_covers_the_inside_evenly() -> None:
    """Low discrepancy: of 64 cells none holds less than half or more than twice its share."""
    points = first_samples(8192, 2, 3, 0)
    inside = points[((points > 0.0) & (points < 1.0)).all(axis=1)]
    cells = (8.0 * inside).astype(int)
    counts = np.bincount(8 * cells[:, 0] + cells[:, 1], minlength=64)
    assert counts.min() >= 0.5 * len(inside) / 64
    assert counts.max() <= 2.0 * len(inside) / 64


@pytest.mark.parametrize("count", [1, 3, 100, 1000])
def test_any_number_of_samples_can_be_asked(count: int) -> None:
    assert first_samples(count, 2, 1, 0).shape == (count, 2)


def test_without_freedom_there_is_one_point() -> None:
    assert first_samples(100, 0, 1, 0).shape == (1, 0)


def test_seed_and_stream_decide_the_samples() -> None:
    assert np.array_equal(first_samples(64, 3, 5, 2), first_samples(64, 3, 5, 2))
    assert not np.array_equal(first_samples(64, 3, 5, 2), first_samples(64, 3, 6, 2))
    assert not np.array_equal(first_samples(64, 3, 5, 2), first_samples(64, 3, 5, 3))
    assert random_generator(1, 2, 3).random() == random_generator(1, 2, 3).random()
    assert random_generator(1, 2, 3).random() != random_generator(1, 3, 2).random()


def test_children_stay_in_the_box_and_mostly_on_their_parents_bounds() -> None:
    parents = np.array([[0.0, 0.5], [1.0, 0.3], [0.4, 1.0]])
    children = sample_near_parents(
        parents, np.array([[0.0, 1.0], [0.5, 0.4], [1.0, 0.0]]), 3000, 0.05, random_generator(1)
    )
    assert children.shape == (3000, 2)
    assert children.min() >= 0.0
    assert children.max() <= 1.0
    on_bound = ((children == 0.0) | (children == 1.0)).any(axis=1)
    assert 0.6 <= on_bound.mean() <= 0.95


def test_sparse_parts_of_the_front_get_more_children() -> None:
    """Nine parents close together and one far away: it gets more than its tenth."""
    line = np.append(np.linspace(0.0, 0.1, 9), 1.0)
    parents = np.stack([0.2 + 0.5 * line, np.full(10, 0.5)], axis=1)
    children = sample_near_parents(parents, np.stack([line, 1.0 - line], axis=1), 2000, 0.001, random_generator(2))
    assert np.mean(children[:, 0] > 0.6) >= 0.5


def test_a_single_parent_has_children_too() -> None:
    children = sample_near_parents(np.array([[0.5, 0.5]]), np.array([[1.0, 2.0]]), 50, 0.1, random_generator(3))
    assert children.shape == (50, 2)
    assert children.std() > 0.01


def test_rows_are_drawn_as_the_generator_draws_them() -> None:
    random = np.random.default_rng(5)
    for count in (1, 7, 500):
        chances = random.random(40) ** 4
        chances /= chances.sum()
        one, other = np.random.default_rng(count), np.random.default_rng(count)
        np.testing.assert_array_equal(draw_rows(chances, count, one), other.choice(40, size=count, p=chances))
        assert one.random() == other.random()
