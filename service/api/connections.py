"""Limits on connections to the web server: number of connections, and size, duration and form of a request.

Requests rejected here never reach the application: anyone can open a connection without a token. Without these limits
one client could take all connections, or keep the server busy with an endless request.
"""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from http import HTTPStatus
from typing import Any, Literal

from uvicorn.config import Config
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol
from uvicorn.server import ServerState

from .problem_documents import problem_response, should_log
from .security import KNOWN

_log = logging.getLogger(__name__)
MOST_CONNECTIONS = 2000
"""Simultaneous connections; fewer if the system allows fewer open files, see `raise_connection_limit`."""
MOST_HEAD = 65_536
"""Bytes of an address with its headers, plus `_HEADER` for each header; also bytes between the chunks of a body."""
_HEADER = 128
"""Bytes of memory per header, in addition to its text."""
HEAD_SECONDS = 10.0
"""Seconds from the connection, or from the first byte of a request, to the end of its headers."""
BODY_SECONDS = 60.0
"""Seconds from the end of the headers to the end of the body."""
_PIECE = {"rest": 1024, "head": 1024, "body": 16_384}
"""Bytes read at a time; limits are checked after each read."""
_PIECES = 32
"""Reads per turn, at most `_TURN` bytes; then other connections get their turn."""
_TURN = 32_768
_END = b"\n\r\n"
"""End of every header block, and so of most requests."""
_WRITE_BUFFER = 16_384
"""Bytes of an answer that may wait to be sent; the rest is written as the client reads."""
_SHARE = 20
"""Divisor for the fraction of connections that are closed when there are too many."""


