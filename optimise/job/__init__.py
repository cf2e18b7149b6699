"""Job files: an engineer's specification, read, checked and converted to a `Problem`.

`load_job` reads a file (TOML or JSON), `parse_job` reads the same content as a dict, `job_schema` describes it.
"""

import contextlib
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping
from copy import deepcopy
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ...model.errors import InfeasibleError, InputError, InputWarning, JobError
from ...model.file_name_encoding import path_from_text, path_text
from ...objectives.units import quoted_if_unprintable
from ..problem.problem import Problem
from .catalogue import catalogue_files, with_catalogues, with_options
from .crank_speed import speed_profile_file, with_speed_points
from .custom_quantities import declared_quantities, function_module_files
from .drive import motor_torque_warnings
from .job_file import LARGEST, read_job_file, require_few_values_and_no_nulls
from .loads import names_of_load_files, with_load_points
from .mistake_messages import LONGEST, MOST, sentences_on_mistakes
from .model import Job, job_type_with_quantities, schema_of
from .named_files import Files
from .plain_numbers import (
    PlainNumbers,
    first_mistakes,
    formula_bounds_without_unit,
    numbers_without_unit,
    read_and_note_plain_numbers,
)
from .problem_of_job import problem_of
from .target_motion import target_motion_file, with_target_motion
from .toml_errors import with_line_numbers
from .variables_and_variants import with_values_at_paths

__all__ = ["Job", "job_schema", "load_job", "needed_files", "parse_job", "read_job", "with_files"]


def load_job(
    path: str | PathLike[str],
    values: Mapping[str, Any] | None = None,
    *,
    allow_user_code: bool = True,
    require_feasible: bool = True,
) -> Problem:
    """Return the problem that a job file (.toml or .json) states.

    values: numbers that replace those in the file, by path ("mechanism.slider.mass"). allow_user_code: whether a job
    may name Python functions ([quantity]); they run when the problem is solved, with all the user's rights. Set it to
    False for other people's jobs. require_feasible: whether to raise an error for an infeasible job. A search
    requires this; the analysis of a given design does not. A minimum above the maximum of the same formula always
    raises an error.

    Issues an `InputWarning` for probable mistakes, such as a number without a unit; the problem's `warnings` has the
    sentences. Raises JobError, naming file, key, rule, value and remedy, for a file that cannot be read, violates the
    schema or contradicts itself. Raises its subclass `InfeasibleError` if no design can meet it.
    """
    if not isinstance(path, str | PathLike):
        raise JobError(f"a job file must be given by its path; got {type(path).__name__}; for tables use problem")
    data = read_job(path)
    with _prefix_errors_with_file(path):
        problem = parse_job(
            data,
            values,
            folder=path_from_text(path).parent,
            allow_user_code=allow_user_code,
            require_feasible=require_feasible,
        )
    warn_of_problem(problem)
    return problem


def warn_of_problem(problem: Problem) -> None:
    """Issue a Python warning for each warning of a problem, attributed to the caller's caller.

    Also warn about loads that drive it, or that are stated for more than the whole stroke, about loaded strokes that
    are fast in every design, and about offsets that a slow stroke excludes.
    """
    from ..search.driving_load_warnings import driving_load_warnings
    from ..search.stroke_warnings import overlong_part_warnings, stroke_warnings

    sentences = [*driving_load_warnings(problem), *overlong_part_warnings(problem)]
    for sentence in (*problem.warnings, *sentences, *stroke_warnings(problem, certain=True)):
        warnings.warn(sentence, InputWarning, stacklevel=3)


def read_job(path: str | PathLike[str]) -> dict[str, Any]:
    """Return the unchecked tables of a job file, with points and options from the files that it names.

    Raises JobError for an unreadable file.
    """
    with _prefix_errors_with_file(path):
        file = path_from_text(path)
        return with_file_contents(read_job_file(file), file.parent)


def with_file_contents(data: Mapping[str, Any], files: Files) -> dict[str, Any]:
    """Return a job with the contents of the files that it names in place of their names. Raises JobError.

    files: the folder that contains them, or their contents by name, as text or as bytes.
    """
    try:
        return with_catalogues(
            with_speed_points(with_load_points(with_target_motion(data, files), files), files), files
        )
    except JobError:
        raise
    except InputError as error:
        raise JobError(str(error)) from None


