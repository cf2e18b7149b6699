"""Page that asks for the token in browsers without it."""

import base64
import hashlib
from functools import cache
from html import escape
from http import HTTPStatus
from pathlib import Path
from string import Template

from starlette.requests import HTTPConnection
from starlette.responses import HTMLResponse

_STATIC = Path(__file__).parent / "static"
_STYLE = """
.locked { max-width: 40rem; padding-top: 3rem; }
.locked .asked { display: flex; flex-wrap: wrap; gap: .6rem; align-items: center; }
.locked input { flex: 1 1 14rem; }
.locked code { overflow-wrap: anywhere; }
"""
# Browsers do not send the view name after the #: the script adds it to the form address, and the redirect keeps it.
_SCRIPT = """
document.documentElement.dataset.scheme = localStorage.getItem("scheme") ?? "auto";
history.replaceState(null, "", location.pathname + location.hash);  // a token that was wrong does not stay to be read
document.forms[0].addEventListener("submit", ({ target }) => { target.action = `/${location.hash}`; });
"""
_WRONG = '<p class="error" role="alert">That was not the token of this service.</p>'


def token_request_page(connection: HTTPConnection, *, wrong: bool = False) -> HTMLResponse:
    """Return the page that asks for the token, with status 401. wrong: whether a wrong token was entered.

    The page's address is that of the connection, whose Host is a name of the service.
    """
    page = Template((_STATIC / "locked.html").read_text(encoding="utf-8"))
    address = f"{connection.scope.get('scheme', 'http')}://{connection.headers.get('host', '')}/?token=…"
    content = page.substitute(
        address=escape(address),
        refused=_WRONG if wrong else "",
        icon=base64.b64encode((_STATIC / "icon.svg").read_bytes()).decode(),
        style=_page_style(),
        script=_SCRIPT,
    )
    headers = {"WWW-Authenticate": "Bearer", "Content-Security-Policy": _content_policy()}
    return HTMLResponse(content, HTTPStatus.UNAUTHORIZED, headers)


@cache
def _page_style() -> str:
    """Return the common style and that of this page inline: the style files require the token."""
    return (_STATIC / "style" / "shell.css").read_text(encoding="utf-8") + _STYLE


@cache
def _content_policy() -> str:
    """Return the content security policy: only this exact style and script, and a form sent to the service."""
    digests = (hashlib.sha256(text.encode()).digest() for text in (_page_style(), _SCRIPT))
    style, script = (f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests)
    return (
        f"default-src 'none'; style-src {style}; script-src {script}; img-src data:; form-action 'self'; "
        "base-uri 'none'; frame-ancestors 'none'"
    )
