"""The folder of compiled kernels.

None is kept beside the sources: there they would outlive the software, and keep its empty folders importable.
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

_REMEDY = "name a folder that can be written in NUMBA_CACHE_DIR"


class Chosen(NamedTuple):
    """Choice of a folder for kernels: the folder if any, whether it is new, and why places were refused."""

    folder: Path | None
    new: bool
    refused: str


@cache
def kernel_folder() -> Path | None:
    """Return the folder of kernels of this process, None where no place can be written.

    What was refused is logged when the folder is made, or else in every process.
    """
    folder, new, refused = choose_folder()
    if folder is None:
        _log.warning(f"slidercrank compiles for a minute at every start: {refused}; {_REMEDY}")
    elif new and refused:
        _log.warning(
            f"slidercrank keeps compiled kernels in {folder.parent}: {refused}; to keep them longer, {_REMEDY}"
        )
    return folder


def choose_folder() -> Chosen:
    """Return the folder in the first place that can be written, made if need be.

    Places are NUMBA_CACHE_DIR, the user's folder of caches, and one of this user alone among temporary files.
    """
    refused: list[str] = []
    for place in _places():
        folder = place / "kernels"
        new = not folder.is_dir()
        reason = _refusal(folder)
        if reason is None:
            return Chosen(folder, new, "; ".join(refused))
        refused.append(f"{place} {reason}")
    return Chosen(None, False, "; ".join(refused))


def _places() -> Iterator[Path]:
    """Yield the places where the folder may be."""
    given = os.environ.get("NUMBA_CACHE_DIR")
    if given:
        yield Path(given).absolute() / "slidercrank"
    from platformdirs import user_cache_path

    with contextlib.suppress(RuntimeError):  # of later releases, for a user without a home; earlier ones keep its "~"
        user = user_cache_path("slidercrank", appauthor=False)
        if user.is_absolute():
            yield user
    if hasattr(os, "getuid"):  # elsewhere the folder for temporary files is the user's own
        yield _temporary() / f"slidercrank-{os.getuid()}"


def _temporary() -> Path:
    try:
        return Path(tempfile.gettempdir())
    except OSError:
        return Path("/tmp")


def _refusal(folder: Path) -> str | None:
    """Return why kernels cannot be kept in a folder: it cannot be written, or strangers could put theirs there."""
    place = folder.parent
    try:
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        if place.parent == _temporary() and not _private(place):
            return "is not a folder that this user alone can write"
        folder.mkdir(exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return None
    except OSError as error:
        return f"cannot be written ({error.strerror or error})"


def _private(place: Path) -> bool:
    found = place.lstat()
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.getuid() and not found.st_mode & 0o022
