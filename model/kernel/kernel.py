"""Functions compiled to machine code for the argument types that they declare."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from struct import Struct
from threading import Lock
from types import NoneType
from typing import Annotated, Any, TypeVar, cast, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from .disk_cache import KernelSource, load_or_compile
from .machine_code import Leaf, load_entry_point

Function = TypeVar("Function", bound=Callable[..., Any])

Row = Annotated[NDArray[np.float64], 1]
"""Array (n,) of numbers as a kernel's argument."""
Table = Annotated[NDArray[np.float64], 2]
Cube = Annotated[NDArray[np.float64], 3]
ComplexTable = Annotated[NDArray[np.complex128], 2]
ComplexCube = Annotated[NDArray[np.complex128], 3]
Integers = Annotated[NDArray[np.int64], 1]
IntegerTable = Annotated[NDArray[np.int64], 2]
Flags = Annotated[NDArray[np.bool_], 1]

KERNELS: list[Kernel] = []
"""All kernels in the modules imported so far."""

_RESULTS: dict[Any, Any] = {
    int: ctypes.c_int64,
    bool: ctypes.c_uint8,
    float: ctypes.c_double,
    NoneType: ctypes.c_void_p,
}
_loading = Lock()
_AS_PYTHON = os.environ.get("NUMBA_DISABLE_JIT", "0") != "0"

Flat = tuple[Any, ...]


def kernel(function: Function) -> Function:
    """Compile a function at its first call from Python; the machine code is stored on disk.

    Its arguments are contiguous arrays (`Row` to `Flags`), numbers, and named or plain tuples of them, as annotated. It
    returns a number or nothing.
    """
    return _register_kernel(function, seldom=False)


def rarely_used_kernel(function: Function) -> Function:
    """Compile a function like `kernel`, but after all others: few jobs need it, and its compilation is slow."""
    return _register_kernel(function, seldom=True)


def _register_kernel(function: Function, *, seldom: bool) -> Function:
    compiled = Kernel(function, seldom=seldom)
    KERNELS.append(compiled)
    return cast(Function, compiled)


class Kernel:
    """A function that runs as machine code."""

    def __init__(self, function: Callable[..., Any], *, seldom: bool = False) -> None:
        """Take a function without compiling it. seldom: whether other kernels are compiled before it."""
        self.function, self.seldom = function, seldom
        self.__doc__ = function.__doc__
        self._flat: list[Callable[[Any], Flat]] = []
        self._loaded: tuple[Callable[[bytes, int], int], Callable[..., bytes], Any] | None = None

    def __call__(self, *values: Any) -> Any:
        """Run it. Raises `TypeError` for an argument of another type, `MemoryError` if there is not enough memory."""
        if _AS_PYTHON:
            return self.function(*values)
        run, pack, kind = self._loaded or self._load_machine_code()
        flat: list[Any] = []
        for parameter, value in zip(self._flat, values, strict=True):
            flat += parameter(value)
        result = kind()
        if run(pack(*flat), ctypes.addressof(result)):
            raise MemoryError(f"not enough memory for {self.function.__qualname__}")
        return result.value

    def compilation_source(self) -> KernelSource:
        """Return the kernel as a compilation task."""
        examples = tuple(_example_value(hint) for name, hint in self._type_hints().items() if name != "return")
        return KernelSource(f"{self.function.__module__}.{self.function.__name__}", self.function, examples)

    def _type_hints(self) -> dict[str, Any]:
        return get_type_hints(self.function, include_extras=True)

    def _load_machine_code(self) -> tuple[Callable[[bytes, int], int], Callable[..., bytes], Any]:
        """Return the machine code, the function that packs its arguments, and the type of its result."""
        with _loading:
            if self._loaded is None:
                source, hints = self.compilation_source(), self._type_hints()
                leaves = [leaf for example in source.examples for leaf in _machine_types(example)]
                packed = Struct("".join("d" if leaf.type == "double" else "q" for leaf in leaves)).pack
                code = load_or_compile(source, [kernel.function.__module__ for kernel in KERNELS])
                result = _RESULTS[hints.pop("return")]
                self._flat = [_flattener(name, hint) for name, hint in hints.items()]
                self._loaded = load_entry_point(code, leaves), packed, result
        return self._loaded


def _tuple_member_types(annotation: Any) -> list[Any] | None:
    """Return the types of a tuple's members, None for other types."""
    if get_origin(annotation) is tuple:
        return list(get_args(annotation))
    if isinstance(annotation, type) and issubclass(annotation, tuple):
        return list(get_type_hints(annotation, include_extras=True).values())
    return None


def _example_value(annotation: Any) -> Any:
    """Return a value of a type."""
    members = _tuple_member_types(annotation)
    if members is not None:
        values = [_example_value(member) for member in members]
        return tuple(values) if get_origin(annotation) is tuple else annotation(*values)
    if get_origin(annotation) is Annotated:
        array, dimensions = get_args(annotation)
        return np.zeros((1,) * dimensions, _item_type_of_annotation(array))
    return annotation()


def _item_type_of_annotation(annotation: Any) -> np.dtype[Any]:
    """Return the item type of an `NDArray[...]`."""
    dtype: np.dtype[Any] = np.dtype(get_args(get_args(annotation)[1])[0])
    return dtype


def _flattener(name: str, kind: Any) -> Callable[[Any], Flat]:
    """Return the function that converts a value to machine arguments."""
    members = _tuple_member_types(kind)
    if members is not None:
        return _tuple_flattener([_flattener(name, member) for member in members])
    if get_origin(kind) is Annotated:
        array, dimensions = get_args(kind)
        return _array_flattener(name, _item_type_of_annotation(array), dimensions)
    if kind is complex:
        return lambda value: (value.real, value.imag)
    return lambda value: (kind(value),)


def _tuple_flattener(members: list[Callable[[Any], Flat]]) -> Callable[[Any], Flat]:
    last: tuple[Any, Flat] = (None, ())  # the same tuple often comes many times in succession

    def flat(value: Any) -> Flat:
        nonlocal last
        last_value, flattened = last
        if last_value is not value:
            flattened = tuple(item for member, part in zip(members, value, strict=True) for item in member(part))
            last = value, flattened
        return flattened

    return flat


def _array_flattener(name: str, item: np.dtype[Any], dimensions: int) -> Callable[[Any], Flat]:
    def flat(value: Any) -> Flat:
        if value.dtype != item or value.ndim != dimensions or not value.flags.c_contiguous:
            raise TypeError(
                f"{name} must be a contiguous array of {item} in {dimensions} dimensions; "
                f"got {value.dtype} in {value.ndim}, strides {value.strides}"
            )
        return (id(value),)

    return flat


def _machine_types(example: Any) -> list[Leaf]:
    """Return the machine types of a value."""
    if isinstance(example, tuple):
        return [leaf for member in example for leaf in _machine_types(member)]
    if isinstance(example, np.ndarray):
        return [Leaf("ptr", example.ndim, example.itemsize)]
    if isinstance(example, complex):
        return [Leaf("double"), Leaf("double")]
    return [Leaf({bool: "i8", int: "i64", float: "double"}[type(example)])]
