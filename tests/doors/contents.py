"""Answers and files as lines of text: JSON sorted, images by size and pixels, PDF by its text."""

from __future__ import annotations

import base64
import io
import json
import re
from collections.abc import Callable
from hashlib import sha256
from typing import Any

_EMBEDDED = re.compile(r"data:(image/[a-z+]+|font/[a-z0-9]+|application/[a-z-]+);base64,([A-Za-z0-9+/=\s]+)")
_BETWEEN_TAGS = re.compile(r">(?=<)")
_KINDS = {
    ".png": "image/png",
    ".gif": "image/gif",
    ".pdf": "application/pdf",
    ".parquet": "application/vnd.apache.parquet",
    ".svg": "image/svg+xml",
    ".html": "text/html",
    ".json": "application/json",
}
_TEXT = ("text/", "application/toml", "image/vnd.dxf")


def kind_of_file(name: str) -> str:
    """Return the media type that a file's name stands for; text unless it is another known one."""
    return _KINDS.get("." + name.rpartition(".")[2].lower(), "text/plain")


def text_of(content: bytes, kind: str) -> str:
    """Return content as lines. kind: media type, maybe with parameters behind it."""
    plain = kind.partition(";")[0].strip().lower()
    if not content:
        return ""
    if plain in _READERS:
        return _READERS[plain](content)
    if plain.startswith(_TEXT):
        return content.decode("utf-8", "backslashreplace").replace("\r\n", "\n")
    if plain.endswith("json"):
        return json_lines(json.loads(content))
    return f"{len(content)} bytes, {_digest(content)}\n"


def json_lines(value: Any) -> str:
    """Return JSON with sorted keys, one per line; a list without tables in it is one line."""
    return "\n".join(_lines(value, "")) + "\n"


def _lines(value: Any, indent: str) -> list[str]:
    deeper = indent + "  "
    if isinstance(value, dict) and value:
        lines = ["{"]
        for key, item in sorted(value.items()):
            first, *rest = _lines(item, deeper)
            lines += [f"{deeper}{json.dumps(key)}: {first}", *rest]
        return [*lines, f"{indent}}}"]
    if isinstance(value, list) and any(isinstance(item, dict | list) and item for item in value):
        lines = ["["]
        for item in value:
            first, *rest = _lines(item, deeper)
            lines += [f"{deeper}{first}", *rest]
        return [*lines, f"{indent}]"]
    return [json.dumps(value, ensure_ascii=False)]


def _digest(content: bytes) -> str:
    return sha256(content).hexdigest()[:12]


def _image(content: bytes) -> str:
    """Return size and a digest of the pixels of a picture, of every frame of one that moves."""
    from PIL import Image

    with Image.open(io.BytesIO(content)) as picture:
        frames, pixels = getattr(picture, "n_frames", 1), sha256()
        for number in range(frames):
            picture.seek(number)
            pixels.update(picture.convert("RGBA").tobytes())
        moving = f", {frames} frames" if frames > 1 else ""
        return f"{picture.format} {picture.width} x {picture.height}{moving}, {pixels.hexdigest()[:12]}\n"


def _markup(content: bytes) -> str:
    """Return HTML or SVG with a tag a line, and what is embedded in it by kind and digest."""

    def embedded(found: re.Match[str]) -> str:
        inner = base64.b64decode(found[2])
        told = text_of(inner, found[1]) if found[1] in ("image/png", "image/gif") else _digest(inner)
        return f"[{found[1]}: {told.strip()}]"

    text = _EMBEDDED.sub(embedded, content.decode("utf-8"))
    return _BETWEEN_TAGS.sub(">\n", text)


def _pdf(content: bytes) -> str:
    from pypdfium2 import PdfDocument

    document = PdfDocument(content)
    try:
        lines = []
        for number, page in enumerate(document, 1):
            width, height = page.get_size()
            text = page.get_textpage().get_text_bounded().replace("\r\n", "\n").rstrip()
            lines += [f"--- page {number}, {width:.0f} x {height:.0f} pt", text]
        return "\n".join(lines) + "\n"
    finally:
        document.close()


def _parquet(content: bytes) -> str:
    import pandas as pd

    table = pd.read_parquet(io.BytesIO(content), engine="pyarrow")
    kinds = ", ".join(f"{name} {kind}" for name, kind in table.dtypes.items())
    return f"{kinds}\n{table.to_csv(index=False)}"


_READERS: dict[str, Callable[[bytes], str]] = {
    "image/png": _image,
    "image/gif": _image,
    "image/svg+xml": _markup,
    "text/html": _markup,
    "application/pdf": _pdf,
    "application/vnd.apache.parquet": _parquet,
}
