"""What a report is about: one design of the result of a run, with all that is known of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...objectives.kinds import System
from ..designs.shown_units import result_in
from ..designs.stored_designs import StoredDesign, design_of, front_of
from ..runs.result import Result, Row

if TYPE_CHECKING:
    from ...optimise.front import ParetoFront
    from ...optimise.problem import Problem


@dataclass(frozen=True)
class Subject:
    """One design of a run. number: of the design, from 1. run: what the run is called.

    result: in the units of the system.
    versions: of what computed the front. certificate: what `slidercrank certify` found, as its JSON has it, if it ran.
    """

    result: Result
    number: int
    run: str
    problem: Problem
    front: ParetoFront
    design: StoredDesign
    versions: Mapping[str, str]
    certificate: Mapping[str, Any] | None = None
    system: System = "metric"

    @property
    def row(self) -> Row:
        """All numbers of the design."""
        return self.result.designs[self.number - 1]

    @property
    def name(self) -> str:
        """The design among the others."""
        return f"design {self.number} of {len(self.result.designs)}"


def subject_of(
    problem: Problem,
    result: Result,
    number: int,
    *,
    run: str,
    versions: Mapping[str, str],
    certificate: Mapping[str, Any] | None = None,
    front: ParetoFront | None = None,
    system: System = "metric",
) -> Subject:
    """Return the subject of a report. front: of the result, where there is one already. system: of its units.

    Raises `RunError` for a design that does not belong to the problem.
    """
    return Subject(
        result=result_in(result, system),
        number=number,
        run=run,
        problem=problem,
        front=front_of(problem, result) if front is None else front,
        design=design_of(problem, result.designs[number - 1]),
        versions=versions,
        certificate=certificate,
        system=system,
    )
