"""Output of the command line: results to standard output, messages and progress to standard error."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TextIO

from .search_progress import standing

if TYPE_CHECKING:
    from rich.console import Console

    from ...optimise.front.progress import Progress


def console() -> Console:
    """Return the console of standard output; 100 columns wide where it is no terminal."""
    return _console(sys.stdout)


def error_console() -> Console:
    """Return the console of standard error."""
    return _console(sys.stderr)


def _console(stream: TextIO) -> Console:
    from rich.console import Console

    wide = None if stream.isatty() or os.environ.get("COLUMNS") else 100
    return Console(file=stream, width=wide, highlight=False, markup=False, emoji=False)


def say(message: str) -> None:
    """Write a message to standard error; where nothing can be written there, it is lost."""
    with contextlib.suppress(OSError):
        sys.stderr.write(f"{message}\n")


def give(text: str) -> None:
    """Write a result to standard output as it is."""
    sys.stdout.write(text)
    sys.stdout.flush()


def waiting(text: str) -> contextlib.AbstractContextManager[object]:
    """Return a context that shows an activity while entered; nothing where standard error is no terminal."""
    screen = error_console()
    return screen.status(text) if screen.is_terminal else contextlib.nullcontext()


@contextlib.contextmanager
def progress_bar() -> Iterator[Callable[[Progress], None]]:
    """Show a live bar on standard error if it is a terminal; yield the callback for each round."""
    screen = error_console()
    if not screen.is_terminal:
        yield lambda _: None
        return
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    with Bar(
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        TextColumn("{task.fields[found]}"),
        TimeElapsedColumn(),
        console=screen,
        transient=True,
    ) as bar:
        task = bar.add_task("starting", total=None, found="")

        def tell(at: Progress) -> None:
            bar.update(
                task,
                description=standing(vars(at)),
                completed=at.step if at.steps else at.round,
                total=at.steps or at.rounds,
                found=f"{at.feasible:,} feasible, hypervolume {at.hypervolume:.4f}",
            )

        yield tell
