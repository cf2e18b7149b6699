"""Sizes offset slider-crank mechanisms: from what a machine must do to the Pareto front of designs.

`Linkage` is one linkage or an array of them, `load_job` reads a job file, `solve` finds its Pareto
front. Each is imported when it is first used, so that `slidercrank --help` does not wait for numba
and pandas.

>>> from slidercrank import Linkage, load_job, solve
"""

from importlib import import_module
from typing import TYPE_CHECKING

__all__ = ["Linkage", "__version__", "load_job", "solve"]

if TYPE_CHECKING:
    from slidercrank.model.linkage.linkage import Linkage
    from slidercrank.optimise.job import load_job
    from slidercrank.optimise.solve import solve

    __version__: str
else:
    # Not shown to type checkers: they would take every misspelt name for a known one.
    _HOMES = {"Linkage": "model.linkage.linkage", "load_job": "optimise.job", "solve": "optimise.solve"}

    def __getattr__(name):
        if name == "__version__":
            from importlib.metadata import version

            value = version(__name__)
        elif name in _HOMES:
            value = getattr(import_module(f".{_HOMES[name]}", __name__), name)
        else:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return __all__
