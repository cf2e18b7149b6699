"""Mistakes in a job with their places, taken from the beginnings of the job parser's sentences."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ...model.errors import InputError
from ...optimise.job import Job

_COUNT = re.compile(r"\d+ problems|very many problems")
_PLACE = re.compile(r'((?:[a-z_]\w*|"[^"\n]*")(?: #\d+)?(?:\.(?:\w+|"[^"\n]*")(?: #\d+)?)*): (.+)', re.DOTALL)


@dataclass(frozen=True)
class Wrong:
    """Something that is wrong. path: the key, as "mechanism.slider.mass" or "load #2.force"; "" for the whole job."""

    path: str
    sentence: str


def places(error: InputError) -> list[Wrong]:
    """Return the mistakes in the sentences of an error, each with its place in the job."""
    found = []
    for line in str(error).split("\n  "):
        if _COUNT.fullmatch(line):
            continue
        match = _PLACE.fullmatch(line)
        known = match is not None and re.split(r"[. ]", match[1])[0] in Job.model_fields
        found.append(Wrong(match[1], match[2]) if match and known else Wrong("", line))
    return found
