"""Generations of a run on the disk: one file, replaced as a whole, from which the run can go on.

`generations.npz` in the folder of a run, without pickles: every array of the generations end to end, where each begins,
and the settings that the command was given, which may differ from those of the job.
"""

from __future__ import annotations

import io
import json
import time
import zipfile
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..model.errors import InputError, RunError
from .run_folder import MARK, write_bytes
from .stored_runs import read_run

if TYPE_CHECKING:
    from ..optimise.methods.generation import Generation
    from ..optimise.problem import Problem, Settings

FILE = "generations.npz"
_FORM = 1
_ARRAYS = ("sheet", "u", "values", "violation")
_PAUSE = 1.0  # s between two writings: a kill loses no more than this and the generation under way


class GenerationsFile:
    """Keeps the generations of a run in its folder as they come."""

    def __init__(self, folder: Path, settings: Settings, past: list[Generation]) -> None:
        """Go on after `past`, what the file holds already."""
        self.path = folder / FILE
        self.settings = settings
        self.generations = list(past)
        self._written = len(past)
        self._when = -_PAUSE

    def keep(self, generation: Generation) -> None:
        """Take in the next generation; write the file unless it was written a moment ago."""
        self.generations.append(generation)
        if time.monotonic() - self._when >= _PAUSE:
            self.write()

    def write(self) -> None:
        """Write what is not in the file yet. Raises `RunError` when the disk refuses."""
        if self._written == len(self.generations):
            return
        write_bytes(self.path, _packed(self.settings, self.generations))
        self._written = len(self.generations)
        self._when = time.monotonic()

    def remove(self) -> None:
        """Take the file away: nothing is left to go on with."""
        self.path.unlink(missing_ok=True)


def read_generations(folder: Path) -> tuple[Settings, list[Generation]]:
    """Return the settings of a run and the generations that it kept.

    Raises `RunError` if it kept none, or the file is damaged.
    """
    import numpy as np

    from ..optimise.methods.generation import Generation
    from ..optimise.problem import Settings

    path = folder / FILE
    if not path.is_file():
        raise RunError(
            f"a run goes on from the generations that it kept in {FILE}; {folder} has none: its method keeps none, or "
            "it was stopped before the first; run its job again"
        )
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:  # a path stays open when damaged
            if int(file["form"]) != _FORM:
                raise ValueError(f"its form is {int(file['form'])}, not {_FORM}")
            settings = Settings(**json.loads(str(file["settings"])))
            arrays = [np.split(file[name], file["begins"][1:]) for name in _ARRAYS]
            parents = np.split(file["parents"], file["parents_begin"][1:])
            return settings, [Generation(*own) for own in zip(*arrays[:2], parents, *arrays[2:], strict=True)]
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, InputError) as error:
        raise RunError(f"{path} is damaged: {type(error).__name__}: {error}; run the job again") from error


def stopped_run(folder: Path) -> tuple[Problem, list[Generation]]:
    """Return the problem of an interrupted or cancelled run, with the settings that it had, and its generations.

    Raises `RunError` for a run that cannot go on: finished, damaged, or without generations.
    """
    from ..optimise.job import load_job

    if not (folder / MARK).exists():
        status = read_run(folder).status
        if status != "cancelled":
            raise RunError(f"only an interrupted or cancelled run can go on; {folder} is {status}; run its job anew")
    settings, generations = read_generations(folder)
    job = next((folder / name for name in ("job.toml", "job.json") if (folder / name).is_file()), None)
    if job is None:
        raise RunError(f"the run {folder} is damaged: it has no job; run its job again from where it is kept")
    return replace(load_job(job), settings=settings), generations


def _packed(settings: Settings, generations: list[Generation]) -> bytes:
    import numpy as np

    def begins(lengths: list[int]) -> Any:
        return np.cumsum([0, *lengths[:-1]])

    arrays: dict[str, Any] = {
        name: np.concatenate([getattr(generation, name) for generation in generations])
        for name in (*_ARRAYS, "parents")
    }
    arrays["begins"] = begins([len(generation) for generation in generations])
    arrays["parents_begin"] = begins([len(generation.parents) for generation in generations])
    out = io.BytesIO()
    np.savez(out, form=np.array(_FORM), settings=np.array(json.dumps(asdict(settings))), **arrays)
    return out.getvalue()
