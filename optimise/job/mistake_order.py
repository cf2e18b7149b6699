"""Order of the mistakes in a job, which follows its keys in the file."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from .mistake_messages import MOST, key_of_location


def first_mistakes(sentences: list[str], tables: Mapping[str, Any]) -> list[str]:
    """Return at most `MOST` sentences: the first ones in the order of the keys that they begin with."""
    if len(sentences) <= MOST:
        return sentences
    order = {key: place for place, key in enumerate(_keys_in_order(tables, ()))}

    def place(sentence: str) -> float:
        key = sentence.partition(": ")[0]
        while key and key not in order:
            key = key_above(key)
        return order.get(key, math.inf)

    return sorted(sentences, key=place)[:MOST]


def key_above(key: str) -> str:
    """Return the key of the table or list that contains a key, "" at the top level of the file."""
    return re.sub(r"(\.| #)?[^.#]*$", "", key)


def _keys_in_order(part: Any, path: tuple[object, ...]) -> Iterator[str]:
    entries = part.items() if isinstance(part, Mapping) else enumerate(part) if isinstance(part, list) else ()
    for step, entry in entries:
        yield key_of_location((*path, step))
        yield from _keys_in_order(entry, (*path, step))
