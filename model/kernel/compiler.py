"""Machine code of kernels, by numba: what is marked `analytic` is compiled into them.

Nothing imports this module before a kernel has to be compiled: numba takes as long to import as a job takes to run.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from numba import njit, typeof, types
from numba.extending import overload, register_jitable

from .arithmetic import FORMULAS, arcsine, inverse, magnitude, root
from .machine_code import MachineCode

# Without `nnan` and `ninf`: a NaN must stay a NaN. Contraction and reassociation are what vectorisation needs.
_OPTIONS: Any = {
    "fastmath": {"reassoc", "contract", "arcp", "nsz"},
    "error_model": "numpy",
    "no_cpython_wrapper": True,  # nobody calls them from outside
    "no_cfunc_wrapper": True,
}
_FORMULA: Any = _OPTIONS | {"forceinline": True}
_KERNEL: Any = _OPTIONS | {"nogil": True}

_known: list[Callable[..., Any]] = []


def know_formulas() -> None:
    """Tell numba of all formulas marked so far."""
    for formula in FORMULAS[len(_known) :]:
        register_jitable(**_FORMULA)(formula)
        _known.append(formula)


def compile_kernel(function: Callable[..., Any], examples: tuple[Any, ...]) -> MachineCode:
    """Return the machine code of a function for arguments like the examples, which decide about their types."""
    know_formulas()
    signature = tuple(map(typeof, examples))
    dispatcher: Any = njit(**_KERNEL)(function)
    dispatcher.compile(signature)
    compiled = dispatcher.overloads[signature]
    symbol = compiled.fndesc.llvm_func_name
    _, _, (code, _) = compiled.library.serialize_using_object_code()
    arguments = tuple(str(argument.type) for argument in compiled.library.get_function(symbol).arguments)
    functions = compiled.library.get_function(symbol).module.functions
    calls = tuple(each.name for each in functions if each.is_declaration and not each.name.startswith("llvm."))
    return MachineCode(symbol, arguments[2:], calls, code)


@overload(inverse, jit_options=_FORMULA)
def _inverse(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            q = 1.0 / z.real
            return complex(q, -z.imag * q * q)
    else:

        def compiled(z: Any) -> Any:
            return 1.0 / z

    return compiled


@overload(root, jit_options=_FORMULA)
def _root(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            q = math.sqrt(z.real)
            return complex(q, 0.5 * z.imag / q if q > 0.0 else 0.0)
    else:

        def compiled(z: Any) -> Any:
            return math.sqrt(z)

    return compiled


@overload(arcsine, jit_options=_FORMULA)
def _arcsine(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            return complex(math.asin(z.real), z.imag / math.sqrt(1.0 - z.real * z.real))
    else:

        def compiled(z: Any) -> Any:
            return math.asin(z)

    return compiled


@overload(magnitude, jit_options=_FORMULA)
def _magnitude(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            return -z if z.real < 0.0 else z
    else:

        def compiled(z: Any) -> Any:
            return abs(z)

    return compiled
