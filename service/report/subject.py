"""Subject of a report: one design of the result of a run, with all that is known of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...objectives.kinds import System
from ...objectives.tables.measured import Measured
from ...optimise.front.front import ParetoFront
from ...optimise.problem.problem import Problem
from ..designs.shown_units import result_in, row_in
from ..designs.stored_designs import StoredDesign, front_of, stored_design
from ..designs.variation import Variation
from ..runs.result import Result, Row


@dataclass(frozen=True)
class Subject:
    """One design of a run. number: of the design, from 1. run: what the run is called.

    result: in the units of the system.
    versions: of what computed the front. certificate: what `slidercrank certify` found, as its JSON has it, if it ran.
    changed: the design with other lengths than it has in the front; None for the design as it is. measured: curves to
    put beside those of the design.
    """

    result: Result
    number: int
    run: str
    problem: Problem
    front: ParetoFront
    design: StoredDesign
    versions: Mapping[str, str]
    certificate: Mapping[str, Any] | None = None
    changed: Variation | None = None
    system: System = "metric"
    measured: Measured | None = None

    @property
    def row(self) -> Row:
        """All numbers of the design."""
        return self.result.designs[self.number - 1] if self.changed is None else row_in(self.changed.row, self.system)

    @property
    def label(self) -> str:
        """The design by its number."""
        return f"design {self.number}" + ("" if self.changed is None else ", changed")

    @property
    def name(self) -> str:
        """The design among the others."""
        return f"{self.label} of {len(self.result.designs)}" if self.changed is None else self.label


def subject_of(
    problem: Problem,
    result: Result,
    number: int,
    *,
    run: str,
    versions: Mapping[str, str],
    certificate: Mapping[str, Any] | None = None,
    front: ParetoFront | None = None,
    changed: Variation | None = None,
    system: System = "metric",
) -> Subject:
    """Return the subject of a report.

    front: of the result, where there is one already. changed: the design with other lengths, if it has others. system:
    of the units of the report.

    Raises `RunError` for a design that does not belong to the problem.
    """
    return Subject(
        result=result_in(result, system),
        number=number,
        run=run,
        problem=problem,
        front=front_of(problem, result) if front is None else front,
        design=stored_design(problem, result, number) if changed is None else changed.design,
        versions=versions,
        certificate=certificate,
        changed=changed,
        system=system,
    )
