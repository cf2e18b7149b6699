"""Compiled kernels on disk, by numba's own cache of functions."""

from __future__ import annotations

import contextlib
import logging
import os
import time
import uuid
from pathlib import Path
from typing import Any

from numba.core import config as _config
from numba.core.caching import FunctionCache

_log = logging.getLogger(__name__)

_PATIENCE = 120.0  # s; a process that takes longer to compile a kernel is stopped, or gone wrong
_TICK = 0.05  # s


class KernelCache(FunctionCache):
    """numba's cache of one function, in the folder of kernels; a disk that is full or damaged stops no computation."""

    def __init__(self, function: Any, folder: Path) -> None:
        """Keep the kernels of a function in a folder that can be written."""
        config: Any = _config
        before, config.CACHE_DIR = config.CACHE_DIR, str(folder)
        try:
            super().__init__(function)  # type: ignore[no-untyped-call]
        finally:
            config.CACHE_DIR = before
        self._told = folder / "told"
        self._path = Path(self._cache_file._cache_path) / f"{self._impl.filename_base}.lock"
        self._lock: int | None = None
        # Two processes that keep a kernel at the same time would give two signatures the same file.
        self._cache_file._data_name_pattern = f"{self._impl.filename_base}.{{number:d}}.{uuid.uuid4().hex[:12]}.nbc"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the kernel of a signature, None where there is none that can be read.

        One that another process compiles just now is waited for: to compile it too would take both of them longer.
        """
        found = self._load(sig, target_context)
        if found is None:
            self._begin()
            found = self._load(sig, target_context)
            if found is not None:
                self._end()
            else:
                self._tell()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the kernel of a signature, if there is room."""
        try:
            with contextlib.suppress(OSError):
                super().save_overload(sig, data)  # type: ignore[no-untyped-call]
        finally:
            self._end()

    def _load(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)  # type: ignore[no-untyped-call]
        except Exception:  # noqa: BLE001 - a damaged file may raise anything; the kernel is compiled and kept anew
            with contextlib.suppress(OSError):
                self.flush()  # type: ignore[no-untyped-call]
            return None

    def _tell(self) -> None:
        """Say that the model is compiled: once for a folder of kernels, before the first of them."""
        with contextlib.suppress(OSError):  # told before
            os.close(os.open(self._told, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
            _log.warning("slidercrank compiles its formulas, once after installation: up to a minute")

    def _begin(self) -> None:
        """Take the lock of this function's kernels."""
        self._end()
        with contextlib.suppress(ImportError, OSError):  # elsewhere, or without room, every process compiles
            import fcntl

            self._lock = os.open(self._path, os.O_CREAT | os.O_RDWR, 0o600)
            end = time.monotonic() + _PATIENCE
            while time.monotonic() < end:
                try:
                    fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    return
                except BlockingIOError:
                    time.sleep(_TICK)

    def _end(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None
