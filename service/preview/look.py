"""A look at a job while it is being written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError
from .places import Wrong, places
from .possible import Possible, possible
from .sentences import said
from .stated import geometry, left_out

if TYPE_CHECKING:
    from ...optimise.problem import Problem


_MOST_VALUES = 5000
"""Values of a job that is read while it is written: each takes up to 30 us, and there is no end of tables of loads."""


class _TooLarge(Exception):
    """A job of more values than are read in a moment."""


@dataclass(frozen=True)
class Look:
    """wrong: what is wrong with the job, nothing if it can be solved. problem: of the whole job, if it is valid.

    stated, possible: what its dimensions state and allow; None while their ranges cannot be read. unchecked:
    requirements that were not looked at. said: sentences on what cannot be had. checked: whether the whole job was
    read; one with very many values is not, while it is written.
    """

    wrong: list[Wrong]
    problem: Problem | None
    stated: Problem | None
    possible: Possible | None
    unchecked: list[str]
    said: list[str]
    checked: bool = True


def look_at(tables: Mapping[str, Any], read: Callable[[Mapping[str, Any]], Problem]) -> Look:
    """Return what can be said of a job. read: gives its problem, or raises what is wrong with it."""
    if _count(tables) > _MOST_VALUES:
        read = _unread
    wrong: list[Wrong] = []
    whole, checked = None, True
    try:
        stated = geometry(tables, None)
    except InputError:
        stated = None
    beyond = None if stated is None else _beyond(stated)
    try:
        # It is said once; the rest of the job is checked without it.
        whole = read(tables if beyond is None else _without_time_ratio(tables))
        if beyond is None and stated is not None:
            stated = geometry(tables, whole)
    except _TooLarge:
        checked = False
    except InputError as error:
        wrong = places(error)
    if beyond is not None:
        wrong, whole = [beyond, *wrong], None
    if stated is None:
        return Look(wrong, whole, None, None, [], [], checked)
    found = possible(stated)
    return Look(
        wrong, whole, stated, found, [*left_out(tables, stated), *found.unchecked], said(stated, found), checked
    )


def _count(value: object) -> int:
    """Return how many values there are, counted no further than is needed."""
    left, count = [value], 0
    while left and count <= _MOST_VALUES:
        item = left.pop()
        if isinstance(item, Mapping | list):
            left += item.values() if isinstance(item, Mapping) else item
        else:
            count += 1
    return count


def _unread(_tables: Mapping[str, Any]) -> Problem:
    raise _TooLarge


def _beyond(stated: Problem) -> Wrong | None:
    """Return what is wrong if no linkage at all has the time ratio with the transmission angle that are asked."""
    from ...optimise.job.box import beyond_both

    sentence = beyond_both(stated)
    return None if sentence is None else Wrong("constraints.time_ratio", sentence)


def _without_time_ratio(tables: Mapping[str, Any]) -> dict[str, Any]:
    constraints = {name: item for name, item in tables["constraints"].items() if name != "time_ratio"}
    return {**tables, "constraints": constraints}
