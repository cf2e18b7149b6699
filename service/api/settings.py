"""API settings chosen by the operator, the parameters of requests, and how requests reach settings and store."""

import re
from dataclasses import dataclass
from typing import Annotated, Any

from fastapi import Depends, Path, Query, Request
from pydantic import BeforeValidator
from pydantic_core import PydanticKnownError

from ...objectives.kinds import System
from ..store import NO_LIMITS, Limits, Store

LOOPBACK = ("127.0.0.1", "localhost", "[::1]")
"""Names of this machine for itself."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of an API.

    token: token required in every request; None admits anyone who can reach the service. hosts: host names of the
    service, without ports; "*" is any. most_body: maximum size of a request, bytes. most_depth: maximum nesting of
    tables in a JSON body. submissions_per_minute: maximum for all clients together; 0 means no limit.
    allowed_quantities: functions that jobs may name as custom quantities, as "module:function"; they run on the workers
    with all their permissions. limits: maximum limits of a job, also the default. figures: whether figures are drawn.
    """

    token: str | None = None
    hosts: tuple[str, ...] = LOOPBACK
    most_body: int = 1_048_576
    most_depth: int = 32
    submissions_per_minute: int = 600
    allowed_quantities: frozenset[str] = frozenset()
    limits: Limits = NO_LIMITS
    figures: bool = True


DEFAULT = Settings()


def state_dependency(name: str) -> Any:
    """Return the dependency that provides a part of the application's state."""

    async def part(request: Request) -> Any:  # async, so not run in a separate thread as plain functions are
        return getattr(request.app.state, name)

    return Depends(part)


StoreDep = Annotated[Store, state_dependency("store")]
"""Store; its calls block, so endpoints that use it are plain functions, which run in threads."""

SettingsDep = Annotated[Settings, state_dependency("settings")]
"""API settings chosen by the operator."""

LARGEST = 2**53 - 1
_INTEGER = re.compile(r"-?(0|[1-9][0-9]*)")


def _require_plain_integer(text: Any) -> Any:
    if isinstance(text, str) and not _INTEGER.fullmatch(text):
        raise PydanticKnownError("int_parsing")
    return text


PLAIN_DIGITS = BeforeValidator(_require_plain_integer)
"""Validator for a whole number in an address: digits only, not "6.0", "1_0" or " 6", which Python accepts.

It must follow the numeric limits; otherwise the schema lists them under names unknown to JSON Schema.
"""
JobNumber = Annotated[int, Path(ge=1, le=LARGEST, description="the number of a job", examples=[1]), PLAIN_DIGITS]
"""A path parameter."""
UnitsParameter = Annotated[
    System,
    Query(description="system of units of the answer; in the inch system, keys such as crank_mm become crank_in"),
]
"""A query parameter."""
