"""Table of the quantities that objectives and constraints may name."""

import pandas as pd

from ...objectives.registry import FACTS
from ..problem.problem import Problem, require_problem


def quantities(problem: Problem | None = None) -> pd.DataFrame:
    """Return a table of quantities by name: title, display unit, column in tables of designs, better side, needs.

    problem: adds its custom quantities. Python values are in SI; `factor` converts SI to the display unit. better: the
    side that requirements usually prefer, low or high; empty if there is none. needs: required contents of a job; empty
    if every job has them.

    >>> from slidercrank import quantities
    >>> quantities().loc["peak_torque", "title"]
    'peak torque'
    """
    if problem is not None:
        require_problem(problem, "quantities")
    listed = (*FACTS.values(), *(problem.own if problem else ()))
    rows = {
        item.name: {
            "title": item.title,
            "unit": item.unit.symbol,
            "factor": item.unit.factor,
            "column": item.field,
            "better": item.better,
            "needs": item.job_requirements_text,
        }
        for item in listed
    }
    return pd.DataFrame.from_dict(rows, orient="index")
