"""Counts in messages."""

from __future__ import annotations

from slidercrank.objectives.kinds import count_with_noun


def test_only_one_of_something_is_in_the_singular() -> None:
    assert [count_with_noun(count, "design") for count in (0, 1, 2)] == ["0 designs", "1 design", "2 designs"]
