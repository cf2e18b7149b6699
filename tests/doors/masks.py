"""The only list of texts that differ between recordings, and their replacements."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple


class Mask(NamedTuple):
    """A mask. pattern: what is replaced, its groups stay. words: what stands in its place. reason: why it differs."""

    pattern: re.Pattern[str]
    words: str
    reason: str


def _mask(pattern: str, words: str, reason: str) -> Mask:
    return Mask(re.compile(pattern, re.MULTILINE), words, reason)


_STEPS = r"(?:loading|selecting designs|finishing designs|proving)"
_STEP_REASON = "steps within a round are reported now and then"
_TIMES = "at|submitted|started|finished|due|lease_until"
_PACKAGES = (
    "Python|SQLite|slidercrank|numpy|numba|scipy|sqlalchemy|alembic|fastapi|uvicorn|psycopg|distributed|pyarrow|"
    "cmaes|moocore|optuna|pandas|pint|pydantic|matplotlib|cvxpy|python"
)
MASKS = (
    _mask(r"\b20\d{6}-\d{6}(?=-)", "<run>", "names of runs begin with their time"),
    _mask(r"\b20\d\d-\d\d-\d\d[ T]\d\d:\d\d(:\d\d([.,]\d+)?)?( UTC|Z|[+-]\d\d:?\d\d)?", "<time>", "dates and times"),
    _mask(r"^\d\d:\d\d:\d\d(?= )", "<time>", "times of events"),
    _mask(rf'("(?:{_TIMES})": ?)[0-9.e+]+', r"\1<time>", "times of jobs, events, wishes and kept designs"),
    _mask(r'("seconds": ?)[0-9]+\.(?!0\b)[0-9e.+-]+', r"\1<seconds>", "how long a search took"),
    _mask(
        r"(, in |boxes in |<dt>Time of the search</dt>\n<dd>|Time of the search\s+)[0-9.]+\s+s\b",
        r"\1<seconds>",
        "how long a search took",
    ),
    _mask(r"(^<time>  \w.*hypervolume [0-9.]+, )[0-9.]+ s$", r"\1<seconds>", "how long a search took, in its log"),
    _mask(r"(^\d+ <run>-.* )[0-9.]+ *$", r"\1<seconds>", "how long searches took, in a comparison"),
    _mask(r"(by command line on )\S+, process \d+", r"\1<machine>, process <number>", "processes"),
    _mask(r"\b(h|m|p|image|C\d+_\w+_)[0-9a-f]{10}\b", r"\1<id>", "matplotlib names parts of an SVG by chance"),
    _mask(r"\b[\w.]+-\d+-[0-9a-f]{6}\b", "<worker>", "workers are named after machine, process and chance"),
    _mask(r"(as process |server process \[)\d+", r"\1<number>", "processes"),
    _mask(rf"\b({_PACKAGES})([ =/-]|\": \")\d+(?:\.\w+)+", r"\1\2<version>", "versions"),
    _mask(
        r"^(slidercrank_\w+_seconds(?:_sum|_bucket)?\b.*) [0-9.e+-]+$",
        r"\1 <seconds>",
        "times of answers",
    ),
    _mask(r"\b[0-9.]+ [MGT]B free", "<room> free", "free disk"),
    _mask(r"(differs? by )[+-][0-9.]+ s", r"\1<seconds>", "clocks"),
    _mask(r"^(slidercrank_\w+_created\b.*) [0-9.e+]+$", r"\1 <time>", "when counters began"),
    _mask(rf"^<time>  {_STEPS} .*\n", "", _STEP_REASON),
    _mask(rf'^\{{"number":.*"stage": ?"{_STEPS}".*\n', "", _STEP_REASON),
    _mask(rf'^event: progress\ndata: .*"stage":"{_STEPS}".*\nid: .*\n\n', "", _STEP_REASON),
    _mask(rf'^    \{{\n(?:      .*\n)*?        "stage": "{_STEPS}"\n(?:      .*\n)*    \}}\n', "", _STEP_REASON),
    _mask(r'("number":)\d+(?=,"at")|^(id: )\d+$|("(?:events|last)": )\d+', r"\1\2\3<number>", _STEP_REASON),
    _mask(r'("kind": "(?:progress|state)"\n +"number": )\d+', r"\1<number>", _STEP_REASON),
    _mask(
        r"^slidercrank (compiles|is compiling) its formulas.*\n",
        "",
        "formulas are compiled where none are kept on disk",
    ),
    _mask(r"^24\d{5}\.\d+$", "<day>", "dates of DXF, in days"),
    _mask(r"\{[0-9A-F]{8}(-[0-9A-F]{4}){3}-[0-9A-F]{12}\}", "<id>", "random names of DXF"),
    _mask(r"\b127\.0\.0\.1:\d+", "127.0.0.1:<port>", "free ports"),
    _mask(r"(token=)[A-Za-z0-9_-]{20,}", r"\1<token>", "random tokens"),
)


def masked(text: str, places: Iterable[str] = ()) -> str:
    """Return a text with everything masked that differs each time. places: folders of this recording."""
    for place in sorted(places, key=len, reverse=True):
        text = text.replace(place, "<folder>")
    for mask in MASKS:
        text = mask.pattern.sub(mask.words, text)
    return text
