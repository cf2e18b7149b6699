"""Limits on connections to the web server: their number, and size and duration of a request.

Requests rejected here never reach the application: anyone can open a connection without a token. Without these limits
one client could take all connections, or keep the server busy with an endless request.
"""

import asyncio
import logging
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Any

import h11
from uvicorn.config import Config
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.server import ServerState

from .problem_documents import is_due_for_log, problem_response
from .security import KNOWN

_log = logging.getLogger(__name__)
MOST_CONNECTIONS = 2000
"""Simultaneous connections; fewer if the system allows fewer open files, see `raise_connection_limit`."""
MOST_HEAD = 65_536
"""Bytes of an address with its headers; also bytes between the chunks of a body."""
HEAD_SECONDS = 10.0
"""Seconds from the connection, or from the first byte of a request, to the end of its headers."""
BODY_SECONDS = 60.0
"""Seconds from the end of the headers to the end of the body."""
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


@dataclass
class Gate:
    """State that all connections of one server share.

    limit: maximum number of connections. log_times: times of the logged events. ahead: continuations of connections
    whose clients have sent requests ahead.
    """

    limit: int
    log_times: dict[str, float] = field(default_factory=dict)
    ahead: deque[Callable[[], None]] = field(default_factory=deque)


class Connection(H11Protocol):
    """Connection that limits the arrival time of each request; h11 limits its size.

    A connection beyond the limit replaces those that have waited longest, first those without the token. It is refused
    if all others have the token and read their answers. since: time of the last received data, s, on the loop's clock.
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
        self._part = ""  # the request part that must arrive soon
        self._deadline: asyncio.TimerHandle | None = None

    @property
    def has_token(self) -> bool:
        """Whether its last request was accepted with the token."""
        return KNOWN in getattr(self.cycle, "scope", ())  # None before the first request

    @property
    def may_be_closed_for_others(self) -> bool:
        """Whether it may be closed to free a slot: without a token, idle, or not reading its answers."""
        is_idle = getattr(self.cycle, "response_complete", True)
        return not self.has_token or is_idle or bool(self.conn.trailing_data[0]) or self.flow.write_paused

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as in the parent
        """Accept the connection, unless there are too many."""
        super().connection_made(transport)
        limit = self._gate.limit
        transport.set_write_buffer_limits(_WRITE_BUFFER)
        if self._free_slot_or_refuse():
            self._expect_request_part("request", HEAD_SECONDS)
        else:
            self._log_each_minute(f"refused: {limit} connections were being answered")
            text = f"the service may have at most {limit} connections at a time; all are in use; try again later"
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE, text, {"Retry-After": "5"})

    def _free_slot_or_refuse(self) -> bool:
        """Close the least needed connections if there are too many; return whether this one may stay."""
        if len(self.connections) <= self._gate.limit:
            return True
        waiting = sorted(
            (
                connection
                for connection in self.connections
                if isinstance(connection, Connection) and connection is not self and connection.may_be_closed_for_others
            ),
            key=lambda connection: (connection.has_token, connection.since),
        )
        # Close several, so that a flood does not trigger a scan for each connection.
        for least in waiting[: 1 + self._gate.limit // _SHARE]:
            self._log_each_minute(f"closed because there were more than {self._gate.limit}")
            least.transport.abort()
            self.connections.discard(least)
        return bool(waiting)

    def connection_lost(self, exc: Exception | None) -> None:
        """End."""
        if isinstance(exc, TimeoutError):
            self._log_each_minute("closed: answers were not read")
        self._expect_request_part("")
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Read data."""
        self.since = self.loop.time()
        super().data_received(data)

    def on_response_complete(self) -> None:
        """Continue with data that the client sent ahead; each pass of the event loop continues one connection."""
        if self.conn.trailing_data[0]:
            self._gate.ahead.append(super().on_response_complete)
            if len(self._gate.ahead) == 1:
                self.loop.call_soon(self._let_next_connection_read)
        else:
            super().on_response_complete()

    def _let_next_connection_read(self) -> None:
        continue_reading = self._gate.ahead.popleft()
        if self._gate.ahead:
            self.loop.call_soon(self._let_next_connection_read)
        continue_reading()

    def handle_events(self) -> None:
        """Read requests as far as they have arrived, and expect the rest in time."""
        super().handle_events()
        if self.conn.their_state is h11.SEND_BODY:
            self._expect_request_part("body", BODY_SECONDS)
        elif self.conn.their_state is h11.IDLE and self.conn.trailing_data[0]:
            self._expect_request_part("headers", HEAD_SECONDS)
        else:
            self._expect_request_part("")

    def _expect_request_part(self, part: str, seconds: float = 0.0) -> None:
        """Expect the rest of a request part within some seconds from its begin; an empty name ends waiting."""
        if part == self._part:
            return
        self._part = part
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = self.loop.call_later(seconds, self._refuse_late_request, seconds) if part else None

    def _refuse_late_request(self, seconds: float) -> None:
        if self._part == "request":  # no client waits for an answer
            self._log_each_minute(f"closed: no request within {seconds:g} s")
            self.transport.close()
        else:
            rule = f"the {self._part} must arrive within {seconds:g} s"
            text = f"{rule}; it is incomplete; send less, or use a faster connection"
            self._refuse(HTTPStatus.REQUEST_TIMEOUT, text)

    def send_400_response(self, msg: str) -> None:
        """Reject data that is not HTTP, and oversized parts."""
        if len(self.conn.trailing_data[0]) > MOST_HEAD:
            text = f"an address with its headers may have at most {MOST_HEAD} bytes; got more; shorten it"
            self._refuse(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, text)
        else:
            self._refuse(HTTPStatus.BAD_REQUEST, "a request must be HTTP/1.1; got something else; correct it")

    def _log_each_minute(self, event: str) -> None:
        """Log a connection event, unless it was logged within the last minute."""
        if is_due_for_log(self._gate.log_times, event):
            _log.warning("connections %s", event)

    def _refuse(self, status: HTTPStatus, text: str, headers: dict[str, str] | None = None) -> None:
        self._log_each_minute(f"refused with {status}")
        if self.cycle is None or self.cycle.response_complete or not self.cycle.response_started:  # type: ignore[redundant-expr]
            response = problem_response(status, text, {**(headers or {}), "Connection": "close"})
            lines = b"".join(b"%s: %s\r\n" % header for header in response.raw_headers)
            start = f"HTTP/1.1 {status} {status.phrase}\r\n".encode()
            self.transport.write(start + lines + b"\r\n" + bytes(response.body))
        self.transport.close()
