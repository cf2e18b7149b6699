"""Designs on the command line: by dimensions, with or without a job, or from a run as in `front`."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from ...model.errors import InputError, SlidercrankError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import System
from ..designs.design_selection_options import require_single_choice
from ..designs.display_units import convert_result
from ..designs.rotating_crank import require_rotating_crank
from ..designs.selection import no_match_message, plain_number, rows_meeting_conditions
from ..jobs.stores import find_run
from ..runs.result import Result
from ..runs.run_folder import runs_folder
from ..runs.runs_on_disk import problem_of, read_run
from ..text.options import Dimensions, Pick
from .exit_and_interruption import NoDesigns, exit_without_design

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...optimise.front.front import ParetoFront
    from ...optimise.problem.problem import Problem
    from ..designs.stored_designs import StoredDesign


class Machine(NamedTuple):
    """Machine and linkage named on the command line, and the problem of the job or run, if any."""

    mechanism: Mechanism
    linkage: Linkage
    problem: Problem | None


def machine_from_arguments(
    command: str,
    job: Path | None,
    size: Dimensions,
    design: int | None,
    runs: Path | None,
    *,
    replaced_values: Sequence[str] = (),
    turning: bool = False,
) -> Machine:
    """Return the machine for given dimensions, optionally with a job, or for a design of a run.

    command: its name in messages. replaced_values: "PATH=VALUE" replacements for numbers in the job. turning: whether
    to reject a swinging crank. Without a job all parts are massless.
    """
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

    if design is not None:
        lengths = {name: getattr(size, name) for name in DIMENSIONS}
        stored = design_of_run(command, job, design, runs, {**lengths, "set": replaced_values or None})
        if turning:
            require_rotating_crank(stored.part.motion, command)
        return Machine(stored.mechanism, stored.linkage, stored.part)
    problem = problem_of_job(job, replaced_values)
    if turning and problem is not None:
        require_rotating_crank(problem.motion, command)
    mechanism = Mechanism() if problem is None else problem.mechanism.nominal
    crank, rod, offset = size.lengths(problem)
    return Machine(mechanism, Linkage(crank, rod, offset, mechanism.branch), problem)


def rotating_problem(job: Path, command: str) -> Problem:
    """Return the problem of a job file for the analysis of a given design; the job need not be feasible.

    Raises `InputError` for a swinging crank, phrased for a command.
    """
    from ...optimise.job import load_job

    problem = load_job(job, require_feasible=False)
    require_rotating_crank(problem.motion, command)
    return problem


def problem_of_job(job: Path | None, replaced_values: Sequence[str] = ()) -> Problem | None:
    """Return the problem of a job file after "PATH=VALUE" replacements of numbers; None if there is no job.

    The job need not be feasible, as the design to analyse is given.
    """
    if job is None:
        if replaced_values:
            raise InputError("--set changes a number in a job; got no job; give a JOB")
        return None
    if not job.suffix and not job.is_file():
        raise InputError(f"the job file {job} does not exist; correct its name, or add --design N if it is a run")
    from ...optimise.job import load_job

    values: dict[str, str | float] = {}
    for text in replaced_values:
        path, sign, value = (part.strip() for part in text.partition("="))
        if not (path and sign and value):
            raise InputError(f'--set must look like "mechanism.slider.mass=1.2 kg"; got {text!r}; correct it')
        number = plain_number(value)
        values[path] = value if number is None else number
    return load_job(job, values, require_feasible=False)


def design_of_run(
    command: str, run: Path | None, design: int, place: Path | None, options: Mapping[str, object]
) -> StoredDesign:
    """Return a design of a run. Raises `InputError` if there is no run, or if dimensions are given too.

    command: name of the command, for messages. place: folder of runs. options: options that conflict with the design.
    """
    from ..designs.stored_designs import stored_design

    if run is None:
        raise InputError(f"--design needs a run; got none; name it: slidercrank {command} RUN --design NO")
    besides = [f"--{name}" for name, value in options.items() if value is not None]
    if besides:
        raise InputError(
            f"dimensions must not be given with --design, whose design has its own; got --design and {besides[0]}; "
            "leave out one of the two"
        )
    folder, result = folder_and_result(str(run), place)
    if not result.designs:
        raise NoDesigns(result)
    require_single_choice(design, result, has_other_choice=False)
    return stored_design(problem_of(folder, result), result, design)


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
    from ..designs.stored_designs import front_of_result

    folder, result = folder_and_result(name, runs)
    if not (result.designs or empty):
        raise NoDesigns(result)
    if number is not None:
        require_single_choice(number, result, has_other_choice=False)
    return folder, front_of_result(problem_of(folder, result), result)


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

    def selected_design_number(self, result: Result, run: str, conditions: Sequence[str] | None) -> int:
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
        row = self.row(result, rows_meeting_conditions(result, conditions or []))
        if row is None:
            exit_without_design(no_match_message(result, conditions or []))
        return row + 1
