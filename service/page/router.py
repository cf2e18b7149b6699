"""The page and its files: HTML, style, modules, typeface."""

import gzip
import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from fastapi import APIRouter, Request, Response

from ...model.errors import NotFound
from .bundle import joined_modules, joined_styles
from .typeface import typeface

router = APIRouter(include_in_schema=False)

POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data: blob:",
        "font-src 'self'",
        "connect-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)
"""Content security policy of the page (CSP): only scripts and resources of the service itself, nothing inline."""
_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
}
_HEADERS = {"Content-Security-Policy": POLICY, "Cache-Control": "no-cache", "Vary": "Accept-Encoding"}
"""Browsers revalidate each time and download only changed files, so a new version takes effect immediately."""


@router.get("/")
async def show_page(request: Request) -> Response:
    """Return the document; its modules request everything else from the API."""
    return _page_file(request, "index.html")


@router.get("/page/inter.woff")
def fetch_typeface(request: Request) -> Response:
    """Return the typeface; runs in a thread, since creating it takes seconds the first time."""
    content = typeface()
    return response_with_etag(
        request, f'W/"{content_tag(content)}"', lambda: Response(content, media_type="font/woff"), _HEADERS
    )


@router.get("/page/{name:path}")
async def fetch_page_file(request: Request, name: str) -> Response:
    """Return a file that the document uses."""
    return _page_file(request, name)


@dataclass(frozen=True)
class _File:
    """File of the page, plain and compressed. tag: tag that changes with the content."""

    media_type: str
    content: bytes
    compressed: bytes
    tag: str


def _page_file(request: Request, name: str) -> Response:
    file = _FILES.get(name)
    if file is None:
        raise NotFound(f"the page has no file {name[:100]!r}; open the address of the service itself")

    def file_response() -> Response:
        if "gzip" in request.headers.get("accept-encoding", ""):
            return Response(file.compressed, media_type=file.media_type, headers={"Content-Encoding": "gzip"})
        return Response(file.content, media_type=file.media_type)

    return response_with_etag(request, file.tag, file_response, _HEADERS)


def response_with_etag(
    request: Request,
    tag: str | None,
    make_response: Callable[[], Response],
    headers: Mapping[str, str] = MappingProxyType({}),
) -> Response:
    """Return an answer with an ETag, or 304 if the client has the current version.

    make_response: creates the answer; called only if it is sent. tag: tag that changes with the content; None for
    content that browsers must not cache.
    """
    same = tag is not None and request.headers.get("if-none-match") == tag
    response = Response(status_code=304) if same else make_response()
    response.headers.update({"Cache-Control": "private, no-cache", **headers, **({"ETag": tag} if tag else {})})
    return response


def content_tag(content: bytes) -> str:
    """Return a tag for some content, in letters and digits."""
    return hashlib.sha256(content).hexdigest()[:16]


def page_files(folder: Path) -> dict[str, _File]:
    """Return the files of a folder by name, read once.

    A name from a client is never used as a path.

    The document requests only app.js, which joins all modules, and style.css. The other files are served for readers of
    the source.
    """
    paths = [path for path in folder.rglob("*") if path.suffix in _TYPES]
    texts = {path.relative_to(folder).as_posix(): path.read_text("utf-8") for path in sorted(paths)}
    styles = {name: text for name, text in texts.items() if name.endswith(".css")}
    joined = {"app.js": joined_modules(texts, "app.js"), "style.css": joined_styles(styles)}
    files = {}
    for name, text in {**texts, **joined}.items():
        content = text.encode()
        compressed = gzip.compress(content, mtime=0)
        files[name] = _File(_TYPES[Path(name).suffix], content, compressed, f'W/"{content_tag(content)}"')
    return files


_FILES = page_files(Path(__file__).parent / "static")
