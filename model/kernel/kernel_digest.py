"""Digest of everything that determines the machine code of a kernel, and the folder where compiled kernels are stored.

It covers what the kernel and its compiled formulas do rather than how their sources look: a comment or another formula
does not change the digest.

Kernels are never stored next to the sources: there they would outlive the software, and its empty folders would stay
importable.
"""

from __future__ import annotations

import contextlib
import enum
import hashlib
import logging
import os
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple

import numpy as np

_PLAIN = (int, float, complex, str, bytes, bool, type(None), type(Ellipsis))


def kernel_digest(function: Callable[..., Any], examples: tuple[Any, ...]) -> str:
    """Return the digest of a kernel for arguments with the types of the examples."""
    hashed = hashlib.sha256(_environment_digest())
    hashed.update(_fingerprint(examples).encode())
    for _, text in _walk_callees(function):
        hashed.update(text)
    return hashed.hexdigest()[:24]


def code_lengths(function: Callable[..., Any]) -> dict[int, int]:
    """Return the code length of a kernel and of each of its formulas, by identity."""
    return {id(formula): len(formula.__code__.co_code) for formula, _ in _walk_callees(function)}


def _walk_callees(function: Callable[..., Any]) -> Iterator[tuple[Any, bytes]]:
    """Yield a function and every function that it calls, each with its own digest data."""
    visited: set[int] = set()
    waiting: list[Any] = [function]
    while waiting:
        value = waiting.pop()
        if id(value) not in visited:
            visited.add(id(value))
            text, calls = _code_and_callees(value)
            yield value, text
            waiting.extend(calls)


@cache
def _environment_digest() -> bytes:
    """Return the data on which every kernel depends: processor, versions, numba settings, and this compiler."""
    import llvmlite.binding as llvm

    settings = sorted(item for item in os.environ.items() if item[0].startswith("NUMBA_") and item[0] not in _ASIDE)
    host = llvm.get_process_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    compiler_source = Path(__file__).with_name("compiler.py").read_bytes()
    return repr(
        (host, sys.version_info[:2], np.__version__, version("numba"), version("llvmlite"), settings, compiler_source)
    ).encode()


_ASIDE = (
    "NUMBA_CACHE_DIR",
    "NUMBA_DISABLE_JIT",
    "NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING",
    "NUMBA_NUM_THREADS",  # joblib sets this in its processes; a kernel runs in one thread
    "NUMBA_THREADING_LAYER",
)


def _code_and_callees(function: Any) -> tuple[bytes, list[Any]]:
    """Return a function's own code and constants, and the functions that it calls."""
    calls: list[Any] = []
    text = [function.__qualname__, _fingerprint(function.__defaults__)]
    codes = list(_nested_codes(function.__code__))
    for code in codes:
        text += [code.co_code.hex(), repr((code.co_varnames, code.co_names, code.co_freevars))]
        text += [_fingerprint(constant) for constant in code.co_consts if not isinstance(constant, CodeType)]
    cells = [cell.cell_contents for cell in function.__closure__ or ()]
    names = dict.fromkeys(name for code in codes for name in code.co_names)
    for value in (*cells, *(function.__globals__[name] for name in names if name in function.__globals__)):
        if isinstance(value, FunctionType):
            calls.append(value)
            text.append(value.__qualname__)
        else:
            text.append(_fingerprint(value))
    return "\n".join(text).encode(), calls


def _nested_codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _nested_codes(constant)


def _fingerprint(value: Any) -> str:
    """Return a text that identifies a value in a formula, or the type of an example."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype.str}{value.shape}{value.tobytes().hex()}"
    if isinstance(value, tuple):
        return f"{type(value).__qualname__}({','.join(map(_fingerprint, value))})"
    if isinstance(value, enum.EnumType):
        return f"{value.__qualname__}{list(value.__members__.items())}"
    if isinstance(value, ModuleType):
        return value.__name__
    if isinstance(value, type):
        return f"{value.__qualname__}{getattr(value, '_fields', '')}"
    if isinstance(value, (*_PLAIN, BuiltinFunctionType, np.generic, np.ufunc, enum.Enum)):
        return repr(value)
    raise TypeError(f"a formula may only use numbers, tuples, classes, modules and formulas; got {value!r}; replace it")


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
        reason = _refusal_reason(folder)
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


def _refusal_reason(folder: Path) -> str | None:
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
