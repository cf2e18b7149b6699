"""Subject of a report: one design of a run's result, all available data on both, and bookmarked alternatives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...objectives.kinds import System, column_key_in_system
from ...objectives.tables.measured_curves import Measured
from ...optimise.front.front import ParetoFront
from ...optimise.problem.problem import Problem
from ..designs.changed_design import Variation, judged_variation
from ..designs.design_selection_options import minimised_values
from ..designs.display_units import convert_record, convert_result, convert_row
from ..designs.judged_requirements import (
    Requirement,
    deviations_in_words,
    faults_in_words,
    requirements_of,
    violations_in_words,
    violations_of,
)
from ..designs.length_with_tolerance import format_toleranced, tolerances_of
from ..designs.stored_designs import StoredDesign, front_of_result, stored_design
from ..jobs.stores import has_store, open_store
from ..render.numerals import format_cell
from ..runs.result import Cell, Result, Row

if TYPE_CHECKING:
    from ..store.bookmark import Bookmark


@dataclass(frozen=True, kw_only=True)
class Alternative:
    """Bookmarked design, perhaps the chosen one. varied: its numbers and faults, metric."""

    bookmark: Bookmark
    varied: Variation

    def remarks(self, system: System) -> list[str]:
        """Return missed requirements, exceeded ranges and allowed deviations, in words."""
        row, design = self.varied.row, self.varied.design
        return [
            *faults_in_words(row, self.varied.broken, self.varied.outside),
            *deviations_in_words(requirements_of(design.part, design.allowed), row, system),
        ]


@dataclass(frozen=True)
class Subject:
    """One design of a run. metric: stored result. number: number of the design, from 1. run: name of the run.

    versions: versions of the software that computed the front. certificate: JSON answer of `slidercrank certify`, if it
    ran. known: front of the result, if already available. changed: the design with lengths other than on the front;
    None for the unchanged design. system: unit system of the report. measured: measured curves to compare with those of
    the design. alternatives: bookmarked designs of the run.
    """

    problem: Problem
    metric: Result
    number: int
    _: KW_ONLY
    run: str
    versions: Mapping[str, str]
    certificate: Mapping[str, Any] | None = None
    loaded_front: ParetoFront | None = None
    changed: Variation | None = None
    system: System = "metric"
    measured: Measured | None = None
    alternatives: Sequence[Alternative] = ()

    @cached_property
    def result(self) -> Result:
        """Result in the unit system of the report."""
        return convert_result(self.metric, self.system)

    @cached_property
    def front(self) -> ParetoFront:
        """Front with its problem."""
        return self.loaded_front or front_of_result(self.problem, self.metric)

    @cached_property
    def design(self) -> StoredDesign:
        """Machine and linkage. Raises `RunError` for a design that does not belong to the problem."""
        return self.changed.design if self.changed else stored_design(self.problem, self.metric, self.number)

    @cached_property
    def requirements(self) -> list[Requirement]:
        """Requirements of the job on the design, with the deviations that are allowed for it."""
        return requirements_of(self.design.part, self.design.allowed)

    @cached_property
    def deviations(self) -> list[str]:
        """Deviations within what is allowed, in words."""
        return deviations_in_words(self.requirements, self.metric_row, self.system)

    @cached_property
    def tolerances(self) -> dict[str, float]:
        """Tolerance of each dimension that has one, by column and in its unit."""
        tolerances_mm = tolerances_of(self.design.mechanism, self.design.linkage)
        keys = {name: column_key_in_system(f"{name}_mm", self.system) for name in tolerances_mm}
        return {key: factor * tolerances_mm[name] for name, (key, factor) in keys.items()}

    def format_cell(self, key: str, cell: Cell) -> str:
        """Return a cell as readable text: a dimension with the decimals of its tolerance, others with five digits."""
        if key not in self.tolerances or not isinstance(cell, float):
            return format_cell(cell)
        return format_toleranced(cell, self.tolerances[key]).partition(" ")[0].replace("-", "−")

    @property
    def row(self) -> Row:
        """All numbers of the design."""
        return (
            self.result.designs[self.number - 1] if self.changed is None else convert_row(self.changed.row, self.system)
        )

    @property
    def metric_row(self) -> Row:
        """All numbers of the design in metric units."""
        return self.metric.designs[self.number - 1] if self.changed is None else self.changed.row

    @cached_property
    def violation_sentences(self) -> list[str]:
        """Sentences on the allowable values that the design violates."""
        violated = convert_record(violations_of(self.design.mechanism, self.metric_row), self.system)
        return violations_in_words(violated, self.row)

    @cached_property
    def bookmark(self) -> Bookmark | None:
        """Bookmark of the design, if it has one."""
        of_design = (alternative.bookmark for alternative in self.alternatives)
        design = self.design
        return next((bookmark for bookmark in of_design if bookmark.is_of(design.variant, design.values)), None)

    @property
    def label(self) -> str:
        """Label of the design: the name of its bookmark, or its number."""
        if self.bookmark:
            return self.bookmark.name
        return f"design {self.number}" + ("" if self.changed is None else ", changed")

    @property
    def name(self) -> str:
        """Description of the design relative to the others."""
        if self.bookmark:
            return self.label
        return f"{self.label} of {len(self.result.designs)}" if self.changed is None else self.label


def alternatives_of(bookmarks: Iterable[Bookmark], problem: Problem, result: Result) -> list[Alternative]:
    """Return the bookmarked designs of a job, each evaluated against its requirements and ranges."""
    minimised, alternatives = minimised_values(result), []
    for bookmark in bookmarks:
        part = problem.part(bookmark.variant)
        design = StoredDesign(part, bookmark.dimensions, bookmark.variant, bookmark.allowed)
        alternatives.append(Alternative(bookmark=bookmark, varied=judged_variation(design, result, minimised)))
    return alternatives


def bookmarks_of_run(folder: Path) -> list[Bookmark]:
    """Return the bookmarks of a run on disk, from the store that solved it; none without such a store."""
    if not has_store(None, folder.parent):
        return []
    from ..store.bookmarks_and_wishes import bookmarks_of

    with open_store(None, folder.parent) as store:
        job = store.find_by_run(folder.name)
        return [] if job is None else bookmarks_of(store, job.id)
