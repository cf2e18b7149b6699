"""Process that answers computing requests one after another; the counterpart of `computing`."""

import asyncio
import os
import signal
from collections import deque
from collections.abc import Callable
from contextlib import AbstractContextManager
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from starlette.types import ASGIApp, Message

from ...model.errors import SlidercrankError
from ...optimise.engine.processes import end_with_parent
from ..store import Limits

ApplicationFactory = Callable[[], AbstractContextManager[ASGIApp]]
Question = tuple[dict[str, Any], bytes]
"""Scope and body of a request."""
NICENESS = 5
"""Niceness while answering: lower priority than requests that only read, higher than the workers."""
OUT_OF_TIME = -27 if os.name == "nt" else -signal.SIGPROF
"""Exit code of a process that exceeded the processor time for an answer."""
_IDLE = 600.0  # s without a request until the process ends and frees its memory


def serve_requests(connection: Connection, make: ApplicationFactory, limits: Limits) -> None:
    """Answer requests one after another until no more arrive.

    Sends the messages of each answer, the last one only when the work is done, or an error if no application can be
    created.
    """
    end_with_parent()
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    try:
        with make() as app, asyncio.Runner() as runner:
            while connection.poll(_IDLE):
                scope, body = connection.recv()
                _limit_memory(limits.memory)
                _limit_time(limits.seconds)
                last = runner.run(_run_request(app, scope, body, connection.send))
                _limit_time(None)
                connection.send(last)
    except SlidercrankError as error:
        connection.send(error)
    except (EOFError, OSError):
        pass  # the server has ended, or no longer needs an answer


def is_last(message: Message) -> bool:
    """Whether a message ends an answer."""
    return message["type"] == "http.response.body" and not message.get("more_body", False)


async def _run_request(app: ASGIApp, scope: dict[str, Any], body: bytes, give: Callable[[Message], None]) -> Message:
    """Pass on the messages of an answer except the last, which is returned."""
    parts = deque[Message]([{"type": "http.request", "body": body}])
    last = deque[Message](maxlen=1)

    async def receive() -> Message:
        if not parts:
            await asyncio.Event().wait()  # wait for the client to leave: the server then kills this process
        return parts.popleft()

    async def send(message: Message) -> None:
        (last.append if is_last(message) else give)(message)

    await app(scope, receive, send)
    return last.pop()


def _limit_memory(limit: int | None) -> None:
    """Limit additional memory of this process to a number of bytes, if the system supports it."""
    statistics = Path("/proc/self/statm")
    if limit is not None and statistics.exists():
        import resource

        # Total memory is not limited: libraries reserve memory for each processor, and wait forever if they get none.
        has = int(statistics.read_text().split()[5]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_DATA, (has + limit, resource.getrlimit(resource.RLIMIT_DATA)[1]))


def _limit_time(seconds: float | None) -> None:
    """Kill this process after an additional amount of processor time; None: never.

    Unlike a resource limit, a timer is not inherited by processes that compile kernels or run custom functions.
    """
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, seconds or 0.0)
