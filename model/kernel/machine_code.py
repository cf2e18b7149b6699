"""Machine code of kernels, loaded and called without numba.

A compiled function takes the address for its result, the address for an error, and then its arguments: an array as
(nothing, nothing, size, bytes per item, address, shape, strides), a tuple as its members in sequence. The arrays that a
kernel allocates come from numba's runtime, a small library that needs nothing else from numba.

Python calls an entry point that is created next to it. The entry point takes all arguments in one block, 8 bytes each.
For an array it takes the object itself, and reads address, shape and strides from it (`PyArrayObject` in NumPy's C
interface).
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

_SYMBOL = "slidercrank_entry"


class MachineCode(NamedTuple):
    """An object file: its function's symbol, types of the arguments after the first two, functions it calls."""

    symbol: str
    arguments: tuple[str, ...]
    calls: tuple[str, ...]
    code: bytes


class Leaf(NamedTuple):
    """A number or an array among the arguments: machine type, dimensions and bytes per item."""

    type: str
    dimensions: int = 0
    item: int = 0


def load_entry_point(code: MachineCode, leaves: list[Leaf]) -> Callable[[bytes, int], int]:
    """Return the entry point: called with arguments and a result address, it returns 0, or nonzero if memory runs out.

    It releases the interpreter lock.
    """
    import llvmlite.binding as llvm

    _register_symbols()
    missing = [name for name in code.calls if not llvm.address_of_symbol(name)]
    if missing:  # otherwise the engine would jump to an invalid address
        raise SlidercrankError(
            f"compiled formulas need all the functions that they call; {', '.join(missing)} is missing; reinstall "
            "numba and llvmlite"
        )
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(_llvm_entry(code, leaves)), _target_processor())
    engine.add_object_file(llvm.ObjectFileRef.from_data(code.code))
    engine.finalize_object()
    _engines.append(engine)
    function_type = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_char_p, ctypes.c_void_p)
    return function_type(engine.get_function_address(_SYMBOL))


def _llvm_entry(code: MachineCode, leaves: list[Leaf]) -> str:
    """Return the entry point as LLVM code."""
    lines: list[str] = []
    arguments: list[tuple[str, str]] = []

    def read(kind: str, base: str, offset: int) -> str:
        name = f"%v{len(lines)}"
        lines.append(f"{name}p = getelementptr i8, ptr {base}, i64 {offset}\n  {name} = load {kind}, ptr {name}p")
        return name

    head = (
        object.__basicsize__
    )  # header of every Python object; an array's address, dimensions, shape and strides follow
    for number, leaf in enumerate(leaves):
        if not leaf.item:
            arguments.append((leaf.type, read(leaf.type, "%block", 8 * number)))
            continue
        array = read("ptr", "%block", 8 * number)
        shape, strides = read("ptr", array, head + 16), read("ptr", array, head + 24)
        sides = [read("i64", shape, 8 * side) for side in range(leaf.dimensions)]
        size = sides[0]
        for side in sides[1:]:
            product = f"%v{len(lines)}"
            lines.append(f"{product} = mul i64 {size}, {side}")
            size = product
        arguments += [("ptr", "null"), ("ptr", "null"), ("i64", size), ("i64", str(leaf.item))]
        arguments += [("ptr", read("ptr", array, head)), *(("i64", side) for side in sides)]
        arguments += [("i64", read("i64", strides, 8 * side)) for side in range(leaf.dimensions)]
    types = tuple(kind for kind, _ in arguments)
    if types != code.arguments:
        raise SlidercrankError(
            f"a kernel must take the types that it declares, {types}; got {code.arguments}; recompile it"
        )
    argument_list = ", ".join(f"{kind} {value}" for kind, value in arguments)
    body = "\n  ".join(lines)
    return f"""
declare i32 @"{code.symbol}"(ptr, ptr, {", ".join(types)})

define i32 @{_SYMBOL}(ptr %block, ptr %result) {{
  %error = alloca ptr
  store ptr null, ptr %error
  {body}
  %status = call i32 @"{code.symbol}"(ptr %result, ptr %error, {argument_list})
  ret i32 %status
}}
"""


def _target_processor() -> Any:
    import llvmlite.binding as llvm

    return llvm.Target.from_default_triple().create_target_machine(jit=True, codemodel="jitdefault")


_engines: list[Any] = []  # these own the machine code


@cache
def _register_symbols() -> None:
    """Register the symbols that kernels call: mathematical functions, and numba's memory for arrays."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    llvm.create_mcjit_compiler(
        llvm.parse_assembly(""), _target_processor()
    )  # gives access to the functions in this process
    for name, address in _numba_library("_helperlib").c_helpers.items():
        llvm.add_symbol(f"numba_{name}", address)
        llvm.add_symbol(name, address)
    for name, address in _numba_library("core/runtime/_nrt_python").c_helpers.items():
        llvm.add_symbol(f"NRT_{name}", address)


def _numba_library(path: str) -> Any:
    """Return one of numba's libraries without importing numba."""
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
