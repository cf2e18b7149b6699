"""Results that several test files need: computed by one worker of pytest-xdist, read by the others."""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import TypeVar

import pytest

if sys.platform != "win32":
    from fcntl import LOCK_EX, flock

Found = TypeVar("Found")

folders: list[Path] = []  # where the workers of this run keep what they share; none without workers


@pytest.fixture(scope="session", autouse=True)
def shared_by_workers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Let workers share what they compute, in the temporary folder that all of them have theirs in."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        folders.append(tmp_path_factory.getbasetemp().parent)
    yield
    folders.clear()


def computed_once(compute: Callable[[str], Found]) -> Callable[[str], Found]:
    """Return a function of a name that keeps its results, by pickle, for all workers."""

    @cache
    def shared(name: str) -> Found:
        if not folders or sys.platform == "win32":  # without locks of files every worker computes its own
            return compute(name)
        file = folders[0] / f"{compute.__module__}.{compute.__qualname__}-{name}"
        with Path(f"{file}.lock").open("w") as lock:
            flock(lock, LOCK_EX)
            if not file.exists():
                file.write_bytes(pickle.dumps(compute(name)))
        found: Found = pickle.loads(file.read_bytes())
        return found

    return shared
