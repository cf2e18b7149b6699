"""Set up once for all tests: fixed random cases."""

import gc

import pytest
from hypothesis import settings

# Kernels may compile within a test, so that no deadline holds; the same cases come in every run.
settings.register_profile("fixed", deadline=None, derandomize=True)


def pytest_configure(config: pytest.Config) -> None:
    settings.load_profile("fixed")
    gc.disable()  # while objects only come


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put slow tests first: they wait most of their time, and the others fill their pauses instead of ending sooner."""
    items.sort(key=lambda item: item.get_closest_marker("slow") is None)


def pytest_collection_finish() -> None:
    """Keep what was imported and collected, some 10^5 objects, out of every later search for garbage."""
    gc.freeze()
    gc.enable()
