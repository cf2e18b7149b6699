"""Private words of earlier code, kept out of its names; `docs/glossary.md` has the terms to use."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("model", "objectives", "optimise", "service")
OLD_WORDS = frozenset(
    (
        *("told", "tell", "tells", "heard", "hears", "unheard", "stand", "stands", "once", "meant", "asked", "shown"),
        *(
            "beside",
            "reach",
            "face",
            "faces",
            "sheet",
            "sheets",
            "kept",
            "unkept",
            "remembered",
            "pile",
            "thin",
            "stray",
        ),
        *("worth", "room", "apart", "whole", "follow", "followed", "behind", "proof", "forth", "settled", "begun"),
        *("noted", "unsaid", "wanted", "uneven", "rubbed", "own", "outright"),
        *("answer", "answers"),
    )
)
EXCEPTIONS = {
    "Answer": "what a question returns, in its recipe",
    "AnswerBlock": "a name in the API's schema",
    "TopicAnswer": "a name in the API's schema",
    "answer": "the documented method of a question",
    "answer_of": "the documented method of a question about a front or a job",
    "own": "a field of Problem, an argument and a package that users name in their functions, and a field of the API",
    "OwnQuantity": "the documented class of a Python function as a quantity",
    "cancel_asked": "a column of the store and a field of the API",
    "kept": "a part of the addresses of bookmarks",
    "told": "a field of the API",
    "settled": "a field of the answer of `sections`",
    "face_mm": "a field of the API",
    "wanted_fluctuation": "a field of the answer of `flywheel`",
    "uneven_speed": "a topic of `analyse`",
    "once_differentiable": "a name of torch",
    "UnevenSpeed": "the name of that topic's answer in the API's schema",
}
"""Names that users rely on."""

_TEXTS = {
    ".py": re.compile(r"""[\"]{3}.*?[\"]{3}|#[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.DOTALL),
    ".js": re.compile(r"""/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.DOTALL),
}
_DEFINED = {
    ".py": re.compile(r"\b(?:def|class) (\w+)|\b(\w+): "),  # parameters and fields have types
    ".js": re.compile(r"\b(?:function|class) ([\w$]+)()"),
}
_NAME = re.compile(r"[A-Za-z_$][\w$]*")
_SEVERAL_WORDS = re.compile(r"[^\W_]_+[^\W_]|[a-z0-9][A-Z]|^_*[A-Z][A-Z0-9]+$")


@cache
def old_words(name: str) -> frozenset[str]:
    """Return the old words among the parts of a name, written with underscores or capitals."""
    return OLD_WORDS & set(re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower().split("_"))


@cache
def _has_several_words(name: str) -> bool:
    return _SEVERAL_WORDS.search(name) is not None


def names_in(text: str, suffix: str) -> Iterator[str]:
    """Yield functions, classes, typed parameters and fields, constants, and all names of several words."""
    code = _TEXTS[suffix].sub(" ", text)
    yield from (name for names in _DEFINED[suffix].findall(code) for name in names)
    yield from filter(_has_several_words, set(_NAME.findall(code)))


@cache
def names_of(file: Path) -> set[str]:
    """Return the names in a file, and those of its path."""
    names = names_in(file.read_text(encoding="utf-8"), file.suffix)
    return {*file.relative_to(ROOT).with_suffix("").parts, *names}


def code() -> list[Path]:
    """Return the modules in Python and in JavaScript."""
    return [file for top in FOLDERS for file in (ROOT / top).rglob("*") if file.suffix in _TEXTS]


def test_names_have_no_words_of_the_old_vocabulary() -> None:
    refused = [
        f"{file.relative_to(ROOT)}: {name}"
        for file in code()
        for name in names_of(file) - EXCEPTIONS.keys()
        if old_words(name)
    ]
    assert refused == [], "use the words of docs/glossary.md"


def test_every_exception_is_still_a_name() -> None:
    assert set[str]().union(*map(names_of, code())) >= EXCEPTIONS.keys()


@pytest.mark.parametrize("name", ["told_parts", "shownBlocks", "ROOM", "_tell_once", "OwnName", "on_sheet"])
def test_an_old_word_is_found_in_every_way_of_writing(name: str) -> None:
    assert old_words(name)


@pytest.mark.parametrize(
    ("suffix", "text"),
    [
        (".py", "def cut_room(): ..."),
        (".py", "def f(kept: int): ..."),
        (".py", "class A:\n    reach: int"),
        (".py", "shown_text = 1"),
        (".py", "KEPT = 6"),
        (".py", "x.told_parts = 1"),
        (".js", "function told() {}"),
        (".js", "const shownRows = 1;"),
        (".js", "const ROOM = 1;"),
    ],
)
def test_an_old_word_is_found_in_every_name(suffix: str, text: str) -> None:
    assert any(map(old_words, names_in(text, suffix)))


def test_old_words_in_texts_and_comments_do_not_count() -> None:
    script = '// shownRows\nconst a = "shownRows"; /* b_kept */ const drawnRows = 1;'
    assert set(names_in(script, ".js")) == {"drawnRows"}
    assert set(names_in('"""A told_part."""\nlast_part = "cut_room"  # kept_part', ".py")) == {"last_part"}
