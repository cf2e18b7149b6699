"""Fixtures of the tests of the optimiser."""

import pytest

from tests.optimise.problems import polish_few


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Polish few designs a search, for what holds of any front."""
    polish_few(monkeypatch)
