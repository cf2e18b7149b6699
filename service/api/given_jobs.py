"""Jobs that came from clients, as problems."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

from ..jobs.allowed_quantities import LONGEST_ANSWER, bounded, parse_allowed
from .job_requests import require_no_file

if TYPE_CHECKING:
    from ...optimise.problem.problem import Problem


def given_problem(
    tables: Mapping[str, Any], allowed: Collection[str], values: Mapping[str, Any] | None = None
) -> Problem:
    """Return the problem that a job states.

    allowed: functions, "module:function", that it may name as quantities. values: numbers to put in place of those
    that it gives, by their paths. Raises `JobError`, also for a job that names a file.
    """
    require_no_file(tables)
    return bounded(parse_allowed(tables, allowed, values), LONGEST_ANSWER)
