"""Numbers of a machine that vary from design to design, besides crank, rod and offset."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from ..checks import store_as_tuples
from ..errors import InputError


@dataclass(frozen=True, kw_only=True)
class Varying:
    """A variable: a number of a machine that a design may choose.

    name: displayed name; in a job its path, "mechanism.slider.mass". sets: numbers of the `Mechanism` that follow it,
    each with its dotted path ("slider_mass", "crank.width", "loads.0.stiffness") and a factor: the number is the factor
    times the value. A force F that opposes every motion sets ("loads.0.outward", -1.0) and ("loads.0.inward", 1.0).
    lower, upper: bounds of the value, SI; equal bounds fix it. idle: whether it sets nothing, because it belongs to the
    other turn of the cycle (`machine_of_each_cylinder`).
    """

    name: str
    sets: tuple[tuple[str, float], ...]
    lower: float
    upper: float
    idle: bool = False

    def __post_init__(self) -> None:
        store_as_tuples(self, "sets")
        if not (math.isfinite(self.lower) and math.isfinite(self.upper) and self.lower <= self.upper):
            raise InputError(
                f"a range must have lower <= upper, both finite; got {self.lower:g} to {self.upper:g} for {self.name}"
            )
        if bool(self.sets) == self.idle or not all(math.isfinite(factor) and factor for _, factor in self.sets):
            raise InputError(f"{self.name} must set at least one number of the machine, each with a non-zero factor")

    @property
    def largest_magnitude_bound(self) -> float:
        """The bound with the larger magnitude."""
        return max(self.lower, self.upper, key=abs)

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the numbers that follow it."""
        return tuple(path for path, _ in self.sets)


def with_variable_values(part: Any, varying: Sequence[Varying], values: Sequence[float]) -> Any:
    """Return a machine (any frozen dataclass) with its variables set to these values."""
    if len(varying) != len(values):
        names = ", ".join(item.name for item in varying) or "none"
        raise InputError(f"every variable needs a value ({names}); got {len(values)} values")
    for item, value in zip(varying, values, strict=True):
        for path, factor in item.sets:
            part = _replace_number_at_path(part, path.split("."), factor * float(value), path)
    return part


def number_at_path(part: Any, path: str) -> float | None:
    """Return the number at a dotted path in a machine; None if a link uses its default. Raises `InputError`."""
    for key in path.split("."):
        part = _field_or_item_of_part(part, key, path)
    if isinstance(part, bool) or not (part is None or isinstance(part, int | float)):
        raise InputError(f"a variable must be a number of the machine; got {path!r}, which is not one")
    return part


def require_valid_variables(mechanism: Any) -> None:
    """Raise `InputError` unless a machine's variables exist, set different numbers, and are valid at both ends."""
    varying: tuple[Varying, ...] = mechanism.varying
    paths = [path for item in varying for path in item.paths]
    for path in paths:
        number_at_path(mechanism, path)
        if paths.count(path) > 1:
            raise InputError(f"a number may only be set by one variable; got {path} twice; leave out one of the two")
    names = [item.name for item in varying]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"variables must have different names; got {name!r} twice")
    for item in varying:
        if "speed" in item.paths and not item.lower * item.upper > 0.0:
            raise InputError(
                "a variable speed must not be 0 or change its sign, which is the direction of rotation; got "
                f"{item.lower:g} to {item.upper:g} rad/s; keep the range on one side of 0"
            )
    for index, load in enumerate(mechanism.loads):
        if load.every_corner:
            _require_valid_corners(load, f"loads.{index}.", varying)
    for ends in ([item.lower for item in varying], [item.upper for item in varying]):
        mechanism.with_values(ends)


def _require_valid_corners(load: Any, prefix: str, varying: Sequence[Varying]) -> None:
    """Raise `InputError` unless a load is valid at every combination of the ends of its variables."""
    entries = [
        [(path.removeprefix(prefix), factor * end) for path, factor in item.sets if path.startswith(prefix)]
        for item in varying
        for end in (item.lower, item.upper)
    ]
    pairs = [(entries[i], entries[i + 1]) for i in range(0, len(entries), 2) if entries[i]]
    for corner in itertools.product(*pairs):
        replace(load, **dict(itertools.chain(*corner)))


def _field_or_item_of_part(part: Any, key: str, path: str) -> Any:
    if isinstance(part, tuple) and key.isdecimal() and int(key) < len(part):
        return part[int(key)]
    if is_dataclass(part) and key in {field.name for field in fields(part)}:
        return getattr(part, key)
    raise InputError(f"a variable must be a number of the machine; got {path!r}, which it does not have")


def _replace_number_at_path(part: Any, keys: list[str], number: float, path: str) -> Any:
    if not keys:
        return number
    inner = _replace_number_at_path(_field_or_item_of_part(part, keys[0], path), keys[1:], number, path)
    if isinstance(part, tuple):
        index = int(keys[0])
        return (*part[:index], inner, *part[index + 1 :])
    return replace(part, **{keys[0]: inner})
