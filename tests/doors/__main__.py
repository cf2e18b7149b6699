"""Record what every door answers, or compare two recordings: `python -m tests.doors`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False, help=__doc__)


@app.command()
def record(
    folder: Annotated[Path, typer.Argument(help="A new folder.")],
    script: Annotated[list[str] | None, typer.Option(help="Only this script. Repeatable.")] = None,
) -> None:
    """Run all scripts and write what they answer; exit code 1 if a case ends otherwise than its script says."""
    from .recording import record

    if folder.exists():
        raise typer.BadParameter(f"a recording needs a new folder; {folder} is there")
    wrong = record(folder, script or ())
    sys.stdout.write("".join(f"{line}\n" for line in wrong))
    raise typer.Exit(int(bool(wrong)))


@app.command()
def compare(
    before: Annotated[Path, typer.Argument(help="A recording.")],
    after: Annotated[Path, typer.Argument(help="Another one.")],
    allowed: Annotated[Path | None, typer.Option(help="Differences that are meant, TOML.")] = None,
    data: Annotated[bool, typer.Option("--data", help="Only codes, keys, options and numbers, not words.")] = False,
) -> None:
    """List what differs between two recordings; exit code 1 if anything does that is not allowed."""
    from .comparing import compare, read_allowances

    allowances = read_allowances(allowed) if allowed else []
    found = compare(before, after, allowances, data=data)
    for case, text in found.differences.items():
        sys.stdout.write(f"{case}\n{text}\n")
    for one in allowances:
        if not one.used:
            sys.stdout.write(f"allowed but not there: {one.cases}: {one.reason}\n")
    count = len(found.differences)
    sys.stdout.write(f"{found.cases} cases, {count} differ; {found.allowed} lines differ as they may\n")
    raise typer.Exit(int(count > 0))


if __name__ == "__main__":
    app()
