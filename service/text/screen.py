"""Output of the command line: results to standard output, messages and progress to standard error."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from ...model.file_name_encoding import path_text
from ...optimise.front.progress import Progress
from ...optimise.front.progress import progress_bar as bar
from ..runs.result import json_text
from ..runs.run_folder import translate_disk_errors

if TYPE_CHECKING:
    from rich.console import Console
    from rich.status import Status

    from ...objectives.kinds import System
    from ..figures.panel_drawing import FigureSource


def console() -> Console:
    """Return the console for standard output; 100 columns wide if it is not a terminal."""
    return _console(sys.stdout)


def error_console() -> Console:
    """Return the console for standard error."""
    return _console(sys.stderr)


def _console(stream: TextIO) -> Console:
    from rich.console import Console

    wide = None if stream.isatty() or os.environ.get("COLUMNS") else 100
    return Console(file=stream, width=wide, highlight=False, markup=False, emoji=False)


def print_message(message: str) -> None:
    """Write a message to standard error; it is lost if that fails."""
    with contextlib.suppress(OSError):
        sys.stderr.write(f"{path_text(message)}\n")


def print_output(text: str) -> None:
    """Write a result to standard output unchanged."""
    sys.stdout.write(text)
    sys.stdout.flush()


def print_record(json: bool, record: Any, show: Callable[[Console], None]) -> None:
    """Write a result as JSON or as readable text."""
    if json:
        print_output(json_text(record))
    else:
        show(console())


def show_activity(text: str) -> contextlib.AbstractContextManager[Status | None]:
    """Return a context that shows an activity while it is active; nothing if standard error is not a terminal."""
    screen = error_console()
    return screen.status(text) if screen.is_terminal else contextlib.nullcontext()


def write_figure(file: Path, draw: Callable[[], FigureSource], units: System = "metric") -> None:
    """Write a figure as PNG, create its folder if missing, and print its path."""
    from ..figures.panel_drawing import save_figure

    with translate_disk_errors(file.parent), show_activity("drawing the figure"):
        file.parent.mkdir(parents=True, exist_ok=True)
        save_figure(draw(), file, units)
    print_message(f"figure: {file}")


def progress_bar() -> contextlib.AbstractContextManager[Callable[[Progress], None]]:
    """Return a context with a progress bar on a terminal, and the callback for each round."""
    return bar() if sys.stderr.isatty() else contextlib.nullcontext(lambda _: None)
