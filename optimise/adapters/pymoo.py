"""A problem for pymoo's algorithms."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...objectives.quantity import Array
from ..problem.problem import Problem
from .missing_framework import missing_framework_error
from .standard_form import standard_form

if TYPE_CHECKING:
    from pymoo.core.problem import Problem as PymooProblem

_FAR = 1e30
"""Replaces infinity, because pymoo scales by the greatest value."""


def pymoo_problem(problem: Problem, *, eliminate: bool = True, elimination_branch: int | None = None) -> PymooProblem:
    """Return a pymoo `Problem` that evaluates whole populations: F minimised, G <= 0, H = 0.

    eliminate: whether to eliminate equalities, see `standard_form`; genetic algorithms rarely meet them otherwise. The
    variables then range from 0 to 1; `found.form.designs(X)` gives the designs. elimination_branch: index of the
    solution branch if the equalities have several. Raises `InputError` if pymoo is not installed.
    """
    try:
        from pymoo.core.problem import Problem as PymooProblem
    except ImportError as error:
        raise missing_framework_error("pymoo", error) from None
    form = standard_form(problem, eliminate=eliminate, elimination_branch=elimination_branch)

    class SliderCrank(PymooProblem):  # type: ignore[misc]
        def __init__(self) -> None:
            super().__init__(
                n_var=len(form.names),
                n_obj=len(form.objectives),
                n_ieq_constr=len(form.inequalities),
                n_eq_constr=len(form.equalities),
                xl=form.lower,
                xu=form.upper,
            )
            self.form = form

        def __reduce__(self) -> tuple[object, ...]:
            rebuild = partial(pymoo_problem, eliminate=eliminate, elimination_branch=elimination_branch)
            return rebuild, (problem,)  # pickle cannot find a class inside a function by name

        def _evaluate(self, x: Array, out: dict[str, Array], *args: object, **options: object) -> None:
            arrays = form.arrays(x)
            out["F"], out["G"], out["H"] = (np.minimum(part, _FAR) for part in (arrays.F, arrays.G, arrays.H))

    return SliderCrank()
