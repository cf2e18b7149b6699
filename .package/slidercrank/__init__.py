"""Sizes offset slider-crank mechanisms: from a machine's requirements to the Pareto front of designs.

State a problem
    problem              the tables of a job file as a dict: values with units, or numbers in SI
    load_job             a job file, .toml or .json
    job_schema           JSON Schema of a job: every key, with its meaning
    Problem              given values, variables, constraints and objectives
    Constraint           a quantity within bounds
    Objective            a quantity to minimise, to maximise or to bring to a target
    quantities           table of the quantities that both may use

Solve it
    solve                the Pareto front of a problem
    ParetoFront          designs as a table, picks, trade-offs
    Priority             one step of a pick by priorities
    like                 the design nearest to one on a front that meets further requirements
    wish                 the optimal design nearest to aspiration levels for the objectives

Evaluate designs
    evaluate             quantities of many designs of a machine, with derivatives (for a problem, `Problem.evaluate`)
    analyse              everything about one design of a machine (for a problem, `Problem.analyse`)
    Analysis             the quantities of a design, reasons for undefined quantities, the cycle as a table
    Mechanism            speed, masses, loads and tolerances of a machine
    Linkage              crank, rod, offset: closed-form results and motion, also for arrays and complex numbers
    crank_from_stroke    the crank that gives a stroke

Use other optimisers
    standard_form        bounds, objectives and requirements as arrays, with derivatives; `.scipy()` for scipy.optimize
    StandardForm         the result of `standard_form`
    jax_function, torch_function, openmdao_component, pymoo_problem, optuna_objective
                         a problem for these frameworks, each of which is an extra of the installation

Errors
    SlidercrankError     base of all errors: `InputError`, `AssemblyError`, `JobError`, ...
    InfeasibleError      a `JobError` for a valid job whose requirements no design can meet

Every name is imported on first use. Values are in SI and radians unless a name or a column carries a unit.
"""

from importlib import import_module
from typing import TYPE_CHECKING

__all__ = [
    "Analysis",
    "AssemblyError",
    "Constraint",
    "InfeasibleError",
    "InputError",
    "JobError",
    "Linkage",
    "Mechanism",
    "Objective",
    "ParetoFront",
    "Priority",
    "Problem",
    "SlidercrankError",
    "StandardForm",
    "__version__",
    "analyse",
    "crank_from_stroke",
    "evaluate",
    "jax_function",
    "job_schema",
    "like",
    "load_job",
    "openmdao_component",
    "optuna_objective",
    "problem",
    "pymoo_problem",
    "quantities",
    "solve",
    "standard_form",
    "torch_function",
    "wish",
]

if TYPE_CHECKING:
    from slidercrank.model.errors import AssemblyError, InfeasibleError, InputError, JobError, SlidercrankError
    from slidercrank.model.linkage.inverse_kinematics import crank_from_stroke
    from slidercrank.model.linkage.linkage import Linkage
    from slidercrank.model.machine.mechanism import Mechanism
    from slidercrank.objectives.tables.evaluate_quantities import evaluate
    from slidercrank.optimise.adapters.jax import jax_function
    from slidercrank.optimise.adapters.openmdao import openmdao_component
    from slidercrank.optimise.adapters.optuna import optuna_objective
    from slidercrank.optimise.adapters.pymoo import pymoo_problem
    from slidercrank.optimise.adapters.standard_form import StandardForm, standard_form
    from slidercrank.optimise.adapters.torch import torch_function
    from slidercrank.optimise.decisions.quantity_table import quantities
    from slidercrank.optimise.decisions.similar_design import like
    from slidercrank.optimise.decisions.wish import wish
    from slidercrank.optimise.front.choose_design import Priority
    from slidercrank.optimise.front.front import ParetoFront
    from slidercrank.optimise.job import job_schema, load_job
    from slidercrank.optimise.job.problem_from_tables import problem
    from slidercrank.optimise.problem.design_analysis import Analysis, analyse
    from slidercrank.optimise.problem.problem import Problem
    from slidercrank.optimise.problem.requirements import Constraint, Objective
    from slidercrank.optimise.solve import solve

    __version__: str
else:
    # Hidden from type checkers, which would accept every misspelt name.
    _HOMES = {
        "model.errors": ("AssemblyError", "InfeasibleError", "InputError", "JobError", "SlidercrankError"),
        "model.linkage.inverse_kinematics": ("crank_from_stroke",),
        "model.linkage.linkage": ("Linkage",),
        "model.machine.mechanism": ("Mechanism",),
        "optimise.adapters.jax": ("jax_function",),
        "optimise.adapters.openmdao": ("openmdao_component",),
        "optimise.adapters.optuna": ("optuna_objective",),
        "optimise.adapters.pymoo": ("pymoo_problem",),
        "optimise.adapters.standard_form": ("StandardForm", "standard_form"),
        "optimise.adapters.torch": ("torch_function",),
        "optimise.front.front": ("ParetoFront",),
        "optimise.front.choose_design": ("Priority",),
        "optimise.job": ("job_schema", "load_job"),
        "optimise.job.problem_from_tables": ("problem",),
        "optimise.problem.design_analysis": ("Analysis", "analyse"),
        "objectives.tables.evaluate_quantities": ("evaluate",),
        "optimise.problem.problem": ("Problem",),
        "optimise.problem.requirements": ("Constraint", "Objective"),
        "optimise.decisions.similar_design": ("like",),
        "optimise.decisions.quantity_table": ("quantities",),
        "optimise.decisions.wish": ("wish",),
        "optimise.solve": ("solve",),
    }

    def __getattr__(name):
        home = next((home for home, names in _HOMES.items() if name in names), None)
        if name == "__version__":
            from importlib.metadata import version

            value = version(__name__)
        elif home is not None:
            value = getattr(import_module(f".{home}", __name__), name)
        else:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return __all__
