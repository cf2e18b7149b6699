"""Separate processes that answer computing requests, each with limits on memory and processor time.

A thread cannot be killed, and blocks the interpreter while it computes. They are plain `multiprocessing` processes,
because an executor of `concurrent.futures` can neither cancel a running call nor return an answer in parts. A fork
server that has imported the required modules creates them, so a killed process is replaced quickly.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import multiprocessing
import time
from collections.abc import AsyncIterator, Callable, Iterable
from http import HTTPStatus
from typing import Any, ClassVar

from anyio import CapacityLimiter, fail_after
from anyio.to_thread import run_sync
from fastapi.routing import APIRoute
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.types import Message, Receive, Scope, Send

from ...optimise.engine.processes import block_interrupts
from ..resources.memory import size_text
from ..store import Limits
from ..workers.heartbeat import EXHAUSTED
from ..workers.supervisor import exit_reason
from .computing_process import OUT_OF_TIME, ApplicationFactory, Question, is_last, serve_requests

MOST = Limits(seconds=60.0, memory=10**9)
"""Limits for one answer: processor time, and memory beyond that of an idle process."""
_FAREWELL = 1.0  # s that an answer may still take after its client has left: a process that finishes in time is reused
_SENT = ("type", "asgi", "http_version", "method", "scheme", "path", "raw_path", "query_string", "root_path", "headers")
_REMEDY = "ask for less, or use a command such as slidercrank analyse, which has no limits"


class QuickRoute(APIRoute):
    """An endpoint with a short computation. Its requests never wait behind long ones."""

    turns: ClassVar = "quick"

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a process answer a request; without processes, answer requests here, one at a time."""
        state = scope["app"].state
        if state.computing is None:
            async with state.turn_here:
                await super().handle(scope, receive, send)
        elif scope["method"] in (self.methods or ()):
            await state.computing.handle_in_idle_process(self.turns, scope, receive, send)
        else:
            await super().handle(scope, receive, send)


class LongRoute(QuickRoute):
    """An endpoint whose computation may take many seconds."""

    turns: ClassVar = "long"


