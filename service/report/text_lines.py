"""Text broken into lines of a width."""

from __future__ import annotations

from functools import cache
from typing import Any

from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.font_manager import FontProperties


def wrapped(text: str, size: float, width: float, *, bold: bool = False) -> list[str]:
    """Return a text in lines of at most `width` inches at `size` points; a word too long is broken."""
    lines: list[str] = []
    line = ""
    for word in text.split():
        joined = f"{line} {word}".lstrip()
        if _width(joined, size, bold) <= width:
            line = joined
            continue
        if line:
            lines.append(line)
        line = word
        while _width(line, size, bold) > width and len(line) > 1:
            fits = len(line) - 1
            while fits > 1 and _width(line[:fits], size, bold) > width:
                fits -= 1
            lines.append(line[:fits])
            line = line[fits:]
    return [*lines, line] if line or not lines else lines


def longest_word(text: str, size: float, *, bold: bool = False) -> float:
    """Return the width of the longest word of a text, inches, in letters of `size` points."""
    return max((_width(word, size, bold) for word in text.split()), default=0.0)


def _width(text: str, size: float, bold: bool) -> float:
    """Return the width of a line, inches; letters moved together for looks would make it a little less."""
    return sum(_letter(letter, bold) for letter in text) * size


@cache
def _letter(letter: str, bold: bool) -> float:
    """Return the width of a letter of a font of one point, inches."""
    renderer, plain, heavy = _measure()
    return float(renderer.get_text_width_height_descent(letter, heavy if bold else plain, False)[0]) / 72.0 / 100.0


@cache
def _measure() -> tuple[Any, Any, Any]:
    """Return a renderer that measures text, and fonts of 100 points, normal and bold."""
    renderer: Any = RendererAgg(10, 10, 72.0)  # type: ignore[no-untyped-call]
    return renderer, FontProperties(size=100.0), FontProperties(size=100.0, weight="bold")
