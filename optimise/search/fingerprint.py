"""Fingerprint of a search: a digest of its problem, the same in every process, and the software versions."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from platform import python_version
from typing import Any

import numpy as np

from ..problem.problem import Problem
from .checkpoints import Identity

_COMPUTE = ("slidercrank", "numpy", "scipy", "numba", "moocore", "optuna", "cmaes")
_LEFT_OUT = ("folders",)  # folders of a custom function, because a job may be moved


@cache
def version_of(name: str) -> str:
    """Return the version of an installed package; "unknown" if it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "unknown"


def software_versions() -> dict[str, str]:
    """Return the versions of this software and of its numerical libraries."""
    return {"python": python_version(), **{name: version_of(name) for name in (*_COMPUTE, "pandas")}}


def identity_of(problem: Problem) -> Identity:
    """Return the identity of a search of this problem.

    Its name may change and its budget may rise before it resumes.
    """
    settings = replace(problem.settings, evaluations=None)
    digest = hashlib.blake2b(digest_size=16)
    for part in _identifying_parts(replace(problem, settings=settings, name="")):
        digest.update(part)
    return Identity(digest.hexdigest(), json.dumps({name: version_of(name) for name in _COMPUTE}))


def _identifying_parts(value: Any) -> Iterator[bytes]:
    """Yield a value's type and content; for a composite value, the number of parts, then the parts."""
    yield f"{type(value).__qualname__}:".encode()
    if is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            if item.compare and item.name not in _LEFT_OUT:
                yield item.name.encode()
                yield from _identifying_parts(getattr(value, item.name))
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype}{value.shape}".encode() + value.tobytes()
    elif isinstance(value, Mapping):
        yield from _identifying_parts(tuple(value.items()))
    elif isinstance(value, (tuple, list)):
        yield f"{len(value)};".encode()
        for item in value:
            yield from _identifying_parts(item)
    elif isinstance(value, float):
        yield value.hex().encode() + b";"
    elif value is None or isinstance(value, (str, int, bool, np.generic)):
        yield f"{value!r};".encode()
    elif callable(value) and hasattr(value, "__qualname__"):
        yield f"{value.__module__}.{value.__qualname__};".encode()
    else:
        yield from _identifying_parts(vars(value) if hasattr(value, "__dict__") else None)
