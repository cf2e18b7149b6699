"""Problems stated in Python: the tables of a job file as a dict, with custom functions as objects."""

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np

from ...model.errors import JobError
from ...objectives.own.function_process import Function
from ...objectives.own.quantity import OwnQuantity
from ...objectives.quantity import Quantity
from ..problem.problem import Problem
from . import parse_job, warn_of_problem, with_file_contents


def problem(
    tables: Mapping[str, object], *, folder: str | PathLike[str] | None = None, require_feasible: bool = True
) -> Problem:
    """Return the problem that the tables of a job file state, given as a dict.

    Values are strings with a unit ("80 mm"), or numbers in SI (0.08); NumPy numbers and arrays are allowed. The
    function of a table [quantity.NAME] may be a Python function instead of the text "module:function"; it then runs in
    this process, without a time limit. folder: folder with the files that the tables name, such as catalogues; by
    default the working directory; modules named by text may be in either. require_feasible: as for `load_job`. Issues
    warnings, and raises `JobError`, naming key, rule, value and remedy, like `load_job`.

    >>> from slidercrank import problem
    >>> found = problem(
    ...     {
    ...         "name": "Feeder",
    ...         "mechanism": {"speed": "300 rpm", "slider": {"mass": "0.8 kg"}},
    ...         "variables": {"crank": ["20 mm", "60 mm"], "rod": [0.05, 0.25], "offset": [0.0, 0.08]},
    ...         "objectives": {"peak_torque": "minimise", "transmission_angle": "maximise"},
    ...     }
    ... )
    >>> found.rod
    Range(lower=0.05, upper=0.25)
    """
    functions: dict[str, Function] = {}
    if not isinstance(tables, Mapping):
        raise JobError(f"a job must be a dict of tables; got {type(tables).__name__}; for a file use load_job")
    try:
        data = {key: _plain_copy(item) for key, item in tables.items()}
    except RecursionError:
        raise JobError("a job must be a dict of tables; got one that contains itself, or endless tables") from None
    quantity_tables = data.get("quantity")
    if isinstance(quantity_tables, dict):
        for name, part in quantity_tables.items():
            if isinstance(part, dict) and callable(part.get("function")):
                functions[name] = part["function"]
                part["function"] = "given:function"  # a placeholder name for the validation
    stated_problem = parse_job(
        with_file_contents(data, Path() if folder is None else Path(folder)),
        folder=None if folder is None else Path(folder),
        require_feasible=require_feasible,
    )
    warn_of_problem(stated_problem)
    return (
        replace(stated_problem, own=tuple(_with_functions(item, functions) for item in stated_problem.own))
        if functions
        else stated_problem
    )


def _with_functions(item: Quantity, functions: Mapping[str, Function]) -> Quantity:
    if isinstance(item, OwnQuantity) and item.name in functions:
        return replace(item, function=functions[item.name])
    return item.with_parts(tuple(_with_functions(part, functions) for part in item.component_quantities))


def _plain_copy(value: object) -> object:
    """Return tables and lists as copies with plain Python dicts, lists and numbers."""
    if isinstance(value, Mapping):
        return {key: _plain_copy(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain_copy(item) for item in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value
