"""Names of files as text, and back: UTF-8 whatever the locale, as job files, databases and pages have it.

Python takes each byte of a path that the locale's encoding cannot read for half a surrogate pair, which UTF-8 cannot
write, and in a locale of ASCII it finds no file of a name with an umlaut.
"""

from __future__ import annotations

import os
from os import PathLike
from pathlib import Path


def path_text(path: str | PathLike[str]) -> str:
    """Path as text that can be written anywhere; bytes that are no UTF-8 become replacement characters."""
    return os.fspath(path).encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def path_named(name: str | PathLike[str]) -> Path:
    """Path of a file that a text names: in the encoding of the locale if it has the characters, else in UTF-8."""
    text = os.fspath(name)
    try:
        os.fsencode(text)
    except UnicodeEncodeError:
        text = os.fsdecode(text.encode("utf-8", "surrogateescape"))
    return Path(text)
