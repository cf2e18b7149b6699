"""Computing requests, answered by separate processes, each within limits on memory and processor time.

A thread cannot be killed, and holds the interpreter while it computes. An executor of `concurrent.futures` can neither
end one call nor return an answer in parts, so these are plain processes of `multiprocessing`. They come from a fork
server, which has imported the required modules: a killed process is replaced quickly.
"""

from __future__ import annotations

import asyncio
import multiprocessing
from collections.abc import Callable, Iterable
from http import HTTPStatus
from typing import Any, ClassVar

from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from fastapi.routing import APIRoute
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.types import Message, Receive, Scope, Send

from ...optimise.engine.processes import block_interrupts
from ..resources.memory import size_text
from ..store import Limits
from ..workers.heartbeat import EXHAUSTED
from ..workers.supervisor import reason_of
from .computing_process import OUT_OF_TIME, ApplicationFactory, Question, is_last, serve_requests
from .throttle import TurnQueue

MOST = Limits(seconds=60.0, memory=10**9)
"""What an answer may take: time of the processor, and memory beyond that of a process at rest."""
_FAREWELL = 1.0  # s left for an answer after its client has gone: a process that finishes in time is kept
_SENT = ("type", "asgi", "http_version", "method", "scheme", "path", "raw_path", "query_string", "root_path", "headers")
_REMEDY = "ask for less, or use a command such as slidercrank analyse, which has no limits"


class QuickRoute(APIRoute):
    """An endpoint with a short computation. Its requests never wait for long ones."""

    turns: ClassVar = "quick"

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a process answer a request; without processes, answer it here, one at a time."""
        state = scope["app"].state
        if state.computing is None:
            async with state.turn_here:
                await super().handle(scope, receive, send)
        elif scope["method"] in (self.methods or ()):
            await state.computing.handle(self.turns, scope, receive, send)
        else:
            await super().handle(scope, receive, send)


class LongRoute(QuickRoute):
    """An endpoint that may compute for many seconds."""

    turns: ClassVar = "long"


class Computing:
    """Processes that answer requests, each one at a time, started when needed; used by one event loop."""

    def __init__(self, make: ApplicationFactory, *, limits: Limits = MOST, modules: Iterable[str] = ()) -> None:
        """Start nothing yet. make: function that gives a process its application. modules: fork server imports."""
        methods = multiprocessing.get_all_start_methods()
        self._context: Any = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
        self._context.set_forkserver_preload(list(modules))
        self._make, self._most = make, limits
        self._turns = {"quick": TurnQueue("quick analyses", 2), "long": TurnQueue("long analyses", 2)}
        self._threads = CapacityLimiter(8)  # that wait for processes, apart from those that read
        self._idle: list[_Process] = []
        self._all: set[_Process] = set()
        self._prepared = False

    def prepare(self) -> None:
        """Begin to start a first process, which takes seconds; once."""
        if not self._prepared:
            self._prepared = True
            asyncio.get_running_loop().run_in_executor(None, self._start)

    async def handle(self, turns: str, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request in a free process, and kill the process if the client leaves early."""
        question = {key: scope[key] for key in _SENT if key in scope}, await Request(scope, receive).body()
        messages = asyncio.Queue[Message | None]()  # no process waits for a client that does not read
        answering = asyncio.create_task(self._compute(turns, question, messages.put_nowait))
        leaving = asyncio.create_task(_wait_for_disconnect(receive))
        for task in (answering, leaving):
            task.add_done_callback(lambda _: messages.put_nowait(None))
        try:
            while (message := await messages.get()) is not None:
                await send(message)
            finished, _ = await asyncio.wait((answering,), timeout=_FAREWELL)
        finally:
            leaving.cancel()
            answering.cancel()
        for task in finished:
            task.result()

    def close(self) -> None:
        """Kill all processes, whatever they are doing."""
        for process in list(self._all):
            process.end()

    async def _compute(self, turns: str, question: Question, give: Callable[[Message], None]) -> None:
        async with self._turns[turns].turn():
            while (process := self._free()) is None:
                await run_sync(self._start, limiter=self._threads)
            try:
                last = await process.stream(question, give)
                self._idle.append(process)  # before the client can ask again
                give(last)
            except (EOFError, OSError):
                raise self._refusal(await run_sync(process.exit_code, limiter=self._threads)) from None
            finally:
                if process not in self._idle:
                    process.end()
                    self._all.discard(process)

    def _free(self) -> _Process | None:
        while self._idle:
            process = self._idle.pop()
            if process.is_alive():
                return process
            self._all.discard(process)
        return None

    def _start(self) -> None:
        process = _Process(self._context, self._make, self._most, self._threads)
        self._all.add(process)
        self._idle.append(process)

    def _refusal(self, code: int) -> HTTPException:
        limits = f"{size_text(self._most.memory or 0)} of memory and {self._most.seconds:g} s of processor time"
        lacking = {EXHAUSTED: "memory", OUT_OF_TIME: "processor time"}.get(code)
        if lacking:
            text = f"an answer may use at most {limits}; this one needs more {lacking}; {_REMEDY}"
            return HTTPException(HTTPStatus.UNPROCESSABLE_ENTITY, text)
        text = (
            f"the process that computes an answer, with at most {limits}, must not end early; it did "
            f"({reason_of(code)}); try again"
        )
        return HTTPException(HTTPStatus.SERVICE_UNAVAILABLE, text, {"Retry-After": "5"})


class _Process:
    """An answering process, seen from the server."""

    def __init__(self, context: Any, make: ApplicationFactory, limits: Limits, threads: CapacityLimiter) -> None:
        self._threads = threads
        self._connection, child_end = context.Pipe()
        # A daemon is ended with this process, which would wait for others.
        self._process = context.Process(target=serve_requests, args=(child_end, make, limits), daemon=True)
        with child_end, block_interrupts():
            self._process.start()

    async def stream(self, question: Question, give: Callable[[Message], None]) -> Message:
        """Pass on the messages of an answer but the last, which is returned.

        Raises `EOFError` or `OSError` if the process ends early, and the error that prevents it from answering.
        """
        message = await run_sync(self._send_request, question, abandon_on_cancel=True, limiter=self._threads)
        while True:
            if isinstance(message, Exception):
                raise message
            if is_last(message):
                return message
            give(message)
            message = await run_sync(self._receive, abandon_on_cancel=True, limiter=self._threads)

    def _send_request(self, question: Question) -> Message | Exception:
        self._connection.send(question)
        return self._receive()

    def _receive(self) -> Message | Exception:
        message: Message | Exception = self._connection.recv()
        return message

    def exit_code(self) -> int:
        """Wait for its end and return its exit code."""
        self._process.join()
        return int(self._process.exitcode or 0)

    def is_alive(self) -> bool:
        """Whether it can take a request: idle processes end after a while. The pipe closes before the end shows."""
        return bool(self._process.is_alive()) and not self._connection.poll()

    def end(self) -> None:
        """Kill it, if it has not ended."""
        if self._process.is_alive():
            self._process.kill()


async def _wait_for_disconnect(receive: Receive) -> None:
    """Wait until the client of a request has gone, or has its answer."""
    while (await receive())["type"] != "http.disconnect":
        pass
