"""The notebooks of docs/notebooks: every cell runs, and prints what the file says."""

from __future__ import annotations

import contextlib
import io
import json
import re
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
def test_a_notebook_has_exercises_with_room_and_is_small(name: str) -> None:
    file = FOLDER / name
    page = notebook_page(file)
    exercises, _, answers = page.partition("## Answers")
    count = exercises.count("**Exercise ")
    assert 3 <= count <= 4
    for number in range(1, count + 1):
        assert f"**Exercise {number}.**" in exercises
        assert f"<summary>Answer {number}</summary>" in answers
    room = [cell for cell in cells(name) if cell["metadata"].get("tags") == ["exercise"]]
    assert len(room) == count
    assert not any(cell["source"] or cell["outputs"] for cell in room)
    assert "```python\n\n" not in page
    assert file.stat().st_size < 200_000
    assert notebook_pictures(file)


@pytest.mark.parametrize("name", NAMES)
def test_answers_are_closed_and_go_with_their_tag(name: str) -> None:
    whole = json.loads((FOLDER / name).read_text(encoding="utf-8"))["cells"]
    tagged = [cell for cell in whole if cell["metadata"].get("tags") == ["answer"]]
    head, *answers = tagged
    assert whole[-len(tagged) :] == tagged  # nothing else stands among them
    assert "".join(head["source"]).startswith("## Answers\n")
    for cell in answers:
        text = "".join(cell["source"])
        if cell["cell_type"] == "code":
            assert cell["metadata"]["jupyter"] == {"source_hidden": True, "outputs_hidden": True}
            assert re.match(r"# Answer \d in Python\n", text)  # the line that shows while the cell is closed
        else:
            assert text.startswith("<details>\n<summary>")
            assert text.endswith("\n\n</details>")
    page = notebook_page(FOLDER / name)
    assert page.count('<details markdown="1">') == page.count("<details") == len(answers) >= 6


def test_the_course_links_every_notebook() -> None:
    page = (FOLDER.parent / "course.md").read_text(encoding="utf-8")
    assert len(NAMES) == 4
    assert [name for name in NAMES if f"(notebooks/{name})" not in page] == []
