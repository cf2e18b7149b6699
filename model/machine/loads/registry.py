"""Every kind of load declared by a module in this package, and the compiled choice among their formulas."""

import pkgutil
from functools import cache
from importlib import import_module
from typing import Any

from ...kernel.arithmetic import analytic
from .load import Enters, Load


@cache
def load_classes() -> tuple[type[Load], ...]:
    """Return all kinds of load in the order of `Enters`; those with a formula by the name of their module."""
    package = import_module(__package__)
    modules = sorted(module.name for module in pkgutil.iter_modules(package.__path__, f"{__package__}."))
    declared = [
        value
        for name in modules
        for value in vars(import_module(name)).values()
        if isinstance(value, type) and issubclass(value, Load) and value is not Load
    ]
    return tuple(sorted(dict.fromkeys(declared), key=lambda kind: kind.enters))


def kernel_code_of_load(kind: type[Load]) -> int:
    """Return the number that identifies a kind of load in kernels."""
    return load_classes().index(kind) if kind.enters == Enters.FORMULA else int(kind.enters)


def _combined_formula() -> Any:
    """Return the combined formula for all kinds that have one: arguments are the code, then those of `Load.formula`.

    It is composed when kernels are compiled and is inlined into them, without a call at run time.
    """

    @analytic
    def chosen(code: Any, position: Any, velocity: Any, way: Any, first: Any, second: Any) -> Any:
        return 0.0 * velocity

    for kind in load_classes():
        if kind.formula is not None:
            chosen = _choose_formula(kernel_code_of_load(kind), kind.formula, chosen)
    return chosen


def _choose_formula(load_code: int, formula: Any, otherwise: Any) -> Any:
    @analytic
    def chosen(code: Any, position: Any, velocity: Any, way: Any, first: Any, second: Any) -> Any:
        if code == load_code:
            return formula(position, velocity, way, first, second)
        return otherwise(code, position, velocity, way, first, second)

    return chosen


force_of: Any = _combined_formula()
