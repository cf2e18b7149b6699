"""Rejection of oversized bodies, and of JSON that no job contains, before anything else reads them."""

import asyncio
import contextlib
import json
import math
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any, TypeVar

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.requests import ClientDisconnect, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ...model.errors import InputError
from .problem_documents import problem_response
from .security import KNOWN

T = TypeVar("T")
_JSON = re.compile(r"application/(json|[\w.+-]+\+json)\s*(;.*)?", re.IGNORECASE)
_LARGEST = 2**53
"""Larger whole numbers change in languages that store numbers as floats (RFC 8259, section 6)."""
_DIGITS = 4 * len(str(_LARGEST))
_LARGE = 16_384  # bytes; longer bodies are parsed in a thread, one at a time, so that other requests continue meanwhile
PARSED_BODY = "slidercrank.json"
"""Key in a request's scope for the content of a JSON body."""


@dataclass
class StrictInput:
    """ASGI middleware: reads a body up to a size, rejects anything but strict JSON, and passes it on unchanged.

    most_body: maximum size, bytes. most_depth: maximum nesting of tables or lists.
    """

    app: ASGIApp
    most_body: int
    most_depth: int

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request, or pass it on."""
        if KNOWN not in scope:  # only bodies of requests with the token are read
            await self.app(scope, receive, send)
            return
        if "\0" in scope["path"] or b"%00" in scope["query_string"] or b"\0" in scope["query_string"]:
            refused = problem_response(HTTPStatus.BAD_REQUEST, "an address must not contain NUL; got one; leave it out")
            await refused(scope, receive, send)
            return
        body = await self._read_body(Request(scope, receive))
        if body is None:
            rule = f"a request may have at most {self.most_body} bytes; got more; is it the right file?"
            refused = problem_response(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, rule, {"Connection": "close"})
            await refused(scope, receive, send)
            return
        if body and _JSON.fullmatch(Headers(scope=scope).get("content-type", "")):
            try:
                scope[PARSED_BODY] = await read_body_in_turn(scope["app"], body, read_json, body, self.most_depth)
            except InputError as error:
                await problem_response(HTTPStatus.BAD_REQUEST, str(error))(scope, receive, send)
                return
        replayed = iter([{"type": "http.request", "body": body, "more_body": False}])

        async def receive_again() -> Message:
            return next(replayed, None) or await receive()

        await self.app(scope, receive_again, send)

    async def _read_body(self, request: Request) -> bytes | None:
        """Return the whole body; None if it is too large.

        Bytes are counted on arrival: the stated length may be wrong.
        """
        body = bytearray()
        with contextlib.suppress(ClientDisconnect):  # the application will notice
            async for part in request.stream():
                body += part
                if len(body) > self.most_body:
                    return None
        return bytes(body)


async def read_body_in_turn(app: Any, body: bytes, read: Callable[..., T], *of: Any) -> T:
    """Return the content of a body; large bodies take turns, as parsing one blocks the interpreter for long."""
    if len(body) <= _LARGE:
        return read(*of)
    turn: asyncio.Lock = app.state.reading
    async with turn:
        return await run_in_threadpool(read, *of)


def read_json(body: bytes, most_depth: int) -> Any:
    """Return the value of a JSON text.

    Raises `InputError` for values that `require_shallow_and_portable` rejects, and for duplicate keys.
    """
    try:
        value = json.loads(
            body, parse_constant=_reject_non_finite, parse_int=_parse_integer, object_pairs_hook=_table_with_unique_keys
        )
    except RecursionError:
        raise InputError(f"a body must be nested at most {most_depth} deep; got more; flatten it") from None
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"the body is not valid JSON: {error}; correct it") from None
    require_shallow_and_portable(value, most_depth)
    return value


def require_shallow_and_portable(value: Any, most_depth: int) -> None:
    """Reject data with too many levels, and numbers and texts that other programs would not read unchanged.

    Raises `InputError` for infinities, NaN, integers beyond 2^53, dates, and text with NUL or lone surrogates.
    """
    level, depth = [value], 0
    while level:
        depth += 1
        next_level = list[Any]()
        for item in level:
            if not isinstance(item, dict | list):
                _require_portable_item(item)
            elif depth > most_depth:
                raise InputError(f"a body must be nested at most {most_depth} deep; got more; flatten it")
            else:
                next_level += [*item, *item.values()] if isinstance(item, dict) else item
        level = next_level


def _require_portable_item(item: object) -> None:
    if isinstance(item, str):
        if "\0" in item or (not item.isascii() and any("\ud800" <= letter <= "\udfff" for letter in item)):
            raise InputError("text must have complete characters and no NUL; got an invalid character; leave it out")
    elif isinstance(item, float):
        if not math.isfinite(item):
            raise InputError(f"a number must be finite; got {item}; leave it out if there is no bound")
    elif isinstance(item, int):
        if abs(item) > _LARGEST:
            raise _body_too_large_error()
    elif item is not None:
        raise InputError(f"a body may only contain numbers and text; got the date {item}; write it in quotes")


def _body_too_large_error() -> InputError:
    return InputError("a whole number must be at most 2^53; got a larger one; give a smaller one")


def _reject_non_finite(text: str) -> None:
    raise InputError(f"a number must be finite; got {text}; leave it out if there is no bound")


def _parse_integer(text: str) -> int:
    if len(text) > _DIGITS:  # parsing time grows with the square of the length
        raise _body_too_large_error()
    return int(text)


def _table_with_unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        twice = Counter(name for name, _ in pairs).most_common(1)[0][0]
        raise InputError(f"a key may be given only once; got {twice[:100]!r} twice; remove one")
    return table
