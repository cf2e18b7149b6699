"""docs/tutorial.md word for word: its files are written, its commands run, and what they print is what it says."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

from slidercrank.service.cli import app

pytestmark = pytest.mark.slow
PAGE = Path(__file__).parents[2] / "docs" / "tutorial.md"


def blocks() -> Iterator[tuple[str, str]]:
    """Yield kind and content of the fenced blocks of the page."""
    for found in re.finditer(r"^```(\w+)\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
        yield found[1], found[2]


def changed(job: str, part: str) -> str:
    """Return a job with the tables of a part replacing its own with the same heading, or appended."""
    for table in re.split(r"^(?=\[)", part, flags=re.MULTILINE)[1:]:
        head = re.escape(table.splitlines()[0])
        verbatim = table.replace("\\", r"\\")
        job, count = re.subn(rf"^{head}\n(?:(?!\[).*\n)*", verbatim, job, flags=re.MULTILINE)
        job += "" if count else table
    return job


def write(folder: Path, block: str) -> None:
    """Write the file that the first line of a block names, or change it, or write another one like it."""
    comment, _, text = block.partition("\n")
    if of := re.fullmatch(r"# change in (\S+)", comment):
        file, text = folder / of[1], changed((folder / of[1]).read_text(encoding="utf-8"), text)
    elif of := re.fullmatch(r"# (\S+), like (\S+) but", comment):
        file, text = folder / of[1], changed((folder / of[2]).read_text(encoding="utf-8"), text)
    else:
        file = folder / comment.removeprefix("# ")
    file.write_text(text, encoding="utf-8")


def run(line: str) -> str:
    """Run a command and return what it prints; it fails where its comment says so."""
    command, _, comment = line.partition("   # ")
    done = CliRunner().invoke(app, shlex.split(command.removeprefix("slidercrank ")), env={"COLUMNS": "140"})
    assert (done.exit_code != 0) == (comment == "fails"), f"{line}: {done.output}"
    assert done.exception is None or isinstance(done.exception, SystemExit)
    return done.output


def test_the_tutorial_goes_as_it_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SLIDERCRANK_RUNS", raising=False)
    printed, commands, compared = "", 0, 0
    for kind, block in blocks():
        if kind in ("toml", "csv"):
            write(tmp_path, block)
        elif kind == "sh":
            printed = "".join(map(run, block.splitlines()))
            commands += len(block.splitlines())
        else:
            shown = [" ".join(line.split()) for line in printed.splitlines()]
            for line in block.splitlines():
                assert any(" ".join(line.split()) in other for other in shown), f"{line}\n{printed}"
                compared += 1
    assert commands >= 12
    assert compared >= 24
    lengths = re.search(r"This is design 1: (crank .* mm)\.", PAGE.read_text(encoding="utf-8"))
    assert lengths is not None
    assert lengths[1] in (tmp_path / "sealer.svg").read_text(encoding="utf-8").replace("−", "-")
    for name in ("sealer.dxf", "sealer.svg", "sealer.csv", "sealer.html"):
        assert (tmp_path / name).stat().st_size > 5_000
