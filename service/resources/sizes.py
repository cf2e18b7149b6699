"""Amounts of memory and disk as people write them: "500 MB", "2 GB"."""

from __future__ import annotations

import re

from ...model.errors import InputError

_UNITS = {"": 1, "B": 1, "KB": 10**3, "MB": 10**6, "GB": 10**9, "TB": 10**12}
_UNITS |= {"KIB": 2**10, "MIB": 2**20, "GIB": 2**30, "TIB": 2**40}
_FORM = re.compile(r"\s*(\d+(?:\.\d+)?)\s*([A-Za-z]*)\s*", re.ASCII)


def size_of(text: str, option: str) -> int:
    """Return an amount in bytes. Raises `InputError` that names the option for anything else."""
    match = _FORM.fullmatch(text)
    factor = _UNITS.get(match[2].upper()) if match else None
    size = int(float(match[1]) * factor) if match and factor else 0
    if not 0 < size < 2**63:
        raise InputError(
            f'{option} must be an amount of memory with its unit; got {text[:40]!r}; write it like "500 MB" or "2 GB"'
        )
    return size


def size_text(size: float) -> str:
    """Return an amount with three significant digits and its unit."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 999.5:
            return f"{size:.3g} {unit}"
        size /= 1000.0
    return f"{size:.3g} TB"
