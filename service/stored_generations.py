"""What a run needs to go on, on the disk: one file, replaced as a whole.

`generations.npz` in the folder of a run, without pickles: the records of its search, and the settings that the command
was given, which may differ from those of the job.
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
from .store.packing import packed, unpacked
from .stored_runs import read_run

if TYPE_CHECKING:
    from ..optimise.ledger import Record
    from ..optimise.problem import Problem, Settings

FILE = "generations.npz"
_FORM = 2
_PAUSE = 1.0  # s between two writings: a kill loses no more than this and the step under way


class GenerationsFile:
    """Keeps the records of a run in its folder as they come."""

    def __init__(self, folder: Path, settings: Settings, past: list[Record]) -> None:
        """Go on after `past`, what the file holds already."""
        self.path = folder / FILE
        self.settings = settings
        self.generations = list(past)
        self._written = len(past)
        self._when = -_PAUSE

    def keep(self, record: Record) -> None:
        """Take in the next record; write the file unless it was written a moment ago."""
        self.generations.append(record)
        if time.monotonic() - self._when >= _PAUSE:
            self.write()

    def write(self) -> None:
        """Write what is not in the file yet. Raises `RunError` when the disk refuses."""
        if self._written == len(self.generations):
            return
        write_bytes(self.path, _file(self.settings, self.generations))
        self._written = len(self.generations)
        self._when = time.monotonic()

    def remove(self) -> None:
        """Take the file away: nothing is left to go on with."""
        self.path.unlink(missing_ok=True)


def read_generations(folder: Path) -> tuple[Settings, list[Record]]:
    """Return the settings of a run and the records that it kept.

    Raises `RunError` if it kept none, or the file is damaged.
    """
    import numpy as np

    from ..optimise.problem import Settings

    path = folder / FILE
    if not path.is_file():
        raise RunError(
            f"a run goes on from what it kept in {FILE}; {folder} has none: it was stopped before its first round; run "
            "its job again"
        )
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:  # a path stays open when damaged
            if int(file["form"]) != _FORM:
                raise ValueError(f"its form is {int(file['form'])}, not {_FORM}")
            settings = Settings(**json.loads(str(file["settings"])))
            return settings, [unpacked(file[f"record{number}"].tobytes()) for number in range(int(file["count"]))]
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, InputError, RunError) as error:
        raise RunError(f"{path} is damaged: {type(error).__name__}: {error}; run the job again") from error


def stopped_run(folder: Path) -> tuple[Problem, list[Record]]:
    """Return the problem of an interrupted or cancelled run, with the settings that it had, and its records.

    Raises `RunError` for a run that cannot go on: finished, damaged, or without records.
    """
    from ..optimise.job import load_job

    if not (folder / MARK).exists():
        status = read_run(folder).status
        if status != "cancelled":
            raise RunError(f"only an interrupted or cancelled run can go on; {folder} is {status}; run its job anew")
    settings, records = read_generations(folder)
    job = next((folder / name for name in ("job.toml", "job.json") if (folder / name).is_file()), None)
    if job is None:
        raise RunError(f"the run {folder} is damaged: it has no job; run its job again from where it is kept")
    return replace(load_job(job), settings=settings), records


def _file(settings: Settings, records: list[Record]) -> bytes:
    import numpy as np

    out = io.BytesIO()
    arrays: dict[str, Any] = {
        f"record{number}": np.frombuffer(packed(record), dtype=np.uint8) for number, record in enumerate(records)
    }
    np.savez(
        out,
        form=np.array(_FORM),
        settings=np.array(json.dumps(asdict(settings))),
        count=np.array(len(records)),
        **arrays,
    )
    return out.getvalue()
