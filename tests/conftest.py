"""Set up once for all tests: compiled kernels that match the sources, and fixed random cases."""

from importlib.util import find_spec
from pathlib import Path

import pytest
from hypothesis import settings

# Kernels may compile within a test, so that no deadline holds; the same cases come in every run.
settings.register_profile("fixed", deadline=None, derandomize=True)


def pytest_configure(config: pytest.Config) -> None:
    settings.load_profile("fixed")
    if not hasattr(config, "workerinput"):  # workers of xdist start after this ran in their parent
        delete_stale_kernels()


def delete_stale_kernels() -> None:
    """Delete numba's cached kernels if a source file is newer than the oldest of them.

    numba compares a kernel with the time of its own file only; a kernel that has a formula of
    another file compiled into it would stay as it was.
    """
    folders = [*places("model"), *places("optimise.certificate")]  # where all that is compiled stands
    sources = [file.stat().st_mtime_ns for folder in folders for file in folder.rglob("*.py")]
    kernels = [file for folder in folders for file in folder.rglob("__pycache__/*.nb[ic]")]
    if kernels and max(sources) > min(file.stat().st_mtime_ns for file in kernels):
        for file in kernels:
            file.unlink(missing_ok=True)


def places(name: str) -> list[Path]:
    """Return the folder of `slidercrank.<name>`, wherever it is installed, without importing it."""
    spec = find_spec(f"slidercrank.{name}")
    return [Path(place) for place in spec.submodule_search_locations or []] if spec else []
