"""Access to the service: only with the token, not from pages of other sites, and not under another host name."""

import hashlib
import hmac
import logging
from http import HTTPStatus
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import MutableHeaders
from starlette.requests import HTTPConnection
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from ..page.token_page import token_request_page
from .problem_documents import FAULT, problem_response
from .settings import Settings

_log = logging.getLogger(__name__)
OPEN = "/api/v1/health/live"
"""The only path that needs no token: it reports only that the service answers."""
KNOWN = "slidercrank.known"
"""Key in a request's scope, set once the request is admitted with the token, or if no token is required."""
_HEADERS = {
    "Content-Security-Policy": "default-src 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Guard:
    """ASGI middleware: refuses requests, answers unexpected errors, and adds headers for browsers.

    Refuses, in this order: a Host that is not a name of the service, as after DNS rebinding; an Origin that differs
    from the service, also by port, since cookies do not distinguish ports; a wrong or missing token. The token is sent
    as `Authorization: Bearer ...`. A browser instead has the cookie set by `GET /?token=...`, which holds a value
    derived from the token, not the token itself.
    """

    def __init__(self, app: ASGIApp, *, settings: Settings) -> None:
        self.app = app
        self.hosts = frozenset(host.lower() for host in settings.hosts)
        self.token = None if settings.token is None else settings.token.encode()
        # Cookies are shared by all ports of a machine: two services must not mistake each other's cookies for their
        # own.
        self.cookie = f"slidercrank-{_derived_secret(self.token or b'', 'name')[:12]}"
        self.session = _derived_secret(self.token or b"", "session")

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request, or pass it on."""
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008})
            return
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        started = False

        async def send_with_headers(message: Message) -> None:
            nonlocal started
            if message["type"] == "http.response.start":
                started = True
                headers = MutableHeaders(scope=message)
                for name, value in _HEADERS.items():
                    headers.setdefault(name, value)
            await send(message)

        try:
            response = self._rejection_response(HTTPConnection(scope)) or self.app
            await response(scope, receive, send_with_headers)
        except Exception as error:
            _log.exception("%s %s", scope["method"], scope["path"])
            if started:
                raise  # makes the server close the connection: half a response must not look complete
            fault = problem_response(HTTPStatus.INTERNAL_SERVER_ERROR, f"unexpected {type(error).__name__}; {FAULT}")
            await fault(scope, receive, send_with_headers)

    def _rejection_response(self, connection: HTTPConnection) -> Response | None:
        """Return the answer to a refused request; None if it is passed on."""
        scope, headers = connection.scope, connection.headers
        host = headers.getlist("host")
        if "*" not in self.hosts and (len(host) != 1 or _host_without_port(host[0]) not in self.hosts):
            names = ", ".join(sorted(self.hosts))
            return problem_response(
                HTTPStatus.FORBIDDEN,
                f"the service must be called by one of its names, {names}; got Host "
                f"{host[0][:100] if host else 'missing'!r}; use one, or serve with --host",
            )
        for origin in headers.getlist("origin"):
            if not _is_same_origin(origin, host[0] if host else ""):
                return problem_response(
                    HTTPStatus.FORBIDDEN,
                    f"pages of other sites may not send requests; got Origin {origin[:100]!r}; open the page of the "
                    "service itself",
                )
        if self.token is not None:
            if scope["path"] == OPEN:
                return None
            if scope["path"] == "/" and scope["method"] == "GET" and b"token=" in scope["query_string"]:
                return self._set_cookie_and_redirect(connection)
            if not self._has_valid_token(connection):
                if scope["path"] == "/" and "text/html" in headers.get("accept", ""):
                    return token_request_page(connection)
                return _unauthorised_response(
                    "a request must carry the token of the service; got none or a wrong one; send it as "
                    "Authorization: Bearer TOKEN, or open the address that the service printed"
                )
        scope[KNOWN] = True
        return None

    def _set_cookie_and_redirect(self, connection: HTTPConnection) -> Response:
        """Answer an address that contains the token: set a cookie, and redirect to the address without it."""
        scope = connection.scope
        tokens = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])
        if len(tokens) != 1 or not self._is_token(tokens[0]):
            if "text/html" in connection.headers.get("accept", ""):
                return token_request_page(connection, wrong=True)
            return _unauthorised_response(
                "the address must carry the token of the service; got a wrong one; open the address that the service "
                "printed last"
            )
        response = RedirectResponse("/", HTTPStatus.SEE_OTHER)
        secure = scope.get("scheme") == "https"
        response.set_cookie(self.cookie, self.session, httponly=True, samesite="strict", secure=secure, path="/")
        return response

    def _has_valid_token(self, connection: HTTPConnection) -> bool:
        scheme, _, token = connection.headers.get("authorization", "").partition(" ")
        if scheme.lower() == "bearer" and self._is_token(token.strip()):
            return True
        return hmac.compare_digest(
            connection.cookies.get(self.cookie, "").encode(errors="replace"), self.session.encode()
        )

    def _is_token(self, token: str) -> bool:
        """Whether a text is the token, compared in constant time."""
        return self.token is not None and hmac.compare_digest(token.encode(errors="replace"), self.token)


def _unauthorised_response(text: str) -> Response:
    return problem_response(HTTPStatus.UNAUTHORIZED, text, {"WWW-Authenticate": "Bearer"})


def _derived_secret(token: bytes, purpose: str) -> str:
    """Return a text that only the token can produce and that does not reveal the token."""
    return hmac.new(token, f"slidercrank {purpose}".encode(), hashlib.sha256).hexdigest()


def _host_without_port(host: str) -> str:
    """Return a Host without its port, in lower case."""
    name, colon, port = host.rpartition(":")
    return (name if colon and port.isdecimal() else host).lower()


def _is_same_origin(origin: str, host: str) -> bool:
    try:
        parts = urlsplit(origin)
    except ValueError:
        return False
    return parts.scheme in ("http", "https") and parts.netloc.lower() == host.lower()
