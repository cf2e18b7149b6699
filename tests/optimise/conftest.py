"""Fixtures of the tests of the optimiser."""

import pytest

from tests.optimise.problems import polish_few, search_little


@pytest.fixture
def little(monkeypatch: pytest.MonkeyPatch) -> None:
    """Search little, for what holds of any front."""
    search_little(monkeypatch)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Polish few designs a search, for what holds of any front that is well begun."""
    polish_few(monkeypatch)
