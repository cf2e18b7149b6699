"""A small disk of its own (a tmpfs, which takes root), to be filled to the last byte and emptied."""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_BLOCK = b"x" * 4096


class Disk:
    """A disk. folder: where it is."""

    def __init__(self, folder: Path) -> None:
        """Take one that is mounted."""
        self.folder = folder
        self._filler = folder / "filler"

    def fill(self, left: int = 0) -> None:
        """Let nothing be free but some bytes."""
        with self._filler.open("ab", buffering=0) as file:
            try:
                while file.write(_BLOCK):
                    pass
            except OSError:  # that was the last byte
                file.truncate(max(0, file.tell() - left))

    def empty(self) -> None:
        """Give the room back."""
        self._filler.unlink(missing_ok=True)


@contextmanager
def small_disk(size: str = "6m") -> Iterator[Disk]:
    """Give a disk while it is needed. Raises `SystemExit` where none can be mounted."""
    with tempfile.TemporaryDirectory(prefix="faults-disk-") as name:
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", name], check=False)
        if mounted.returncode:
            raise SystemExit("a full disk is tried on a tmpfs, which only root may mount")
        try:
            yield Disk(Path(name))
        finally:
            subprocess.run(["umount", "-l", name], check=True)
