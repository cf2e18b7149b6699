"""Tables of the shipped jobs."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files
from typing import Any

from .. import presets


@cache
def shipped_jobs() -> dict[str, dict[str, Any]]:
    """Return the jobs in runs/, which every installation includes, by file name.

    Includes the catalogues beside them: users who start from a shipped job do not have these files.
    """
    from ...optimise.job import read_job

    with as_file(files(presets)) as folder:
        return {file.stem: read_job(file) for file in sorted(folder.glob("*.toml"))}
