"""Folder for compiled kernels.

Kernels are never stored next to the sources: there they would outlive the software, and its empty folders would stay
importable.
"""

from __future__ import annotations

import contextlib
import logging
import os
import stat
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

_log = logging.getLogger(__name__)

_REMEDY = "set NUMBA_CACHE_DIR to a writable folder"


class Chosen(NamedTuple):
    """Choice of a folder for kernels.

    folder: None if no location is writable. empty: whether it has no kernels yet. refused: reasons why other locations
    were refused. readable: earlier locations that are read-only.
    """

    folder: Path | None
    empty: bool
    refused: str
    readable: tuple[Path, ...] = ()


def kernel_folder() -> Path | None:
    """Return this process's folder for kernels, None if no location is writable."""
    return _chosen().folder


def read_only_folders() -> tuple[Path, ...]:
    """Return folders from which kernels can only be read, as in an image."""
    return _chosen().readable


@cache
def log_refused_folders() -> None:
    """Log once which locations were refused, if the folder is empty or missing. For processes that have to compile."""
    folder, empty, refused, _ = _chosen()
    if folder is None:
        _log.warning(f"slidercrank will compile for a minute at every start: {refused}; {_REMEDY}")
    elif empty and refused:
        _log.warning(
            f"slidercrank keeps compiled kernels in {folder.parent}: {refused}; to keep them longer, {_REMEDY}"
        )


def choose_folder() -> Chosen:
    """Return the folder in the first writable location, created if necessary.

    Locations are NUMBA_CACHE_DIR, the user's cache folder, and a folder for this user alone among temporary files.
    """
    refused: list[str] = []
    readable: list[Path] = []
    for place in _candidate_folders():
        folder = place / "kernels"
        reason = _refusal(folder)
        if reason is None:
            return Chosen(folder, not any(folder.iterdir()), "; ".join(refused), tuple(readable))
        refused.append(f"{place} {reason}")
        if _is_trusted(folder):
            readable.append(folder)
    return Chosen(None, False, "; ".join(refused), tuple(readable))


_chosen = cache(choose_folder)


def _candidate_folders() -> Iterator[Path]:
    """Yield the locations where the folder may be."""
    cache_folder = os.environ.get("NUMBA_CACHE_DIR")
    if cache_folder:
        yield Path(os.path.expanduser(cache_folder)).absolute() / "slidercrank"  # noqa: PTH111 - raises for no home
    from platformdirs import user_cache_path

    with contextlib.suppress(
        RuntimeError
    ):  # raised by later releases if the user has no home; earlier ones leave its "~"
        user = user_cache_path("slidercrank", appauthor=False)
        if user.is_absolute():
            yield user
    if hasattr(os, "getuid"):  # elsewhere the folder for temporary files belongs to the user
        yield _temp_folder() / f"slidercrank-{os.getuid()}"


def _temp_folder() -> Path:
    try:
        return Path(tempfile.gettempdir())
    except OSError:
        return Path("/tmp")


def _refusal(folder: Path) -> str | None:
    """Return why kernels cannot be stored in a folder: it is not writable, or other users could put theirs there."""
    place = folder.parent
    try:
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        if place.parent == _temp_folder() and not _is_private(place.lstat(), {os.getuid()}):
            return "is not a folder that only this user can write to"
        folder.mkdir(exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return None
    except OSError as error:
        return f"cannot be written ({error.strerror or error})"


def _is_trusted(folder: Path) -> bool:
    """Whether kernels from a folder may be run, because no other user can have put them there."""
    if folder.parent.parent == _temp_folder() or not hasattr(os, "getuid") or not os.access(folder, os.R_OK | os.X_OK):
        return False
    return all(_is_private(place.stat(), {0, os.getuid()}) for place in (folder, folder.parent))


def _is_private(place: os.stat_result, owners: set[int]) -> bool:
    """Whether a path is a folder that only these owners can write."""
    return stat.S_ISDIR(place.st_mode) and place.st_uid in owners and not place.st_mode & 0o022
