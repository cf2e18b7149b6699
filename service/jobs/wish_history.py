"""Wishes that were made of a run, wherever they were made: those of its job in the store of its place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from .stores import has_store, open_store

if TYPE_CHECKING:
    from ...optimise.decisions.wishes import Wish
    from ...optimise.front.front import ParetoFront
    from ..store import Store
    from ..store.wishes import MadeWish, Wished


def told_wishes(front: ParetoFront, wishes: Sequence[Wish]) -> dict[str, tuple[str, float | None]]:
    """Return wishes by their objectives, free ones left out, with values in the metric units of these."""
    told: dict[str, tuple[str, float | None]] = {}
    for objective, wish in zip(front.objectives, wishes, strict=True):
        factor = front.problem.quantity(objective.quantity).unit.factor
        if wish.kind != "free":
            told[objective.quantity] = (wish.kind, None if wish.value is None else wish.value * factor)
    return told


def words_of(front: ParetoFront, told: Wished) -> dict[str, str]:
    """Return wishes of `told_wishes` as they are asked for: "110 N m", "improve", "may worsen to 40 deg"."""
    words = {}
    for name, (kind, value) in told.items():
        unit = front.problem.quantity(name).unit.symbol
        number = "" if value is None else f"{value!r} {unit}".rstrip()
        words[name] = {"value": number, "limit": f"may worsen to {number}"}.get(kind, kind)
    return words


def wishes_of_run(folder: Path) -> list[MadeWish]:
    """Return the wishes that were made of the run of a folder, the latest first; none of a run without a job."""
    from ..store.wishes import wishes_of

    with _job(folder) as found:
        return wishes_of(*found) if found else []


def keep_wish(folder: Path, given: Wished, design: int | None) -> bool:
    """Note a wish among those of the run of a folder; return whether it has a job that keeps it."""
    from ..store.wishes import note_wish

    with _job(folder) as found:
        if found:
            note_wish(*found, given, design)
        return found is not None


@contextmanager
def _job(folder: Path) -> Iterator[tuple[Store, int] | None]:
    """Enter the store that lists the run of a folder, with the number of its job."""
    place = folder.resolve().parent
    if not has_store(None, place):
        yield None
        return
    with open_store(None, place) as store:
        job = store.find(folder.resolve().name)
        yield None if job is None else (store, job.id)
