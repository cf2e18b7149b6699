"""Standard output and standard error that may be closed, full, or unable to show a character."""

import codecs
import contextlib
import io
import os
import sys
from typing import Any

from ...model.errors import OutputLost
from ...model.file_name_encoding import path_text

_ESCAPES = "slidercrank.shown"
"""Name of the error handler for characters that a stream cannot encode."""


class Output(io.TextIOWrapper):
    """Standard output; raises `OutputLost` if it cannot be written.

    If the reader stops (`| head -1`), further output is discarded, and the command ends with a special exit code.
    """

    left = False
    """Whether the reader has left."""

    def write(self, text: str) -> int:
        """Write text."""
        try:
            return super().write(text)
        except OSError as error:
            self._give_up(error)
            return len(text)

    def flush(self) -> None:
        """Write the buffered text."""
        try:
            super().flush()
        except OSError as error:
            self._give_up(error)

    def _give_up(self, error: OSError) -> None:
        if not isinstance(error, BrokenPipeError):
            raise OutputLost(
                f"cannot write to standard output: {error.strerror or error}; free some space, or write elsewhere"
            ) from None
        self.left = True
        give_up_output()


def has_reader_left() -> bool:
    """Return whether the reader of standard output has stopped."""
    return isinstance(sys.stdout, Output) and sys.stdout.left


def guard_streams() -> None:
    """Set up standard streams that report why they fail, and show "?" for characters that the terminal lacks."""
    codecs.register_error(_ESCAPES, _replacement_text)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115, PTH123 - as long as this process
    if sys.stdout is None:
        # Read-only, so that every attempt to write fails as on the closed stream itself.
        binary: Any = os.fdopen(os.open(os.devnull, os.O_RDONLY), "wb")
        sys.stdout = Output(binary, encoding="utf-8")
    elif isinstance(sys.stdout, io.TextIOWrapper):
        encoding, is_line_buffered = sys.stdout.encoding, sys.stdout.line_buffering
        sys.stdout = Output(sys.stdout.detach(), encoding=encoding, errors=_ESCAPES, line_buffering=is_line_buffered)
    if isinstance(sys.stderr, io.TextIOWrapper):
        sys.stderr.reconfigure(errors=_ESCAPES)


def _replacement_text(error: UnicodeError) -> tuple[bytes, int]:
    """Return the replacement for characters that a stream cannot encode, and the position to continue from.

    Bytes of a path that the locale could not decode are first combined into characters, so that each letter counts as
    one.
    """
    if not isinstance(error, UnicodeEncodeError):
        raise error
    text = error.object[error.start : error.end]
    with contextlib.suppress(UnicodeEncodeError):  # a lone surrogate that does not represent a byte
        text = path_text(text)
    return text.encode(error.encoding, "replace"), error.end


def give_up_output() -> None:
    """Discard buffered text: otherwise the exiting process would write it again, and fail with a message."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
