"""A quantity is named in its own file: nowhere else is its name a string.

Counted are string literals of Python that are the name, and strings of the page and keys of its objects. Not counted
are examples, in `examples=` and `..._EXAMPLE =`; attributes, arguments and prose, where the names are terms of the
field; and data: shipped job files and published cases.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from slidercrank.objectives.registry import FACTS

ROOT = Path(__file__).parents[2]
FOLDERS = ("model", "objectives", "optimise", "service")
DATA = ("service/presets/", "service/cases/")  # job files, and keys of what papers publish
TERMS = {
    "service/page/static/help/picture.js": "pictures are named after what they show",
    "service/drawings/": "dimensions in a drawing are named after what they measure",
    "service/questions/swing/analysis.py": "a swing has an efficiency of its own",
    "service/motion/player_page.py": "the caption of a linkage names its stroke",
    "service/page/static/form/start.js": "the job that a new form begins with",
    "service/preview/": "the answer of the preview has these keys",
    "service/api/preview.py": "the answer of the preview has these keys",
    "objectives/tables/cycle_curves.py": "curves over the cycle, not quantities",
    "service/questions/inverse/analysis.py": "on which stroke a crank angle puts the slider at a position",
    "service/designs/design_curves.py": "curves over the cycle, not quantities",
    "objectives/tables/swing_curves.py": "curves over a swing, not quantities",
    "service/page/static/design/panels.js": "curves over the cycle, not quantities",
}


def words(path: Path) -> Iterator[str]:
    """Yield the strings of a file that may name something."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        tree = ast.parse(text)
        examples = [node.value for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg == "examples"]
        examples += [
            node.value
            for node in ast.walk(tree)
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "").endswith("EXAMPLE")
        ]
        told = {id(inner) for node in examples for inner in ast.walk(node)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in told:
                yield node.value
    elif path.suffix == ".js":
        yield from (literal or key for literal, key in re.findall(r"""["'`]([a-z_]+)["'`]|\b([a-z_]+):""", text))


@cache
def files_by_quantity() -> dict[str, set[str]]:
    """Return the files that name each quantity."""
    found: dict[str, set[str]] = {name: set() for name in FACTS}
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*")):
            relative = path.relative_to(ROOT).as_posix()
            if path.suffix in (".py", ".js") and not relative.startswith((*DATA, *TERMS)):
                for word in words(path):
                    if word in found:
                        found[word].add(relative)
    return found


@pytest.mark.parametrize("name", FACTS)
def test_a_quantity_is_named_in_its_own_file_and_at_most_one_other(name: str) -> None:
    found = files_by_quantity()[name]
    own = [path for path in found if path.startswith("objectives/")]
    assert len(own) == 1, own
    assert len(found) <= 2, found


def test_the_search_for_names_finds_one_that_is_written_down() -> None:
    assert "objectives/lengths_and_time_ratio.py" in files_by_quantity()["stroke"]
