"""Digest of everything that determines the machine code of a kernel.

It covers what the kernel and its compiled formulas do rather than how their sources look: a comment or another formula
does not change the digest.
"""

from __future__ import annotations

import enum
import hashlib
import os
import sys
from collections.abc import Callable, Iterator
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any

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
