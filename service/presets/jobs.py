"""Tables of the shipped jobs."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files
from typing import Any

from .. import presets


@cache
def shipped_jobs() -> dict[str, dict[str, Any]]:
    """Return the jobs of runs/, which every installation carries, by the names of their files.

    With the catalogues that lie beside them: who starts from one has no such file.
    """
    from ...optimise.job import read_job

    with as_file(files(presets)) as folder:
        return {file.stem: read_job(file) for file in sorted(folder.glob("*.toml"))}
