"""Bookmarked designs of a run, with the decision if there is one, as listed in reports."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ...optimise.problem.problem import Problem
from ..designs.changed_design import judged_variation
from ..designs.design_selection_options import minimised_values
from ..designs.stored_designs import StoredDesign
from ..jobs.stores import has_store, open_store
from ..runs.result import Result
from .subject import Alternative

if TYPE_CHECKING:
    from ..store.bookmark import Bookmark


def alternatives_of(bookmarks: Iterable[Bookmark], problem: Problem, result: Result) -> list[Alternative]:
    """Return the bookmarked designs of a job, each evaluated against its requirements and ranges."""
    minimised, alternatives = minimised_values(result), []
    for bookmark in bookmarks:
        design = StoredDesign(problem.part(bookmark.variant), bookmark.dimensions, bookmark.variant)
        varied = judged_variation(design, result, minimised)
        alternatives.append(
            Alternative(bookmark=bookmark, row=varied.row, broken=varied.broken, outside=varied.outside)
        )
    return alternatives


def bookmarks_of_run(folder: Path) -> list[Bookmark]:
    """Return the bookmarks of a run on disk, from the store that solved it; none without such a store."""
    if not has_store(None, folder.parent):
        return []
    from ..store.bookmarks_and_wishes import bookmarks_of

    with open_store(None, folder.parent) as store:
        job = store.find_by_run(folder.name)
        return [] if job is None else bookmarks_of(store, job.id)
