"""The command that makes the pictures of README and docs."""

from __future__ import annotations

import math

import pytest

from benchmarks.pictures import FOLDER, MOST_SECONDS, PICTURES, main, require_quick


def test_every_picture_of_the_docs_is_made_by_the_command() -> None:
    files = [*FOLDER.glob("*.png"), *FOLDER.glob("*.gif"), FOLDER / "glossary.svg"]
    assert {file.name for file in files} == set(PICTURES)


@pytest.mark.parametrize("seconds", [7 * 60.0, MOST_SECONDS + 0.1, math.nan, math.inf])
def test_a_search_that_took_long_is_not_shown(seconds: float) -> None:
    require_quick(1.0)
    with pytest.raises(SystemExit, match="end what else runs on this machine"):
        require_quick(seconds)


def test_a_picture_that_is_none_is_refused() -> None:
    with pytest.raises(SystemExit, match=r"the pictures are exploring_front\.gif, .*got nothing\.png"):
        main(["nothing.png"])
