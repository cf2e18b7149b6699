"""A problem's quantities as a component for an OpenMDAO model."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...model.arrays import Array
from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.raw_numbers_of_designs import unit_of_number
from ..problem.problem import Problem, require_problem
from .missing_framework import missing_framework_error

if TYPE_CHECKING:
    from openmdao.api import ExplicitComponent
    from openmdao.vectors.default_vector import DefaultVector


def openmdao_component(problem: Problem, quantities: Sequence[str] | None = None) -> ExplicitComponent:
    """Return an `ExplicitComponent` that maps the numbers of one design to quantities in SI units.

    Inputs: crank, rod, offset, and the extra variables with underscores in place of dots (mechanism_slider_mass).
    Outputs: quantities by name; by default, the objectives and the constrained quantities. Partials are exact. A design
    that does not rotate fully has NaN outputs, which make some line searches fail: bound the model so that rod
    exceeds crank + |offset|. Raises `InputError` if OpenMDAO is not installed.
    """
    require_problem(problem, "openmdao_component")
    try:
        from openmdao.api import ExplicitComponent
    except ImportError as error:
        raise missing_framework_error("openmdao", error) from None
    if quantities is None:
        requested = [*(o.quantity for o in problem.objectives), *(c.quantity for c in problem.constraints)]
        quantities = list(dict.fromkeys(requested))
    names = list(quantities)
    varying = problem.mechanism.varying
    inputs = dict.fromkeys(DIMENSIONS, "m")
    inputs |= {re.sub(r"[^A-Za-z0-9]+", "_", item.name).strip("_"): unit_of_number(item.paths[0]) for item in varying}
    ranges = [problem.crank, problem.rod, problem.offset]
    starts = [0.5 * (ends.lower + ends.upper) for ends in ranges]
    starts += [0.5 * (item.lower + item.upper) for item in varying]
    problem.evaluate(np.zeros((1, len(starts))), names)  # raises errors early

    class SliderCrank(ExplicitComponent):  # type: ignore[misc]
        def setup(self) -> None:
            for (name, unit), start in zip(inputs.items(), starts, strict=True):
                self.add_input(name, val=start, units=_openmdao_unit(unit))
            for name in names:
                self.add_output(name, units=_openmdao_unit(problem.quantity(name).kind.unit))
            self.declare_partials("*", "*")

        def compute(self, inputs_: DefaultVector, outputs: DefaultVector) -> None:
            values = problem.evaluate(_design(inputs_), names)
            for name, value in zip(names, values, strict=True):
                outputs[name] = value

        def compute_partials(self, inputs_: DefaultVector, partials: dict[tuple[str, str], Array]) -> None:
            _, jacobian = problem.evaluate(_design(inputs_), names, gradients=True)
            for row, name in enumerate(names):
                for column, source in enumerate(inputs):
                    partials[name, source] = jacobian[row, column]

    def _design(vector: DefaultVector) -> list[float]:
        return [np.asarray(vector[name]).item() for name in inputs]

    return SliderCrank()


def _openmdao_unit(symbol: str) -> str | None:
    return symbol.replace("^", "**").replace(" ", "*") or None
