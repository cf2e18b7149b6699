"""What a browser is shown that does not carry the token."""

from __future__ import annotations

from http import HTTPStatus
from pathlib import Path

from starlette.responses import HTMLResponse

_FILE = Path(__file__).parent / "static" / "locked.html"


def locked_page() -> HTMLResponse:
    """Return the page that says how to get in, with status 401."""
    headers = {"WWW-Authenticate": "Bearer"}
    return HTMLResponse(_FILE.read_bytes(), HTTPStatus.UNAUTHORIZED, headers)
