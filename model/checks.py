"""Checks of a machine's fields, and of other single values."""

import math
from collections.abc import Iterable, Mapping
from numbers import Integral, Real
from types import NoneType, UnionType
from typing import get_args

from .errors import InputError

_REMEDY = "write text with a unit in the tables of a job"


def is_number(value: object) -> bool:
    """Return whether a value is a real number; a bool is not."""
    return isinstance(value, Real) and not isinstance(value, bool)


def is_integer(value: object) -> bool:
    """Return whether a value is a whole number; a bool is not."""
    return isinstance(value, Integral) and not isinstance(value, bool)


def require_numbers(
    owner: object, *names: str, phrase: str = "", least: float = -math.inf, above: float = -math.inf, unit: str = ""
) -> None:
    """Raise an error for fields that are not finite numbers, are less than `least` or do not exceed `above`.

    None passes.

    phrase: the number in words, with {} for the field name. unit: unit, shown after the number.
    """
    for name in names:
        value = getattr(owner, name)
        number = (phrase or f"{{}} of a {type(owner).__name__}").format(name)
        try:
            right = value is None or (math.isfinite(value) and value >= least and value > above)
        except TypeError:
            raise InputError(f"{number} must be a number in SI units; got {value!r}; {_REMEDY}") from None
        if not right:
            sign = "positive and " if above == 0.0 else "zero or more and " if least == 0.0 else ""
            raise InputError(f"{number} must be {sign}finite; got {value:g}{unit and f' {unit}'}")


def require_all_finite(subject: str, values: Iterable[float], suffix: str = "") -> None:
    """Raise an error if any of the numbers is not finite, or is not a number."""
    for value in values:
        try:
            finite = math.isfinite(value)
        except TypeError:
            raise InputError(f"{subject} must consist of numbers in SI units; got {value!r}; {_REMEDY}") from None
        if not finite:
            raise InputError(f"{subject} must be finite{suffix and f' {suffix}'}; got {value}")


def require_field_types(
    owner: object, kinds: Mapping[str, type | UnionType], remedy: str, *, item_by_item: bool = False
) -> None:
    """Raise an error for fields whose type differs from their annotation.

    item_by_item: whether to check the items of tuples.
    """
    for name, kind in kinds.items():
        field = getattr(owner, name)
        for value in field if item_by_item and isinstance(field, tuple) else (field,):
            if not isinstance(value, kind) or (item_by_item and not isinstance(field, tuple)):
                kind_names = " or ".join(
                    "None" if item is NoneType else item.__name__ for item in get_args(kind) or (kind,)
                )
                expected = f"a tuple of {kind_names}" if item_by_item else kind_names
                raise InputError(f"{name} of a {type(owner).__name__} must be {expected}; got {value!r}; {remedy}")


def store_as_tuples(owner: object, *names: str) -> None:
    """Turn fields given as lists or arrays into tuples, because machines and problems are compared and hashed."""
    for name in names:
        value = getattr(owner, name)
        value = value.tolist() if hasattr(value, "tolist") else value
        if isinstance(value, list):
            object.__setattr__(owner, name, tuple(value))
