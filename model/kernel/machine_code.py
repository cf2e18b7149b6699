"""Machine code of a kernel, loaded and called without numba.

A compiled function takes the address for its result, the address for an error, and its arguments: an array as
(nothing, nothing, size, bytes of an item, address, shape, strides), a tuple as its members one after the other. The
arrays that a kernel allocates come from numba's runtime, a small library that needs none of the rest of numba.
"""

from __future__ import annotations

import ctypes
import importlib.util
from collections.abc import Callable
from functools import cache
from importlib.machinery import EXTENSION_SUFFIXES, ExtensionFileLoader
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import SlidercrankError

_TYPES: dict[str, Any] = {
    "ptr": ctypes.c_void_p,
    "i64": ctypes.c_int64,
    "double": ctypes.c_double,
    "i8": ctypes.c_uint8,
}


class MachineCode(NamedTuple):
    """An object file: its function's symbol, types of the arguments after the first two, and functions it calls."""

    symbol: str
    arguments: tuple[str, ...]
    calls: tuple[str, ...]
    code: bytes


def load(found: MachineCode) -> Callable[..., int]:
    """Return the function; it gives 0, or something else where there was no memory.

    It releases the interpreter lock. It takes the addresses of its result and of its error first.
    """
    import llvmlite.binding as llvm

    _prepare()
    missing = [name for name in found.calls if not llvm.address_of_symbol(name)]
    if missing:  # the engine would jump to nowhere
        raise SlidercrankError(
            f"compiled formulas must find all functions that they call; {', '.join(missing)} is not in this process; "
            "install the versions of numba and llvmlite anew"
        )
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(found.code))
    engine.finalize_object()
    _engines.append(engine)
    types = [ctypes.c_void_p, ctypes.c_void_p, *(_TYPES[name] for name in found.arguments)]
    return ctypes.CFUNCTYPE(ctypes.c_int32, *types)(engine.get_function_address(found.symbol))


def _machine() -> Any:
    import llvmlite.binding as llvm

    return llvm.Target.from_default_triple().create_target_machine(jit=True, codemodel="jitdefault")


_engines: list[Any] = []  # which own the code


@cache
def _prepare() -> None:
    """Name what kernels call outside themselves: mathematical functions, and numba's memory for arrays."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())  # which opens the process's own functions
    for name, address in _library("_helperlib").c_helpers.items():
        llvm.add_symbol(f"numba_{name}", address)
        llvm.add_symbol(name, address)
    for name, address in _library("core/runtime/_nrt_python").c_helpers.items():
        llvm.add_symbol(f"NRT_{name}", address)


def _library(path: str) -> Any:
    """Return one of numba's libraries, without numba."""
    numba = importlib.util.find_spec("numba")
    assert numba is not None
    assert numba.origin is not None
    begin = Path(numba.origin).parent / path
    file = next(file for suffix in EXTENSION_SUFFIXES if (file := begin.parent / f"{begin.name}{suffix}").exists())
    loader = ExtensionFileLoader(begin.name, str(file))
    spec = importlib.util.spec_from_loader(begin.name, loader)
    assert spec is not None
    library = importlib.util.module_from_spec(spec)
    loader.exec_module(library)
    return library
