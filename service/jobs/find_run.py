"""Search for a run: a folder on disk, or a stored job, whose folder is written on demand."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...model.errors import InputError, NotFound
from ...model.file_name_encoding import path_text
from ..runs.run_folder import MARK, RunFolder
from .stores import has_store, open_store

if TYPE_CHECKING:
    from ..store import Job, State, Store

_FOUND: tuple[State, ...] = ("done", "infeasible", "cancelled")


def find_run(text: str, place: Path) -> Path:
    """Return the folder of a run, given by path, name, unique prefix of a name, or "latest".

    A job number in the store is accepted too; its folder is written if missing. Raises `InputError` if no run or
    several runs match, and `RunError` for a job without a result yet.
    """
    if (text == "latest" or not Path(text).exists()) and has_store(None, place):
        with open_store(None, place) as store:
            job = _stored_job(store, text, place)
            if job is not None:
                return export_run_folder(store, job, place)
    return find_folder(text, place)


def export_run_folder(store: Store, job: Job, place: Path) -> Path:
    """Write the run folder of a job that has a result, unless it exists, and return it."""
    path = place / job.run
    if path.is_dir():
        return path
    result = store.result(job.id)
    files = {name: store.artefact(job.id, name).content for name in store.artefact_names(job.id)}
    versions = json.loads(files.pop("versions.json", b"{}"))
    with RunFolder(place, job.name) as folder:
        folder.rename(job.run)
        folder.keep_files(files)
        folder.keep_result(replace(result, run=path_text(path)), versions)
    return path


def _stored_job(store: Store, text: str, place: Path) -> Job | None:
    """Return the job that a text refers to, or None if it refers to a folder."""
    if text.isdecimal():
        try:
            return store.job(int(text))
        except NotFound:
            return None
    if text == "latest":
        latest = store.jobs(states=_FOUND, limit=1)
        names = [folder.name for folder in run_folders(place)]
        return latest[0] if latest and latest[0].run > max(names, default="") else None
    return store.find_by_run(text)


def find_folder(text: str, place: Path) -> Path:
    """Return the folder of a run on disk; see `find_run`.

    Raises `InputError` if no run or several runs match.
    """
    names = sorted(
        (run.name for run in run_folders(place)), key=lambda name: (name[:15], (place / name).stat().st_mtime_ns)
    )
    if text == "latest":
        if not names:
            raise InputError(f"there is no run in {place} yet; optimise a job first")
        return place / names[-1]
    if text in names:
        return place / text
    path = Path(text)
    if text and path.is_dir():
        return path
    if text and path.exists():
        raise InputError(f"a run must be a folder; got the file {text}; name its folder")
    matches = [name for name in names if name.startswith(text)] if text else []
    if len(matches) == 1:
        return place / matches[0]
    if matches:
        examples = ", ".join(matches[:4]) + (", ..." if len(matches) > 4 else "")
        raise InputError(f"the start of a run's name must be unique; {text!r} matches {examples}; give more of it")
    last = f"; the latest is {names[-1]}" if names else ""
    raise InputError(f"there is no run {path_text(text)!r}, neither as a folder nor in {place}{last}")


def run_folders(place: Path) -> list[Path]:
    """Return the run folders in a location, unordered."""
    if not place.is_dir():
        return []
    return [
        folder
        for folder in place.iterdir()
        if not folder.name.startswith(".") and ((folder / MARK).is_file() or (folder / "front.json").is_file())
    ]
