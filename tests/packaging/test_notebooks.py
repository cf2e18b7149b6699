"""The notebooks of docs/notebooks: every cell runs, and prints what the file says."""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Iterator
from typing import Any

import matplotlib.pyplot as plt
import pytest

from docs.site.notebooks import FOLDER, notebook_files, notebook_page, notebook_pictures

NAMES = [file.name for file in notebook_files()]


@pytest.fixture
def plots(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Draw without a window, and forget the figures."""
    plt.switch_backend("agg")
    monkeypatch.chdir(FOLDER)
    with plt.rc_context():
        yield
    plt.close("all")


def cells(name: str) -> list[dict[str, Any]]:
    whole: dict[str, Any] = json.loads((FOLDER / name).read_text(encoding="utf-8"))
    assert (whole["nbformat"], whole["metadata"]["kernelspec"]["name"]) == (4, "python3")
    return [cell for cell in whole["cells"] if cell["cell_type"] == "code"]


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.usefixtures("plots")
def test_every_cell_prints_what_the_notebook_says(name: str) -> None:
    variables: dict[str, Any] = {"__name__": "__main__"}
    for number, cell in enumerate(cells(name)):
        printed = io.StringIO()
        plt.close("all")
        with contextlib.redirect_stdout(printed):
            exec(compile("".join(cell["source"]), f"{name}, code cell {number + 1}", "exec"), variables)
        streams = ["".join(output["text"]) for output in cell["outputs"] if output["output_type"] == "stream"]
        assert printed.getvalue() == "".join(streams)
        drawn = [output for output in cell["outputs"] if "image/png" in output.get("data", {})]
        assert drawn or not plt.get_fignums(), cell["source"]


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_has_exercises_with_collapsed_answers_and_is_small(name: str) -> None:
    file = FOLDER / name
    page = notebook_page(file)
    exercises, _, answers = page.partition("## Answers")
    assert 3 <= exercises.count("**Exercise ") <= 4
    for number in range(1, exercises.count("**Exercise ") + 1):
        assert f"**Exercise {number}.**" in exercises
        assert f"**{number}.**" in answers
    hidden = [cell for cell in cells(name) if cell["metadata"].get("tags") == ["answer"]]
    assert page.count("<details") == len(hidden) >= 3
    assert all(cell["metadata"]["jupyter"]["source_hidden"] for cell in hidden)
    assert file.stat().st_size < 200_000
    assert notebook_pictures(file)


def test_the_course_links_every_notebook() -> None:
    page = (FOLDER.parent / "course.md").read_text(encoding="utf-8")
    assert len(NAMES) == 4
    assert [name for name in NAMES if f"(notebooks/{name})" not in page] == []
