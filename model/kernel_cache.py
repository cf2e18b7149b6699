"""Compiled kernels on disk, by numba's own cache of functions."""

from __future__ import annotations

import contextlib
import uuid
from pathlib import Path
from typing import Any

from numba.core import config
from numba.core.caching import FunctionCache


class KernelCache(FunctionCache):
    """numba's cache of one function, in the folder of kernels; a disk that is full or damaged stops no computation."""

    def __init__(self, function: Any, folder: Path) -> None:
        """Keep the kernels of a function in a folder that can be written."""
        before, config.CACHE_DIR = config.CACHE_DIR, str(folder)
        try:
            super().__init__(function)
        finally:
            config.CACHE_DIR = before
        # Two processes that keep a kernel at the same time would give two signatures the same file.
        self._cache_file._data_name_pattern = f"{self._impl.filename_base}.{{number:d}}.{uuid.uuid4().hex[:12]}.nbc"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the kernel of a signature, None where there is none that can be read."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # noqa: BLE001 - a damaged file may raise anything; compiling anew replaces it
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the kernel of a signature, if there is room."""
        with contextlib.suppress(OSError):
            super().save_overload(sig, data)
