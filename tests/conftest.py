"""Set up once for all tests: fixed random cases."""

import gc
import os
from contextlib import suppress
from importlib import import_module

import pytest
from hypothesis import settings

from tests.case_count import is_usual
from tests.order import shared_out
from tests.shared import shared_by_workers

__all__ = ["shared_by_workers"]  # a fixture for all tests

# Kernels may compile within a test, so that no deadline holds; the same cases come in every run.
settings.register_profile("fixed", deadline=None, derandomize=True)


def pytest_configure(config: pytest.Config) -> None:
    settings.load_profile("fixed")
    if "NUMBA_CPU_NAME" in os.environ:
        # Another processor's kernels are for these tests alone: no processes besides compile those that none calls.
        pytest.MonkeyPatch().setattr("slidercrank.model.kernel.disk_cache.compile_in_processes", lambda *_: None)
    gc.disable()  # while objects only come


def pytest_sessionstart(session: pytest.Session) -> None:
    """Import each worker's share of the test files first: what pytest makes of their asserts is kept for the others.

    Otherwise all workers would be at the same file at the same time, and each make the same of it.
    """
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    if workers > 1:
        first = int(os.environ["PYTEST_XDIST_WORKER"].removeprefix("gw"))
        given = [session.config.rootpath / argument.partition("::")[0] for argument in session.config.args]
        files = sorted({file for place in given for file in (place.rglob("test_*.py") if place.is_dir() else [place])})
        for file in files[first::workers]:
            with suppress(Exception, pytest.skip.Exception):  # collecting says it
                import_module(".".join(file.relative_to(session.config.rootpath).with_suffix("").parts))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave out random cases beyond the usual ones; put tests into the order that fills the workers of pytest-xdist."""
    items[:] = [item for item in items if is_usual(getattr(item, "callspec", None))]
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    if workers > 1:
        slow = {item: True for item in items if item.get_closest_marker("slow")}
        items[:] = shared_out(items, workers, lambda item: item.nodeid.partition("::")[0], slow)


def pytest_collection_finish() -> None:
    """Keep what was imported and collected, some 10^5 objects, out of every later search for garbage.

    Such searches are rarer than usual: what tests import later is looked through each time, 3 % of all they take.
    """
    gc.freeze()
    gc.set_threshold(10_000, 10, 50)
    gc.enable()
