"""Machine code for kernels, by numba; functions marked `analytic` are compiled into them.

This module is imported only when a kernel has to be compiled: importing numba takes as long as running a job.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import get_ident
from typing import Any, cast

import numba
from numba import njit, typeof, types
from numba.core import event
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager
from numba.core.typed_passes import InlineOverloads, IRLegalization, NopythonRewrites
from numba.core.typing.context import BaseContext
from numba.core.untyped_passes import InlineClosureLikes, InlineInlinables
from numba.extending import overload, register_jitable

from .arithmetic import FORMULAS, arcsine, arctangent, inverse, magnitude, power, root
from .machine_code import MachineCode

# Without `nnan` and `ninf`, because NaN must stay NaN. Vectorisation needs contraction and reassociation.
_OPTIONS: Any = {
    "fastmath": {"reassoc", "contract", "arcp", "nsz"},
    "error_model": "numpy",
    "no_cpython_wrapper": True,  # not called from outside
    "no_cfunc_wrapper": True,
}
_NEEDLESS = (InlineClosureLikes, InlineInlinables, InlineOverloads, NopythonRewrites, IRLegalization)


class _FormulaCompilerWithFewerPasses(CompilerBase):
    """Numba's compiler for formulas, without its passes for closures and array expressions."""

    def define_pipelines(self) -> list[PassManager]:
        """Return the passes."""
        manager: PassManager = cast(Any, DefaultPassBuilder).define_nopython_pipeline(self.state)
        manager.passes = [entry for entry in manager.passes if entry[0] not in _NEEDLESS]
        cast(Any, manager).finalize()
        return [manager]


# Formulas neither create nor return arrays: reference counting would be half of their code.
_FORMULA: Any = _OPTIONS | {"forceinline": True, "_nrt": False, "pipeline_class": _FormulaCompilerWithFewerPasses}
_KERNEL: Any = _OPTIONS | {"nogil": True}

_TRIED = "0.68."  # tested numba version: `_compiled_for_linking` and `_memoised_resolution` use its internals

_registered: dict[Callable[..., Any], None] = {}
_resolved: dict[Any, Any] = {}


def register_formulas() -> None:
    """Register all formulas marked so far with numba."""
    for formula in FORMULAS[len(_registered) :]:
        register_jitable(**_FORMULA)(formula)
        _registered[formula] = None


@contextmanager
def _memoised_resolution() -> Iterator[None]:
    """Resolve each call only once for the same argument types.

    Otherwise numba tries every overload of + at every +. It would also compile a formula again for a call from a
    kernel, and for a call with a number instead of a variable.
    """
    contexts = cast(Any, BaseContext)
    original, thread = contexts.resolve_function_type, get_ident()

    def resolve(context: Any, function: Any, arguments: Any, keywords: Any) -> Any:
        if get_ident() != thread or keywords or not isinstance(function, types.Function):
            return original(context, function, arguments, keywords)
        formula = function.typing_key in _registered
        call = function, tuple(map(types.unliteral, arguments)) if formula else tuple(arguments)
        if call not in _resolved:
            _resolved[call] = original(context, *call, keywords)
        return _resolved[call]

    if numba.__version__.startswith(_TRIED):
        contexts.resolve_function_type = resolve
    try:
        yield
    finally:
        contexts.resolve_function_type = original


@contextmanager
def _compiled_for_linking(kernel: str) -> Iterator[None]:
    """Compile formulas only as far as linking into the kernel requires, because nothing calls them alone.

    Otherwise each formula would be optimised like the kernel and turned into machine code, which takes a fifth of the
    time. Without any optimisation, the peak kernel would run at half speed.
    """
    libraries, engine = cast(Any, JITCodeLibrary), cast(Any, JITCPUCodegen)
    finalize_original, set_env, thread = libraries.finalize, engine.set_env, get_ident()

    def finalize(library: Any) -> None:
        if library.name == kernel or get_ident() != thread:
            finalize_original(library)
            return
        for linked in dict.fromkeys(library._linking_libraries):
            library._final_module.link_in(linked._get_module_for_linking(), preserve=True)
        manager, builder = library._codegen._module_pass_manager(
            loop_vectorize=False, slp_vectorize=False, opt=1, cost="cheap"
        )
        manager.run(library._final_module, builder)
        library._finalized = True

    if numba.__version__.startswith(_TRIED):
        libraries.finalize = finalize
        # No formula has an address in this process.
        engine.set_env = lambda *given: None if get_ident() == thread else set_env(*given)
    try:
        yield
    finally:
        libraries.finalize, engine.set_env = finalize_original, set_env


class _ArrayReturnListener(event.Listener):
    """Rejects formulas that return arrays: without reference counting these would be freed too soon."""

    def on_start(self, event: Any) -> None:
        """Check the return type of a function before it is compiled."""
        data = event.data
        is_native_lowering = data["name"].startswith("native_lowering") and not data["module"].startswith("numba")
        if is_native_lowering and "array(" in data["return_type"]:
            raise TypeError(
                f"a formula must not return an array; {data['qualname']} does; create the array in the kernel"
            )

    def on_end(self, event: Any) -> None:
        """Do nothing."""


