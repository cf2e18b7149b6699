"""Web server for the API: its address, its host names, and its shutdown."""

from __future__ import annotations

import gc
import ipaddress
import os
import socket
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, cast

from ...model.errors import InputError

if TYPE_CHECKING:
    from fastapi import FastAPI
    from uvicorn import Config

_WAITING = 2048
"""Connections that may wait to be accepted."""
STALL_SECONDS = 60.0
"""Seconds that a client may go without reading its answer; then the system closes the connection (Linux)."""
_BUFFER = 16_384
"""Bytes that the system buffers for each direction of a connection, apart from data in transit, instead of
megabytes."""
_KEEP_ALIVE = 75
"""Seconds that an idle connection stays open: longer than clients keep theirs, so none is closed while in use."""
_FAREWELL = 2
"""Seconds that requests and event streams have to end after the server stops; clients reconnect to the next one."""
_ANY = ("0.0.0.0", "::")


def is_loopback(host: str) -> bool:
    """Whether an address is reachable only from this machine."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def accepted_host_names(host: str) -> tuple[str, ...]:
    """Return the host names of a service that listens on an address."""
    from .settings import LOOPBACK

    host_name = socket.gethostname() if host in _ANY else host
    return tuple(dict.fromkeys((*LOOPBACK, _host_in_brackets_if_ipv6(host_name))))


def listening_socket(host: str, port: int) -> socket.socket:
    """Return a listening socket; connections wait from now on. Raises `InputError` if that is not possible."""
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        listening = socket.create_server(address[:2], family=family, backlog=_WAITING)
    except (OSError, UnicodeError) as error:
        raise InputError(
            f"the service needs an address of this machine and a free port; {host} port {port} gave: "
            f"{_listen_error_text(error)}; choose another one with --port (0 takes any that is free) or --host"
        ) from None
    # Connections inherit these. Without TCP_NODELAY the second answer on a connection waits 40 ms for a delayed
    # acknowledgement; asyncio sets it only if the listening socket was created with an explicit protocol.
    options = {"TCP_NODELAY": 1, "TCP_USER_TIMEOUT": round(1e3 * STALL_SECONDS), "TCP_NOTSENT_LOWAT": _BUFFER}
    for name in filter(partial(hasattr, socket), options):
        listening.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), options[name])
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
    return listening


def _listen_error_text(error: OSError | UnicodeError) -> str:
    if isinstance(error, UnicodeError):
        return str(error)
    has_number = error.errno is not None and error.errno > 0  # negative if a name is not found
    return os.strerror(error.errno or 0) if has_number else error.strerror or str(error)


def browser_url(host: str, listening: socket.socket, token: str | None) -> str:
    """Return the address of a service for a browser, with its token if there is one."""
    name = socket.gethostname() if host in _ANY else host
    address = f"http://{_host_in_brackets_if_ipv6(name)}:{listening.getsockname()[1]}/"
    return address if token is None else f"{address}?token={token}"


def freeze_imported_objects() -> None:
    """Exempt imported objects from garbage collection: each scan of them stops all requests for 0.2 s."""
    gc.collect()
    gc.freeze()


def config_of(app: FastAPI) -> Config:
    """Return the web server configuration for an application."""
    from uvicorn import Config

    from .connection_limits import MOST_HEAD, Connection, Gate, raise_connection_limit

    return Config(
        app,
        http=cast("Any", partial(Connection, Gate(raise_connection_limit()))),  # any protocol factory works
        h11_max_incomplete_event_size=MOST_HEAD,
        log_config=None,
        access_log=False,  # it would contain the address with the token
        server_header=False,
        ws="none",
        timeout_keep_alive=_KEEP_ALIVE,
        timeout_graceful_shutdown=_FAREWELL,
    )


def run_server(
    app: FastAPI,
    listening: socket.socket,
    *,
    stop_requested: Callable[[], bool] = lambda: False,
    stopping: Callable[[], None] = lambda: None,
) -> None:
    """Serve an application until SIGTERM or Ctrl-C, which are passed on to the previous handlers.

    stop_requested: whether a signal arrived before the server installed its own handlers. stopping: function called
    when the server starts to stop, before the grace period for running requests.
    """
    import uvicorn

    class Server(uvicorn.Server):
        """Server that ends the event streams first: otherwise they would wait until they are cut off."""

        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            self.should_exit = self.should_exit or stop_requested()
            await super().startup(sockets)

        async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
            stopping()
            app.state.feed.close()
            await super().shutdown(sockets)

    freeze_imported_objects()
    Server(config_of(app)).run(sockets=[listening])


def _host_in_brackets_if_ipv6(host: str) -> str:
    return f"[{host}]" if ":" in host else host
