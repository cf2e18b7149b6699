"""Wishes for the front of a run, stored with its job."""

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
    from ..store.bookmarks_and_wishes import MadeWish, Wished


def wishes_by_objective(front: ParetoFront, wishes: Sequence[Wish]) -> dict[str, tuple[str, float | None]]:
    """Return wishes by objective, except free ones, with values in the metric units of the objectives."""
    stated: dict[str, tuple[str, float | None]] = {}
    for objective, wish in zip(front.objectives, wishes, strict=True):
        factor = front.problem.quantity(objective.quantity).unit.factor
        if wish.kind != "free":
            stated[objective.quantity] = (wish.kind, None if wish.value is None else wish.value * factor)
    return stated


def wishes_as_entered(front: ParetoFront, stated: Wished) -> dict[str, str]:
    """Return wishes of `wishes_by_objective` as people enter them: "110 N m", "improve", "may worsen to 40 deg"."""
    words = {}
    for name, (kind, value) in stated.items():
        unit = front.problem.quantity(name).unit.symbol
        number = "" if value is None else f"{value!r} {unit}".rstrip()
        words[name] = {"value": number, "limit": f"may worsen to {number}"}.get(kind, kind)
    return words


def wishes_of_run(folder: Path) -> list[MadeWish]:
    """Return the wishes for the run in a folder, newest first; none for a run without a job."""
    from ..store.bookmarks_and_wishes import wishes_of

    with _store_and_job(folder) as store_and_job:
        return wishes_of(*store_and_job) if store_and_job else []


def record_wish(folder: Path, wishes: Wished, design: int | None) -> bool:
    """Record a wish for the run in a folder. Return whether the run has a job to store it with."""
    from ..store.bookmarks_and_wishes import note_wish

    with _store_and_job(folder) as store_and_job:
        if store_and_job:
            note_wish(*store_and_job, wishes, design)
        return store_and_job is not None


@contextmanager
def _store_and_job(folder: Path) -> Iterator[tuple[Store, int] | None]:
    """Yield the store that lists the run in a folder, with the number of its job."""
    place = folder.resolve().parent
    if not has_store(None, place):
        yield None
        return
    with open_store(None, place) as store:
        job = store.find_by_run(folder.resolve().name)
        yield None if job is None else (store, job.id)
