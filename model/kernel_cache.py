"""Compiled kernels on disk, by numba's own cache of functions."""

from __future__ import annotations

import contextlib
import uuid
from pathlib import Path
from typing import Any

from numba.core import config as _config
from numba.core.caching import FunctionCache


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
        # Two processes that keep a kernel at the same time would give two signatures the same file.
        self._cache_file._data_name_pattern = f"{self._impl.filename_base}.{{number:d}}.{uuid.uuid4().hex[:12]}.nbc"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the kernel of a signature, None where there is none that can be read."""
        try:
            return super().load_overload(sig, target_context)  # type: ignore[no-untyped-call]
        except Exception:  # noqa: BLE001 - a damaged file may raise anything; the kernel is compiled and kept anew
            with contextlib.suppress(OSError):
                self.flush()  # type: ignore[no-untyped-call]
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the kernel of a signature, if there is room."""
        with contextlib.suppress(OSError):
            super().save_overload(sig, data)  # type: ignore[no-untyped-call]
