"""List of the quantities that objectives and constraints may name."""

from __future__ import annotations

import pandas as pd

from ...objectives.registry import QUANTITIES
from ..problem.problem import Problem, require_problem


def quantities(problem: Problem | None = None) -> pd.DataFrame:
    """Return a table of quantities by name: title, unit as shown, column in tables of designs.

    problem: adds its own. In Python values are in SI; `factor` is what one SI unit is in the unit that is shown.

    >>> from slidercrank import quantities
    >>> quantities().loc["peak_torque", "title"]
    'peak torque'
    """
    if problem is not None:
        require_problem(problem, "quantities")
    known = (*QUANTITIES.values(), *(problem.own if problem else ()))
    rows = {
        item.name: {
            "title": item.title,
            "unit": item.unit.symbol,
            "factor": item.unit.factor,
            "column": item.field,
        }
        for item in known
    }
    return pd.DataFrame.from_dict(rows, orient="index")
