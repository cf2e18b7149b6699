"""Disk space: detection of a full disk in an error, and the free space at a location."""

import contextlib
import errno
import os
import shutil
import tempfile
from pathlib import Path

from .memory import size_text

LEAST = 256_000
"""Bytes below which a disk counts as full: less than a database needs to record the progress of a search."""
_FULL = (errno.ENOSPC, errno.EDQUOT)


def is_disk_full(error: BaseException) -> bool:
    """Whether an error reports a full disk or an exhausted user quota."""
    return isinstance(error, OSError) and error.errno in _FULL


def free_bytes(place: Path) -> int:
    """Return the free space, bytes, at the location of a file or folder, existing or not; very large if unknown."""
    existing = place.absolute()
    while not existing.exists() and existing != existing.parent:
        existing = existing.parent
    try:
        return shutil.disk_usage(existing).free
    except OSError:
        return 1 << 62


def free_space_text(place: Path) -> str:
    """Return the free space at a location in words."""
    return f"{place} has {size_text(free_bytes(place))} free"


def full_places_text(error: OSError) -> str:
    """Return the locations affected by a full-disk error: the one that it names, or else those without free space."""
    if isinstance(error.filename, str | os.PathLike):
        return free_space_text(Path(error.filename))
    places = [place for place in _cache_and_temporary_folders() if free_bytes(place) < LEAST]
    return ", ".join(map(free_space_text, places)) or "a disk is full"


def _cache_and_temporary_folders() -> list[Path]:
    """Return further locations that this software writes to: compiled kernels and temporary files."""
    from ... import model

    cache = os.environ.get("NUMBA_CACHE_DIR") or Path(model.__path__[0]) / "__pycache__"
    folders = [Path(cache), Path(os.environ.get("TMPDIR") or "/tmp")]
    with contextlib.suppress(OSError):  # none of its folders is writable
        folders.append(Path(tempfile.gettempdir()))
    return [*dict.fromkeys(folders), Path.cwd()]
