"""The page and its files: HTML, style and modules, joined into one each, and the typeface."""

import gzip
import hashlib
import io
import posixpath
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from threading import Lock
from types import MappingProxyType

from fastapi import APIRouter, Request, Response

from ...model.errors import NotFound

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


_LETTERS = (range(0x20, 0x7F), range(0xA0, 0x100), range(0x391, 0x3CA))  # Latin and Greek
_SIGNS = (range(0x2010, 0x2027), range(0x2070, 0x2090), range(0x2190, 0x219A), range(0x2200, 0x2266))
_FEATURES = ("kern", "tnum")  # kerning, tabular figures
_LICENCE = (13, 14)  # licence text and address among the font's names, which subsetting drops by default
_ONE = Lock()


def typeface() -> bytes:
    """Return Inter in weights from 400 to 700 as WOFF, 7 % of the original size.

    It is created once, in a second. Inter is by the Inter Project Authors, under the SIL Open Font License 1.1; the
    licence text is in its package, and the font refers to it. WOFF2 would be a third smaller, but takes three times as
    long to create and needs another package.
    """
    with _ONE:
        return _subset_font()


@cache
def _subset_font() -> bytes:
    from fontTools.subset import Options, Subsetter, load_font
    from fontTools.varLib.instancer import instantiateVariableFont

    options = Options(layout_features=[*_FEATURES])
    options.name_IDs = [*options.name_IDs, *_LICENCE]
    font_file = files("fontpkg_inter").joinpath("files", "Inter[opsz,wght].ttf").read_bytes()
    font = load_font(io.BytesIO(font_file), options)
    subsetter = Subsetter(options)
    subsetter.populate(unicodes=[code for part in (*_LETTERS, *_SIGNS) for code in part])
    subsetter.subset(font)
    instantiateVariableFont(font, {"wght": (400, 700)}, inplace=True)
    font.flavor = "woff"
    file = io.BytesIO()
    font.save(file)
    return file.getvalue()


_IMPORT = re.compile(r'^import \{([^}]*)\} from "([^"]+)";', re.MULTILINE)
_LATER = re.compile(r'\bimport\("([^"]+)"\)')
_EXPORT = re.compile(r"^export ((?:async )?function\*? |class |const )(\w+)", re.MULTILINE)
_LEFT = re.compile(r"^(?:import|export)\b.*|\bimport\(.*", re.MULTILINE)
_EXPLAINED = re.compile(
    r"^[ \t]*(?:/\*\*(?:(?!\*/).)*\*/|//[^\n]*)\n|/\*\* @type [^\n]*?\*/ |[ \t]+// [^\"'`\n]*$",
    re.MULTILINE | re.DOTALL,
)
_INDENTATION = re.compile(r"^[ \t]+", re.MULTILINE)
_TAKE = """const made = {};
const make = {};
function take(name) {
  return (made[name] ??= make[name]());
}
"""


def joined_modules(sources: Mapping[str, str], first: str) -> str:
    """Return one module equivalent to the module `first`. sources: text by name, such as "lib/dom.js".

    Two requests instead of seventy: the first view of 10,000 designs appears a fifth sooner. The modules stay
    unchanged, and are tested as served. Comments, types and indentation are removed, which saves three tenths of the
    text. The modules use a small part of JavaScript's module syntax, `import { a, b as c } from "./file.js";`,
    `import("./file.js")`, and `export` before a function, class or const; anything else is rejected when the service
    starts.
    Each module becomes a function that returns its exports and is called on the first import. Raises ValueError for
    circular imports and for unsupported syntax.
    """
    parts: dict[str, str] = {}

    def add(name: str, importers: tuple[str, ...] = ()) -> None:
        if name in importers:
            raise ValueError(f"modules must not import each other in a circle; got {' -> '.join((*importers, name))}")
        if name in parts:
            return
        text, now, later = _as_function(name, sources)
        for imported in now:
            add(imported, (*importers, name))
        parts[name] = text
        for imported in later:
            add(imported)

    add(first)
    return _TAKE + "".join(parts.values()) + f'take("{first}");\n'


def _as_function(name: str, sources: Mapping[str, str]) -> tuple[str, list[str], list[str]]:
    """Return a module as an entry of `make`, and the modules that it imports immediately and later."""
    if name not in sources:
        raise ValueError(f"a module imports {name}, which does not exist")
    now: list[str] = []
    later: list[str] = []

    def resolve(path: str) -> str:
        return posixpath.normpath(posixpath.join(posixpath.dirname(name), path))

    def replace_import(match: re.Match[str]) -> str:
        now.append(resolve(match[2]))
        return f'const {{{match[1].replace(" as ", ": ")}}} = take("{now[-1]}");'

    def replace_dynamic_import(match: re.Match[str]) -> str:
        later.append(resolve(match[1]))
        return f'Promise.resolve().then(() => take("{later[-1]}"))'

    code = _INDENTATION.sub("", _EXPLAINED.sub("", sources[name]))
    text = _LATER.sub(replace_dynamic_import, _IMPORT.sub(replace_import, code))
    exported = [match[2] for match in _EXPORT.finditer(text)]
    text = _EXPORT.sub(r"\1\2", text)
    if strange := _LEFT.search(text):
        raise ValueError(f"{name} must import and export as router.py says; got {strange[0][:100]!r}")
    return f'make["{name}"] = () => {{\n{text}return {{ {", ".join(exported)} }};\n}};\n', now, later


def joined_styles(sources: Mapping[str, str]) -> str:
    """Return the concatenated styles, those for all views first. sources: text by name."""
    common = [name for name in sources if name.endswith("shell.css")]
    return "\n".join(sources[name] for name in (*common, *sorted(set(sources) - set(common))))


_FILES = page_files(Path(__file__).parent / "static")
