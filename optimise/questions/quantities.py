"""List of the quantities that objectives and constraints may name."""

from __future__ import annotations

import pandas as pd

from ...objectives.quantity import Quantity
from ...objectives.registry import FACTS
from ..problem.problem import Problem, require_problem


def quantities(problem: Problem | None = None) -> pd.DataFrame:
    """Return a table of quantities by name: title, unit as shown, column in tables of designs, what they need of a job.

    problem: adds its own. In Python values are in SI; `factor` is what one SI unit is in the unit that is shown. needs:
    empty for what every job has.

    >>> from slidercrank import quantities
    >>> quantities().loc["peak_torque", "title"]
    'peak torque'
    """
    if problem is not None:
        require_problem(problem, "quantities")
    known = (*FACTS.values(), *(problem.own if problem else ()))
    rows = {
        item.name: {
            "title": item.title,
            "unit": item.unit.symbol,
            "factor": item.unit.factor,
            "column": item.field,
            "needs": _needs(item),
        }
        for item in known
    }
    return pd.DataFrame.from_dict(rows, orient="index")


def _needs(of: Quantity) -> str:
    table = [f"it comes from the table [{of.table}]"] if of.table else []
    return "; ".join(dict.fromkeys([*table, *(need.rule for need in of.needs)]))
