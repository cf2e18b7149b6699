"""File names as text and back: UTF-8 in every locale, as in job files, databases and pages.

Python turns each byte in a path that the locale's encoding cannot decode into a lone surrogate, which UTF-8 cannot
encode. In an ASCII locale it does not find a file with an umlaut in its name.
"""

import os
from os import PathLike
from pathlib import Path


def path_text(path: str | PathLike[str]) -> str:
    """Path as text that can be written anywhere; bytes that are not UTF-8 become replacement characters."""
    return os.fspath(path).encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def path_from_text(name: str | PathLike[str]) -> Path:
    """Return the path for a file name, encoded in the locale's encoding, or in UTF-8 if that lacks a character."""
    text = os.fspath(name)
    try:
        os.fsencode(text)
    except UnicodeEncodeError:
        text = os.fsdecode(text.encode("utf-8", "surrogateescape"))
    return Path(text)
