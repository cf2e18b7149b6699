"""Limits on connections of the web server: their number, and the size, duration and form of a request.

What is refused here never reaches the application: nobody needs a token to open a connection, and without these limits
one client could hold all of them, or keep the server busy with a request that never ends.
"""

from __future__ import annotations

import asyncio
import logging
from collections import Counter
from http import HTTPStatus
from typing import Any, Literal

from uvicorn.config import Config
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol
from uvicorn.server import ServerState

from .problems import problem

_log = logging.getLogger(__name__)
MOST_CONNECTIONS = 2000
"""Connections at a time; fewer where the system allows fewer open files, see `room_for_connections`."""
MOST_HEAD = 65_536
"""Bytes of an address with the headers."""
MOST_SENT = 8_388_608
"""Bytes of a body as they are sent, with what chunks add; how large a body itself may be `StrictInput` says."""
HEAD_SECONDS = 10.0
"""From connecting, or from the first byte of a request, until its headers are there."""
BODY_SECONDS = 60.0
"""From the headers until the whole body is there."""
_SHARE = 20
"""One in so many connections is closed when there are too many."""
_QUIET = 10.0
"""Seconds between lines of the log about what may happen thousands of times a second."""


def room_for_connections() -> int:
    """Return how many connections there may be, after raising the limit of open files as far as the system lets.

    Half of the open files are kept for the database, workers and files.
    """
    try:
        import resource
    except ImportError:  # not on Windows, which has no such limit
        return MOST_CONNECTIONS
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard == resource.RLIM_INFINITY or hard > 4 * MOST_CONNECTIONS:
        hard = 4 * MOST_CONNECTIONS
    if soft != resource.RLIM_INFINITY and soft < hard:
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
        soft = hard
    return MOST_CONNECTIONS if soft == resource.RLIM_INFINITY else min(MOST_CONNECTIONS, soft // 2)


class Gate:
    """Connections of one server.

    most: how many there may be. A new one beyond it takes the place of those that have waited longest, the ones that
    never asked anything first; it is refused where all are being answered.
    """

    def __init__(self, most: int = MOST_CONNECTIONS) -> None:
        self.most = most
        self._told: Counter[str] = Counter()
        self._timer: asyncio.TimerHandle | None = None

    def make_room(self, new: Connection) -> bool:
        """Close the connection that is needed least if there are too many; whether the new one may stay."""
        if len(new.connections) <= self.most:
            return True
        waiting = [one for one in new.connections if isinstance(one, Connection) and one is not new and one.waits]
        if not waiting:
            self.tell(f"refused for {self.most} connections that were being answered")
            return False
        waiting.sort(key=lambda one: (one.asked, one.since))
        for least in waiting[: 1 + self.most // _SHARE]:  # several, so that a flood is not looked through each time
            self.tell(f"closed at rest, to make room: more than {self.most}")
            least.transport.abort()
            least.connections.discard(least)
        return True

    def tell(self, what: str) -> None:
        """Log what happened to a connection: at once, then how often within some seconds."""
        self._told[what] += 1
        if self._timer is None:
            self._log()

    def _log(self) -> None:
        self._timer = None
        if self._told:
            _log.warning("connections %s", "; ".join(f"{what}: {count}" for what, count in self._told.items()))
            self._told.clear()
            self._timer = asyncio.get_running_loop().call_later(_QUIET, self._log)


class Connection(HttpToolsProtocol):
    """A connection, with limits on the bytes and the time that a request takes to come.

    asked: whether a whole request ever came. since: when it connected or was last answered, s, on the loop's clock.
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
        self.asked = False
        self.since = self.loop.time()
        self._gate = gate
        self._part: Literal["rest", "head", "body"] = "rest"  # what is coming
        self._answering = 0  # requests that wait for their answers
        self._size, self._trailing = 0, 0  # bytes that came in earlier pieces; of headers after the body
        self._fresh = False  # whether this request began in this piece
        self._deadline: asyncio.TimerHandle | None = None
        self._fault: tuple[HTTPStatus, str] | None = None

    @property
    def waits(self) -> bool:
        """Whether nothing is being answered on it."""
        return self._answering == 0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as in the parent
        """Begin, unless there are too many."""
        super().connection_made(transport)
        if self._gate.make_room(self):
            self._wait(HEAD_SECONDS)
        else:
            text = f"the service has at most {self._gate.most} connections at a time; all are in use; try again later"
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE, text, {"Retry-After": "5"})

    def connection_lost(self, exc: Exception | None) -> None:
        """End."""
        self._wait(None)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take in what came; refuse a head that is too large before it ends."""
        self._fresh = False
        super().data_received(data)
        if self._part == "rest" or self._fresh or self.transport.is_closing():
            return
        self._size += len(data)
        if self._part == "head" and self._size > MOST_HEAD:
            self._refuse(*self._too_large())
        elif self._size > MOST_SENT:
            text = f"a body takes at most {MOST_SENT} bytes on its way; got more; send less, or in larger chunks"
            self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, text)

    def on_message_begin(self) -> None:
        """Begin a request."""
        super().on_message_begin()
        self._part, self._size, self._trailing, self._fresh = "head", 0, 0, True
        self._wait(HEAD_SECONDS)

    def on_header(self, name: bytes, value: bytes) -> None:
        """Take in a header; of those that come after a body, none."""
        if self._part == "head":
            super().on_header(name, value)
            return
        self._trailing += len(name) + len(value) + 4
        if self._trailing > MOST_HEAD:
            self._fault = self._too_large()
            raise ValueError(self._fault[1])

    def on_headers_complete(self) -> None:
        """Hand the request on, unless its head is too large."""
        size = len(self.url) + sum(len(name) + len(value) + 4 for name, value in self.headers)
        if size > MOST_HEAD:
            self._fault = self._too_large()
            raise ValueError(self._fault[1])  # the parser ends the request with `send_400_response`
        self._part, self._size = "body", 0
        self._wait(BODY_SECONDS)
        self._answering += 1
        super().on_headers_complete()

    def on_message_complete(self) -> None:
        """Note that the whole request is there."""
        self.asked = True
        self._part = "rest"
        self._wait(None)
        super().on_message_complete()

    def on_response_complete(self) -> None:
        """Note that it was answered."""
        self.since = self.loop.time()
        self._answering -= 1
        super().on_response_complete()

    def send_400_response(self, msg: str) -> None:
        """Refuse what is not HTTP, or was found too large while it was parsed."""
        self._refuse(
            *(self._fault or (HTTPStatus.BAD_REQUEST, "a request is HTTP/1.1; got something else; correct it"))
        )

    def _too_large(self) -> tuple[HTTPStatus, str]:
        rule = f"an address with its headers has at most {MOST_HEAD} bytes; got more; shorten "
        if len(self.url) > MOST_HEAD // 2:
            return HTTPStatus.REQUEST_URI_TOO_LONG, f"{rule}the address"
        return HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, f"{rule}the headers"

    def _wait(self, seconds: float | None) -> None:
        """Expect what comes next within some seconds; None ends waiting."""
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = None if seconds is None else self.loop.call_later(seconds, self._too_late, seconds)

    def _too_late(self, seconds: float) -> None:
        if self.transport.is_closing():
            return
        if self._part == "rest":  # nobody waits for an answer
            self._gate.tell(f"closed, nothing was asked within {seconds:g} s")
            self.transport.close()
            return
        what = "headers" if self._part == "head" else "body"
        text = f"the {what} must be there within {seconds:g} s; not all came; send less, or over a faster connection"
        self._refuse(HTTPStatus.REQUEST_TIMEOUT, text)

    def _refuse(self, status: HTTPStatus, text: str, headers: dict[str, str] | None = None) -> None:
        self._gate.tell(f"refused with {status}")
        if self.waits or not self.cycle.response_started:  # another answer would break one that is under way
            response = problem(status, text, {**(headers or {}), "Connection": "close"})
            lines = b"".join(b"%s: %s\r\n" % header for header in response.raw_headers)
            start = f"HTTP/1.1 {status} {status.phrase}\r\n".encode()
            self.transport.write(start + lines + b"\r\n" + bytes(response.body))
        self.transport.close()
