"""Run named on the command line, and one of its designs: by number, or selected as in `front`."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError, SlidercrankError
from ...objectives.kinds import System
from ..designs.design_selection_options import require_single_choice
from ..designs.display_units import convert_result
from ..designs.selection import chosen_rows, no_match_message
from ..jobs.find_run import find_run
from ..runs.result import Result
from ..runs.run_folder import runs_folder
from ..runs.runs_on_disk import problem_of, read_run
from ..text.design_options import Pick
from .exit_and_interruption import NoDesigns, end_without_design

if TYPE_CHECKING:
    from ...optimise.front.front import ParetoFront


def folder_and_result(name: str, runs: Path | None) -> tuple[Path, Result]:
    """Return the folder and the result of a run. runs: folder of runs, as given."""
    folder = find_run(name, runs_folder(runs))
    return folder, read_run(folder)


def front_of_run(
    name: str, runs: Path | None, number: int | None = None, *, empty: bool = False
) -> tuple[Path, ParetoFront]:
    """Return the folder and the front of a run. empty: whether the front may be empty.

    Raises `InputError` if there is no design with this number, `NoDesigns` if there is none at all.
    """
    from ..designs.stored_designs import front_of

    folder, result = folder_and_result(name, runs)
    if not (result.designs or empty):
        raise NoDesigns(result)
    if number is not None:
        require_single_choice(number, result, has_other_choice=False)
    return folder, front_of(problem_of(folder, result), result)


def result_in_units(result: Result, units: System, folder: Path | None) -> Result:
    """Return the result of a run in the requested units.

    folder: folder of the run if trade-offs are shown, otherwise None.
    """
    problem = None
    if units != "metric" and folder is not None and result.trade_offs:
        with contextlib.suppress(SlidercrankError):  # its job is from another version
            problem = problem_of(folder, result)
    return convert_result(result, units, problem)


Where = Annotated[
    list[str] | None,
    typer.Option(
        metavar="CONDITION", help="Choose only among designs that meet this condition, as in `front`. May be repeated."
    ),
]


@dataclass(frozen=True)
class Choice(Pick):
    """Options that select one design of a run."""

    def design_number(self, result: Result, run: str, conditions: Sequence[str] | None) -> int:
        """Return the number of the design that the options select, counted from 1.

        Exits with code 3 if no design meets the conditions. Raises `NoDesigns` for an empty front, and `InputError` for
        an unknown number or unless exactly one selection is given.
        """
        if not result.designs:
            raise NoDesigns(result)
        if self.design is not None:
            require_single_choice(self.design, result, has_other_choice=bool(self.chooses_by_value or conditions))
            return self.design
        if not self.chooses_by_value:
            raise InputError("choose one design with --design NO, --knee, --topsis or --lexicographic; got none")
        row = self.row(result, chosen_rows(result, conditions or []))
        if row is None:
            end_without_design(no_match_message(result, conditions or []))
        return row + 1
