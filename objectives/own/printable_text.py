"""Printable text from custom functions' output, for terminals, logs, pages and JSON."""

from __future__ import annotations

import re

_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
"""Unicode control characters, including those for lines and writing direction, and lone surrogates."""


def printable(text: str, *, allowed: str = "") -> str:
    r"""Return a text with every control character except allowed ones escaped as in Python: "\x1b"."""
    return _CONTROL.sub(lambda found: found[0] if found[0] in allowed else ascii(found[0])[1:-1], text)
