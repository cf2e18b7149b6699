"""The web server of the API: its address, its names, and its end."""

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
"""Time that a client may take nothing of its answer; then the system breaks the connection off (Linux)."""
_BUFFER = 16_384
"""Bytes that the system keeps for each direction of a connection, beside those on their way, instead of megabytes."""
_KEEP_ALIVE = 75
"""Seconds that a connection at rest stays open: longer than clients keep theirs, so none is closed as it is used."""
_FAREWELL = 2
"""Seconds that requests and streams of events have to end once the server stops; clients come back to the next."""
_ANY = ("0.0.0.0", "::")


def is_loopback(host: str) -> bool:
    """Whether an address is reachable only from this machine."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def names_of(host: str) -> tuple[str, ...]:
    """Return the host names of a service that listens on an address."""
    from .settings import LOOPBACK

    host_name = socket.gethostname() if host in _ANY else host
    return tuple(dict.fromkeys((*LOOPBACK, _bracketed(host_name))))


def listen(host: str, port: int) -> socket.socket:
    """Return a listening socket; connections wait from now on. Raises `InputError` if that is not possible."""
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        listening = socket.create_server(address[:2], family=family, backlog=_WAITING)
    except (OSError, UnicodeError) as error:
        raise InputError(
            f"the service needs an address of this machine and a free port; {host} port {port} gave: {_why(error)}; "
            "choose another one with --port (0 takes any that is free) or --host"
        ) from None
    # Connections inherit these. Without TCP_NODELAY the second answer on one waits 40 ms for a delayed acknowledgement;
    # asyncio sets it itself only if the listening socket was created with the protocol named.
    options = {"TCP_NODELAY": 1, "TCP_USER_TIMEOUT": round(1e3 * STALL_SECONDS), "TCP_NOTSENT_LOWAT": _BUFFER}
    for name in filter(partial(hasattr, socket), options):
        listening.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), options[name])
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
    return listening


def _why(error: OSError | UnicodeError) -> str:
    if isinstance(error, UnicodeError):
        return str(error)
    has_number = error.errno is not None and error.errno > 0  # negative if a name is not found
    return os.strerror(error.errno or 0) if has_number else error.strerror or str(error)


def url_of(host: str, listening: socket.socket, token: str | None) -> str:
    """Return the address of a service for a browser, with its token if it is given."""
    name = socket.gethostname() if host in _ANY else host
    address = f"http://{_bracketed(name)}:{listening.getsockname()[1]}/"
    return address if token is None else f"{address}?token={token}"


def spare_imports() -> None:
    """Exempt imported objects from garbage collection: scanning them stops all requests for 0.2 s each time."""
    gc.collect()
    gc.freeze()


def config_of(app: FastAPI) -> Config:
    """Return the web server configuration for an application."""
    from uvicorn import Config

    from .connections import Connection, Gate, raise_connection_limit

    return Config(
        app,
        http=cast("Any", partial(Connection, Gate(raise_connection_limit()))),  # any factory of protocols works
        log_config=None,
        access_log=False,  # the address that carries the token would be in it
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

    stop_requested: whether a signal came before the server installed its own handlers. stopping: function called when
    the server begins to stop, before the grace period for running requests.
    """
    import uvicorn

    class Server(uvicorn.Server):
        """Server that ends the event streams first: they would otherwise wait until they are cut."""

        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            self.should_exit = self.should_exit or stop_requested()
            await super().startup(sockets)

        async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
            stopping()
            app.state.feed.close()
            await super().shutdown(sockets)

    spare_imports()
    Server(config_of(app)).run(sockets=[listening])


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