@contextlib.contextmanager
def _prefix_errors_with_file(path: str | PathLike[str]) -> Iterator[None]:
    try:
        yield
    except JobError as error:
        name, file, message = path_text(path), path_from_text(path), str(error)
        with contextlib.suppress(OSError, ValueError):
            if file.suffix.casefold() == ".toml" and file.is_file() and file.stat().st_size <= LARGEST:
                message = with_line_numbers(message, file.read_text(encoding="utf-8-sig"))
        error.args = (f"{quoted_if_unprintable(name)}: {message}",)
        raise error from None


def needed_files(path: str | PathLike[str]) -> list[Path]:
    """Return the files beside a job file that it needs: tables, and modules with its custom functions."""
    file = path_from_text(path)
    data, folder = read_job_file(file), file.parent
    files = [
        name
        for name in (
            target_motion_file(data),
            speed_profile_file(data),
            *names_of_load_files(data),
            *catalogue_files(data),
        )
        if name
    ]
    return [*(folder / path_from_text(name) for name in dict.fromkeys(files)), *function_module_files(data, folder)]


def parse_job(
    data: Mapping[str, Any],
    values: Mapping[str, Any] | None = None,
    *,
    folder: Path | None = None,
    allow_user_code: bool = True,
    require_feasible: bool = True,
) -> Problem:
    """Return the problem stated by a job that is given as the tables of a job file. Raises JobError like `load_job`.

    folder: a folder with the modules of its custom functions, besides the working directory. Other arguments are those
    of `load_job`.
    """
    require_few_values_and_no_nulls(data)
    data, _ = with_options(data)
    custom = declared_quantities(data, allowed=allow_user_code)
    job = job_type_with_quantities(custom)
    doubts: list[PlainNumbers] = []
    try:
        stated, doubts = read_and_note_plain_numbers(job, data, values)
        stated = with_values_at_paths(stated, values, "values") if values else stated
        problem = problem_of(stated, folder=folder, installed=custom.installed, require_feasible=require_feasible)
        doubts += formula_bounds_without_unit(problem, data)
        sentences = [] if stated.choice else motor_torque_warnings(problem.mechanism, data)
        warned = tuple(dict.fromkeys([*(item.warning_text for item in doubts if item.warning_text), *sentences]))
        return replace(problem, warnings=warned) if warned else problem
    except ValidationError as error:
        doubts = numbers_without_unit(job, data)
        sentences = [
            _with_unit_warnings(sentence, doubts) for sentence in sentences_on_mistakes(error, schema_of(job), data)
        ]
        count = f"{len(sentences)} problems" if len(sentences) < LONGEST else "very many problems"
        heading = [count] if len(sentences) > 1 else []
        overflow = ["... and more"] if len(sentences) > MOST else []
        raise JobError("\n  ".join([*heading, *first_mistakes(sentences, data), *overflow])) from None
    except InputError as error:  # a number meant in another unit is a likely cause
        if isinstance(error, InfeasibleError) and isinstance(error.problem, Problem):
            doubts += formula_bounds_without_unit(error.problem, data)
        text = _with_unit_warnings(str(error), doubts, everywhere=isinstance(error, InfeasibleError))
        if not isinstance(error, JobError):
            raise JobError(text) from None
        error.args = (text,)
        raise


def _with_unit_warnings(sentence: str, doubts: Iterable[PlainNumbers], *, everywhere: bool = False) -> str:
    """Return an error message with the plain-number warnings that may be its cause, after its key.

    everywhere: whether warnings at other keys may also be causes.
    """
    place = re.match(r"[a-z_][^:;=]*(?=: )", sentence)
    key = place[0] if place else ""
    likely_causes = [
        item.warning_text for item in doubts if item.warning_text and (everywhere or not key or item.is_at_key(key))
    ]
    rest = sentence[len(key) :].removeprefix(": ")
    return (f"{key}: " if key else "") + "; ".join((*dict.fromkeys(likely_causes), rest))


def job_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a job, with a description and examples for every key."""
    return deepcopy(schema_of(Job))
