"""Answers of several doors, compared."""

from __future__ import annotations

from typing import Any

import pytest


def assert_same(answer: Any, expected: Any) -> None:
    """Compare two answers; a run has its dimensions in mm, a store in m, to the last digit."""
    if isinstance(expected, dict):
        assert list(answer) == list(expected)
        for key, value in expected.items():
            assert_same(answer[key], value)
    elif isinstance(expected, list):
        assert len(answer) == len(expected)
        for one, other in zip(answer, expected, strict=True):
            assert_same(one, other)
    else:
        assert answer == (pytest.approx(expected, rel=1e-9, abs=1e-9) if isinstance(expected, float) else expected)
