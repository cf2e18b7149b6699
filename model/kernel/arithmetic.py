"""Arithmetic that runs the same formula on reals, complex numbers and NumPy arrays.

A physical formula is written once, as a plain Python function marked `analytic`. Called from Python it broadcasts
like any NumPy expression; called from a compiled kernel it is compiled into it. Evaluated at `x + i h` with
`h = STEP = 1e-30` its imaginary part divided by `h` is the derivative, exact to rounding, because no difference of
close numbers is taken (Squire and Trapp, SIAM Review 40(1), 1998, pp. 110-112).

The three functions here keep only the first power of the imaginary part. With `h = 1e-30` the dropped second power
(1e-60) is far below rounding, and without the branches of the general complex functions the compiler turns loops
over designs into vector instructions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit, types
from numba.extending import overload, register_jitable

from .cache import KernelCache
from .folder import kernel_folder

Function = TypeVar("Function", bound=Callable[..., Any])

STEP = 1e-30
"""Length of the imaginary step of the complex-step derivative."""

# Without `nnan` and `ninf`: a NaN must stay a NaN. Contraction and reassociation are what vectorisation needs.
_OPTIONS: Any = {"fastmath": {"reassoc", "contract", "arcp", "nsz"}, "error_model": "numpy", "forceinline": True}

_CALLED: Any = _OPTIONS | {"forceinline": False, "no_cfunc_wrapper": True}

analytic: Callable[[Function], Function] = register_jitable(**_OPTIONS)
"""Marks a formula that runs on floats, complex numbers and arrays from Python, and inline in compiled kernels."""

inlined: Callable[[Function], Function] = analytic
"""Marks a step of a kernel, compiled into it.

Always inlined: a step compiled on its own as well would be optimised differently there, and which of the two a process
runs would depend on whether the kernel came from the cache.
"""


def chosen_by_type(*, together: Any, alone: Any) -> Callable[[Function], Function]:
    """Mark a formula that compiles to `alone` where its first argument is a tuple, else to `together`."""

    def marked(function: Function) -> Function:
        @overload(function, jit_options=_OPTIONS, strict=False)
        def choose(*arguments: Any) -> Any:
            return alone if isinstance(arguments[0], types.BaseTuple) else together

        return function

    return marked


def kernel(function: Function) -> Function:
    """Compile a function that Python calls; the machine code is kept on disk, where there is a place for it."""
    compiled = njit(nogil=True, **_CALLED)(function)
    folder = kernel_folder()
    if folder is not None:
        compiled._cache = KernelCache(function, folder)
    return cast(Function, compiled)


def inverse(z: Any) -> Any:
    """Return 1 / z."""
    return 1.0 / z


def root(z: Any) -> Any:
    """Return the square root of z; its derivative at exactly zero is taken as zero."""
    return np.sqrt(z)


def arcsine(z: Any) -> Any:
    """Return the angle in [-pi/2, pi/2], in radians, whose sine is z."""
    return np.arcsin(z)


def magnitude(z: Any) -> Any:
    """Return z or -z, whichever has a real part that is not negative: |z| with its derivative away from zero.

    What stands for more than one number (an enclosure over a box) brings a `magnitude` of its own.
    """
    if hasattr(z, "magnitude"):
        return z.magnitude()
    return np.where(np.real(z) < 0.0, -z, z)[()]


@overload(inverse, jit_options=_OPTIONS)
def _inverse(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            q = 1.0 / z.real
            return complex(q, -z.imag * q * q)
    else:

        def compiled(z: Any) -> Any:
            return 1.0 / z

    return compiled


@overload(root, jit_options=_OPTIONS)
def _root(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            q = math.sqrt(z.real)
            return complex(q, 0.5 * z.imag / q if q > 0.0 else 0.0)
    else:

        def compiled(z: Any) -> Any:
            return math.sqrt(z)

    return compiled


@overload(arcsine, jit_options=_OPTIONS)
def _arcsine(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            return complex(math.asin(z.real), z.imag / math.sqrt(1.0 - z.real * z.real))
    else:

        def compiled(z: Any) -> Any:
            return math.asin(z)

    return compiled


@overload(magnitude, jit_options=_OPTIONS)
def _magnitude(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            return -z if z.real < 0.0 else z
    else:

        def compiled(z: Any) -> Any:
            return abs(z)

    return compiled