def raise_connection_limit() -> int:
    """Return the maximum number of connections after raising the open-file limit as far as possible.

    Half of the open files are reserved for the database, workers and files.
    """
    try:
        import resource
    except ImportError:  # Windows has no such limit
        return MOST_CONNECTIONS
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    limit = 4 * MOST_CONNECTIONS if hard == resource.RLIM_INFINITY else min(hard, 4 * MOST_CONNECTIONS)
    if soft != resource.RLIM_INFINITY and soft < limit:
        resource.setrlimit(resource.RLIMIT_NOFILE, (limit, hard))
        soft = limit
    return MOST_CONNECTIONS if soft == resource.RLIM_INFINITY else min(MOST_CONNECTIONS, soft // 2)


class Gate:
    """Connections of one server.

    most: maximum number of connections. A connection beyond it replaces those that have waited longest, first those
    without the token. It is refused if all others have the token and read their answers.
    """

    def __init__(self, limit: int = MOST_CONNECTIONS) -> None:
        self.most = limit
        self._queue: deque[Connection] = deque()
        self._log_times: dict[str, float] = {}

    def queue(self, connection: Connection) -> None:
        """Queue a connection with unread requests; each pass of the event loop resumes one connection."""
        self._queue.append(connection)
        if len(self._queue) == 1:
            connection.loop.call_soon(self._resume_next_connection)

    def _resume_next_connection(self) -> None:
        connection = self._queue.popleft()
        if self._queue:
            connection.loop.call_soon(self._resume_next_connection)
        connection.flow.resume_reading()
        connection.read()

    def make_way_for(self, new: Connection) -> bool:
        """Close the least needed connection if there are too many; return whether the new one may stay."""
        if len(new.connections) <= self.most:
            return True
        established = [
            connection for connection in new.connections if isinstance(connection, Connection) and connection is not new
        ]
        waiting = sorted(
            (connection for connection in established if connection.may_be_closed),
            key=lambda connection: (connection.has_token, connection.since),
        )
        if not waiting:
            self.log_each_minute(f"refused: {self.most} connections were being answered")
            return False
        # Close several, so that a flood does not trigger a scan for each connection.
        for least in waiting[: 1 + self.most // _SHARE]:
            self.log_each_minute(f"closed because there were more than {self.most}")
            least.transport.abort()
            least.connections.discard(least)
        return True

    def log_each_minute(self, event: str) -> None:
        """Log a connection event, unless it was logged within the last minute."""
        if should_log(self._log_times, event):
            _log.warning("connections %s", event)


class Connection(HttpToolsProtocol):
    """Connection that limits the size and arrival time of each request.

    Requests are read one at a time: later requests stay unread until the client has read the earlier answers. since:
    time of the last received data, s, on the loop's clock.
    """

    def __init__(
        self,
        gate: Gate,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self.since = self.loop.time()
        self._gate = gate
        self._backlog = b""
        self._part: Literal["rest", "head", "body"] = "rest"  # the request part being received
        self._size = 0  # bytes of this part other than content
        self._deadline: asyncio.TimerHandle | None = None

    @property
    def has_token(self) -> bool:
        """Whether its last request was accepted with the token."""
        return KNOWN in getattr(self.cycle, "scope", ())  # None before the first request

    @property
    def is_idle(self) -> bool:
        """Whether no request is being answered."""
        return bool(getattr(self.cycle, "response_complete", True))

    @property
    def may_be_closed(self) -> bool:
        """Whether it may be closed to free a slot: without a token, idle, or not reading its answers."""
        return not self.has_token or self.is_idle or bool(self._backlog) or self.flow.write_paused

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as in the parent
        """Accept the connection, unless there are too many."""
        super().connection_made(transport)
        transport.set_write_buffer_limits(_WRITE_BUFFER)
        if self._gate.make_way_for(self):
            self._set_timeout(HEAD_SECONDS)
        else:
            text = (
                f"the service may have at most {self._gate.most} connections at a time; all are in use; try again later"
            )
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE, text, {"Retry-After": "5"})

    def connection_lost(self, exc: Exception | None) -> None:
        """End."""
        if isinstance(exc, TimeoutError):
            self._gate.log_each_minute("closed: answers were not read")
        self._set_timeout(None)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Accept received data, unless earlier answers are still pending."""
        self.since = self.loop.time()
        self._backlog += data
        if len(self._backlog) == len(data):
            self.read()
        else:
            self.flow.pause_reading()

    @property
    def _may_read(self) -> bool:
        """Whether received data can be read now: the client must read earlier answers before its next request."""
        return not self.pipeline and (self.is_idle or self._part != "rest")

    def read(self) -> None:
        """Read received bytes up to the end of a request, with a limit per turn; refuse oversized parts early."""
        begin = 0
        for _ in range(_PIECES):
            if not begin < min(len(self._backlog), _TURN) or not self._may_read:
                break
            limit = begin + _PIECE[self._part]
            end = self._backlog.find(_END, begin, limit)
            piece = self._backlog[begin : limit if end < 0 else end + len(_END)]
            begin += len(piece)
            self._size += len(piece)
            if self._size > MOST_HEAD:
                long = self._part == "head" and len(self.url) > MOST_HEAD // 2
                status = HTTPStatus.REQUEST_URI_TOO_LONG if long else HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE
                part = "a body beside its content" if self._part == "body" else "an address with its headers"
                self._refuse(status, f"{part} may have at most {MOST_HEAD} bytes; got more; shorten it")
            if self.transport.is_closing():
                return
            super().data_received(piece)
        self._backlog = self._backlog[begin:]
        if self._backlog or self.pipeline:
            self.flow.pause_reading()
        if not self._may_read:
            self._set_timeout(None)
            return
        if self._backlog:
            self._gate.queue(self)
        if self._deadline is None and (self._part != "rest" or self._size):
            self._set_timeout(BODY_SECONDS if self._part == "body" else HEAD_SECONDS)

    def on_message_begin(self) -> None:
        """Begin a request."""
        super().on_message_begin()
        self._part = "head"
        self._set_timeout(None)

    def on_header(self, name: bytes, value: bytes) -> None:
        """Accept a header; headers after a body are ignored."""
        if self._part == "head":
            super().on_header(name, value)
            self._size += _HEADER

    def on_headers_complete(self) -> None:
        """Pass the request on to the application."""
        self._part, self._size = "body", 0
        self._set_timeout(None)
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        """Accept content of the body."""
        self._size = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        """Record that the whole request has arrived."""
        self._part, self._size = "rest", 0
        self._set_timeout(None)
        super().on_message_complete()

    def on_response_complete(self) -> None:
        """Continue with data that the client sent ahead."""
        super().on_response_complete()
        if self._backlog:
            self.flow.pause_reading()
        if self._backlog or self._part != "rest":
            self._gate.queue(self)

    def send_400_response(self, msg: str) -> None:
        """Reject data that is not HTTP."""
        self._refuse(HTTPStatus.BAD_REQUEST, "a request must be HTTP/1.1; got something else; correct it")

    def _set_timeout(self, seconds: float | None) -> None:
        """Expect the next data within some seconds; None ends waiting."""
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = None if seconds is None else self.loop.call_later(seconds, self._refuse_late_request, seconds)

    def _refuse_late_request(self, seconds: float) -> None:
        if self.transport.is_closing():
            return
        if self._part == "rest":  # no client waits for an answer
            self._gate.log_each_minute(f"closed: no request within {seconds:g} s")
            self.transport.close()
            return
        part = "headers" if self._part == "head" else "body"
        text = f"the {part} must arrive within {seconds:g} s; it is incomplete; send less, or over a faster connection"
        self._refuse(HTTPStatus.REQUEST_TIMEOUT, text)

    def _refuse(self, status: HTTPStatus, text: str, headers: dict[str, str] | None = None) -> None:
        self._gate.log_each_minute(f"refused with {status}")
        if self.is_idle or not (self.pipeline or self.cycle.response_started):  # it would corrupt another answer
            response = problem_response(status, text, {**(headers or {}), "Connection": "close"})
            lines = b"".join(b"%s: %s\r\n" % header for header in response.raw_headers)
            start = f"HTTP/1.1 {status} {status.phrase}\r\n".encode()
            self.transport.write(start + lines + b"\r\n" + bytes(response.body))
        self.transport.close()