class Computing:
    """Processes for one event loop that start when needed and each answer one request at a time."""

    def __init__(self, make: ApplicationFactory, *, limits: Limits = MOST, modules: Iterable[str] = ()) -> None:
        """Start nothing yet.

        make: function that creates the application in a process. modules: modules that the fork server imports.
        """
        methods = multiprocessing.get_all_start_methods()
        self._context: Any = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
        self._context.set_forkserver_preload(list(modules))
        self._make, self._most = make, limits
        self._turns = {"quick": CapacityLimiter(2), "long": CapacityLimiter(2)}
        self._threads = CapacityLimiter(8)  # threads that wait for processes, separate from those that read
        self._idle: list[_Process] = []
        self._all: set[_Process] = set()
        self._prepared = False

    def start_first_process(self) -> None:
        """Start a first process in the background, which takes seconds; later calls have no effect."""
        if not self._prepared:
            self._prepared = True
            asyncio.get_running_loop().run_in_executor(None, self._start_process)

    async def handle_in_idle_process(self, queue_name: str, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request in an idle process, and kill the process if the client leaves early."""
        question = {key: scope[key] for key in _SENT if key in scope}, await Request(scope, receive).body()
        messages = asyncio.Queue[Message | None]()  # a client that does not read must not occupy a process
        answering = asyncio.create_task(self._compute_in_turn(queue_name, question, messages.put_nowait))
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
        """Kill all processes, even busy ones."""
        for process in list(self._all):
            process.kill()

    async def _compute_in_turn(self, queue_name: str, question: Question, give: Callable[[Message], None]) -> None:
        async with wait_for_turn(self._turns[queue_name], f"{queue_name} analyses"):
            while (process := self._take_idle_process()) is None:
                await run_sync(self._start_process, limiter=self._threads)
            try:
                last = await process.stream_response(question, give)
                self._idle.append(process)  # before the client can send its next request
                give(last)
            except (EOFError, OSError):
                raise self._refusal_for_exit_code(await run_sync(process.exit_code, limiter=self._threads)) from None
            finally:
                if process not in self._idle:
                    process.kill()
                    self._all.discard(process)

    def _take_idle_process(self) -> _Process | None:
        while self._idle:
            process = self._idle.pop()
            if process.is_alive():
                return process
            self._all.discard(process)
        return None

    def _start_process(self) -> None:
        process = _Process(self._context, self._make, self._most, self._threads)
        self._all.add(process)
        self._idle.append(process)

    def _refusal_for_exit_code(self, code: int) -> HTTPException:
        limits = f"{size_text(self._most.memory or 0)} of memory and {self._most.seconds:g} s of processor time"
        lacking = {EXHAUSTED: "memory", OUT_OF_TIME: "processor time"}.get(code)
        if lacking:
            text = f"an answer may use at most {limits}; this one needs more {lacking}; {_REMEDY}"
            return HTTPException(HTTPStatus.UNPROCESSABLE_ENTITY, text)
        text = (
            f"the process that computes an answer, with at most {limits}, must not end early; it ended "
            f"({exit_reason(code)}); try again"
        )
        return HTTPException(HTTPStatus.SERVICE_UNAVAILABLE, text, {"Retry-After": "5"})


class _Process:
    """Server-side handle of an answering process."""

    def __init__(self, context: Any, make: ApplicationFactory, limits: Limits, threads: CapacityLimiter) -> None:
        self._threads = threads
        self._connection, child_end = context.Pipe()
        # A daemon process is ended together with this process, which would otherwise wait for it.
        self._process = context.Process(target=serve_requests, args=(child_end, make, limits), daemon=True)
        with child_end, block_interrupts():
            self._process.start()

    async def stream_response(self, question: Question, give: Callable[[Message], None]) -> Message:
        """Pass on all messages of an answer except the last, and return that one.

        Raises `EOFError` or `OSError` if the process ends early, and forwards the error that prevents an answer.
        """
        message = await run_sync(self._send_and_receive, question, abandon_on_cancel=True, limiter=self._threads)
        while True:
            if isinstance(message, Exception):
                raise message
            if is_last(message):
                return message
            give(message)
            message = await run_sync(self._receive, abandon_on_cancel=True, limiter=self._threads)

    def _send_and_receive(self, question: Question) -> Message | Exception:
        self._connection.send(question)
        return self._receive()

    def _receive(self) -> Message | Exception:
        message: Message | Exception = self._connection.recv()
        return message

    def exit_code(self) -> int:
        """Wait for the process to end and return its exit code."""
        self._process.join()
        return int(self._process.exitcode or 0)

    def is_alive(self) -> bool:
        """Whether the process can take a request: idle processes end after a while.

        The pipe closes before the end of the process becomes visible.
        """
        return bool(self._process.is_alive()) and not self._connection.poll()

    def kill(self) -> None:
        """Kill the process if it is still running."""
        if self._process.is_alive():
            self._process.kill()


async def _wait_for_disconnect(receive: Receive) -> None:
    """Wait until the client of a request has left or has its answer."""
    while (await receive())["type"] != "http.disconnect":
        pass


_PATIENCE = 30.0  # s
_MOST = 200  # requests that wait


@contextlib.asynccontextmanager
async def wait_for_turn(limiter: CapacityLimiter, name: str) -> AsyncIterator[None]:
    """Wait for a turn; refuse with status 503 and a reason if too many wait or no turn comes soon.

    name: name of the requests that share the limiter, in the plural.
    """
    too_many = limiter.statistics().tasks_waiting >= _MOST
    try:
        with fail_after(0.0 if too_many else _PATIENCE):
            await limiter.acquire()
    except TimeoutError:
        why = f"{_MOST} others wait" if too_many else f"all were busy for {_PATIENCE:g} s"
        detail = f"at most {limiter.total_tokens} {name} can be made at a time; {why}; try again"
        raise HTTPException(HTTPStatus.SERVICE_UNAVAILABLE, detail, {"Retry-After": "5"}) from None
    try:
        yield
    finally:
        limiter.release()


class RateLimit:
    """Rate limiter: admits a burst of a given number, and as many again over every minute. For one thread."""

    def __init__(self, per_minute: int, clock: Callable[[], float] = time.monotonic) -> None:
        """Create a limiter. per_minute: number per minute; 0 means no limit. clock: clock in s."""
        self.per_minute = per_minute
        self._clock = clock
        self._left = float(per_minute)
        self._at = clock()

    def seconds_until_admitted(self) -> float:
        """Return 0 for an admitted request, or else the time until one can be admitted, s."""
        if not self.per_minute:
            return 0.0
        now, rate = self._clock(), self.per_minute / 60.0
        self._left = min(self._left + (now - self._at) * rate, float(self.per_minute))
        self._at = now
        if self._left < 1.0:
            return (1.0 - self._left) / rate
        self._left -= 1.0
        return 0.0


def limit_submissions(app: Any) -> None:
    """Refuse a submission above the rate limit per minute."""
    limit: RateLimit = app.state.submissions
    wait = limit.seconds_until_admitted()
    if wait:
        seconds = math.ceil(wait)
        raise HTTPException(
            HTTPStatus.TOO_MANY_REQUESTS,
            f"at most {limit.per_minute} jobs may be submitted in a minute; got more; try again in {seconds} s",
            {"Retry-After": str(seconds)},
        )