def compile_kernel(function: Callable[..., Any], examples: tuple[Any, ...]) -> MachineCode:
    """Return the machine code of a function for arguments of the examples' types."""
    register_formulas()
    signature = tuple(map(typeof, examples))
    dispatcher: Any = njit(**_KERNEL)(function)
    with (
        _memoised_resolution(),
        _compiled_for_linking(function.__qualname__),
        event.install_listener("numba:run_pass", _ArrayReturnListener()),
    ):
        dispatcher.compile(signature)
    compiled = dispatcher.overloads[signature]
    symbol = compiled.fndesc.llvm_func_name
    _, _, (code, _) = compiled.library.serialize_using_object_code()
    arguments = tuple(str(argument.type) for argument in compiled.library.get_function(symbol).arguments)
    functions = compiled.library.get_function(symbol).module.functions
    calls = tuple(
        function_declared.name
        for function_declared in functions
        if function_declared.is_declaration and not function_declared.name.startswith("llvm.")
    )
    return MachineCode(symbol, arguments[2:], calls, code)


# Python stores its frames in chunks of 16 kB, and allocates and frees a chunk at every call that crosses into the next
# one. That happens a quarter of a million times per kernel and takes an eighth of the time. A frame of one megabyte
# leaves the rest of its two-megabyte chunk for all others.
compile_kernel.__code__ = compile_kernel.__code__.replace(co_stacksize=1 << 17)


@overload(inverse, jit_options=_FORMULA)
def _inverse_for_types(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            q = 1.0 / z.real
            return complex(q, -z.imag * q * q)
    else:

        def compiled(z: Any) -> Any:
            return 1.0 / z

    return compiled


@overload(root, jit_options=_FORMULA)
def _root_for_types(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            q = math.sqrt(z.real)
            return complex(q, 0.5 * z.imag / q if q > 0.0 else 0.0)
    else:

        def compiled(z: Any) -> Any:
            return math.sqrt(z)

    return compiled


@overload(power, jit_options=_FORMULA)
def _power_for_types(base: Any, exponent: Any) -> Any:
    if isinstance(base, types.Complex) or isinstance(exponent, types.Complex):

        def compiled(base: Any, exponent: Any) -> Any:
            q = base.real**exponent.real
            return complex(q, q * (exponent.real * base.imag / base.real + math.log(base.real) * exponent.imag))
    else:

        def compiled(base: Any, exponent: Any) -> Any:
            return base**exponent

    return compiled


# Sun's fdlibm, e_asin.c: (asin(x) - x) / x^3 as a quotient of polynomials in x^2, for x up to one half.
_ABOVE = (
    1.66666666666666657415e-01,
    -3.25565818622400915405e-01,
    2.01212532134862925881e-01,
    -4.00555345006794114027e-02,
    7.91534994289814532176e-04,
    3.47933107596021167570e-05,
)
_BELOW = (1.0, -2.40339491173441421878, 2.02094576023350569471, -6.88283971605453293030e-01, 7.70381505559019352791e-02)


@register_jitable(**_FORMULA)
def _asin(x: float) -> float:
    """Return the arc sine without a call, so that loops over designs become vector instructions.

    Above one half, asin(x) = pi / 2 - 2 asin(sqrt((1 - x) / 2)).
    """
    size = abs(x)
    small = size < 0.5
    square = x * x if small else 0.5 * (1.0 - size)
    s = size if small else math.sqrt(square)
    a, b = _ABOVE, _BELOW
    numerator = a[0] + square * (a[1] + square * (a[2] + square * (a[3] + square * (a[4] + square * a[5]))))
    denominator = b[0] + square * (b[1] + square * (b[2] + square * (b[3] + square * b[4])))
    angle = s + s * (square * numerator / denominator)
    return math.copysign(angle if small else 0.5 * math.pi - 2.0 * angle, x)


@overload(arcsine, jit_options=_FORMULA)
def _arcsine_for_types(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            return complex(_asin(z.real), z.imag / math.sqrt(1.0 - z.real * z.real))
    else:

        def compiled(z: Any) -> Any:
            return _asin(z)

    return compiled


@overload(arctangent, jit_options=_FORMULA)
def _arctangent(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            return complex(math.atan(z.real), z.imag / (1.0 + z.real * z.real))
    else:

        def compiled(z: Any) -> Any:
            return math.atan(z)

    return compiled


@overload(magnitude, jit_options=_FORMULA)
def _magnitude_for_types(z: Any) -> Any:
    if isinstance(z, types.Complex):

        def compiled(z: Any) -> Any:
            return -z if z.real < 0.0 else z
    else:

        def compiled(z: Any) -> Any:
            return abs(z)

    return compiled
