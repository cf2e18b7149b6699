"""Raw numbers that the designs of a machine set, and how they follow from a design.

A design of a machine with k variables has 3 + k numbers: crank, rod, offset and the value of each variable. Kernels
overwrite raw numbers (`raw.Raw`). Most are a factor times one value; the counterweight's mass centre is stated by
radius and angle, but its raw numbers are components. Kernels differentiate by the raw numbers;
`RawNumbers.gradients_by_design_numbers` converts these to derivatives with respect to the design's own numbers. With k
= 0 this is the identity and costs nothing.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ..arrays import Array, IntArray
from ..errors import InputError
from ..kernel.arithmetic import STEP
from .loads.registry import load_classes
from .mechanism import Mechanism
from .memoise import memoise_by_batch, memoise_by_machine
from .raw_machine_vector import LOAD_SLOTS, Raw, raw_vector
from .varying_numbers import Varying, number_at_path

_LINK = {
    "width": (0, "m"),
    "depth": (1, "m"),
    "density": (2, "kg/m^3"),
    "mass": (3, "kg"),
    "centre": (4, "m"),
    "centre_across": (6, "m"),
    "inertia": (7, "kg m^2"),
}
_LOAD = {name: place for kind in load_classes() for name, place in kind.slots.items()}
_SLOTS: dict[str, tuple[int, str]] = {
    "speed": (Raw.SPEED, "rad/s"),
    "acceleration": (Raw.ACCELERATION, "rad/s^2"),
    "slider_mass": (Raw.SLIDER_MASS, "kg"),
    "gravity.0": (Raw.GRAVITY_X, "m/s^2"),
    "gravity.1": (Raw.GRAVITY_Y, "m/s^2"),
    "counterweight.mass": (Raw.COUNTERWEIGHT_MASS, "kg"),
    "counterweight.inertia": (Raw.COUNTERWEIGHT_INERTIA, "kg m^2"),
    "tolerances.crank_angle.absolute": (Raw.ANGLE_TOLERANCE, "rad"),
    "friction.guide": (Raw.GUIDE_FRICTION, ""),
    "slider.guide": (Raw.GUIDE_DISTANCE, "m"),
    **{f"crank.{name}": (Raw.CRANK_WIDTH + slot, unit) for name, (slot, unit) in _LINK.items()},
    **{f"rod.{name}": (Raw.ROD_WIDTH + slot, unit) for name, (slot, unit) in _LINK.items()},
}
for _name, _slot in (("crank", Raw.CRANK_TOLERANCE), ("rod", Raw.ROD_TOLERANCE), ("offset", Raw.OFFSET_TOLERANCE)):
    _SLOTS[f"tolerances.{_name}.absolute"] = (_slot, "m")
    _SLOTS[f"tolerances.{_name}.fraction"] = (_slot + 1, "")
for _index, _name in enumerate(("crank_pivot", "crank_pin", "slider_pin", "guide")):
    _SLOTS[f"tolerances.clearances.{_name}"] = (Raw.CRANK_PIVOT_CLEARANCE + _index, "m")
    if _name != "guide":
        _SLOTS[f"friction.{_name}.radius"] = (Raw.CRANK_PIVOT_RADIUS + 2 * _index, "m")
        _SLOTS[f"friction.{_name}.coefficient"] = (Raw.CRANK_PIVOT_RADIUS + 2 * _index + 1, "")
PINS = {"crank_pivot": 10**8, "crank_pin": 10**8 + 1, "slider_pin": 10**8 + 2}
"""Slots for the pin diameters, after all slots that kernels use, so that no kernel differentiates by them."""
_SLOTS |= {f"strength.{name}": (slot, "m") for name, slot in PINS.items()}
START = {"crank": 10**8 + 3, "slider": 10**8 + 4}
"""Slots for the start of a swing, by the link for which its ends are stated; only the swing reads them."""
_SLOTS |= {"start.angle": (START["crank"], "rad"), "start.place": (START["slider"], "m")}
_DRIVE = {
    "flywheel": "kg m^2",
    "motor_inertia": "kg m^2",
    "gear_ratio": "",
    "gear_efficiency": "",
    "braking_efficiency": "",
    "greatest_torque": "N m",
    "rated_torque": "N m",
    "greatest_speed": "rad/s",
    "copper_loss": "W",
    "recovery": "",
}
DRIVE = {name: 10**8 + 5 + place for place, name in enumerate(_DRIVE)}
"""Slots for the drive train, which no kernel needs, either."""
_SLOTS |= {f"drive.{name}": (slot, _DRIVE[name]) for name, slot in DRIVE.items()}
_LEVER = {
    **{"frame_angle": "rad", "pin_angle": "rad"},
    **dict.fromkeys(("cylinder.closed_length", "cylinder.stroke", "cylinder.bore", "cylinder.rod"), "m"),
    **{"cylinder.supply_pressure": "Pa", "cylinder.seal_friction": "N", "cylinder.length_tolerance": "m"},
    **{"cylinder.barrel_mass": "kg", "cylinder.piston_rod_mass": "kg", "cylinder.modulus": "Pa"},
    **{"cylinder.dead_length": "m"},
    **{"arm.mass": "kg", "arm.centre": "m", "arm.inertia": "kg m^2", "arm.torque": "N m"},
    **dict.fromkeys(("spring.frame", "spring.lever", "spring.length"), "m"),
    **{"spring.frame_angle": "rad", "spring.pin_angle": "rad", "spring.force": "N", "spring.stiffness": "N/m"},
    **{"arm.ram": "m", "arm.ram_mass": "kg", "arm.ram_force": "N"},
}
LEVER = {name: 10**8 + 5 + len(_DRIVE) + place for place, name in enumerate(_LEVER)}
"""Slots of a lever, its cylinder and its arm, which read their own."""
LEVER_MASSES = tuple(name for name in LEVER if name.endswith("mass"))
"""Masses of a lever's cylinder and arm."""
SPRING = tuple(
    f"spring.{name}" for name in ("frame", "frame_angle", "lever", "pin_angle", "force", "length", "stiffness")
)
"""Numbers of a lever's spring, in the order of `turning_cylinder.states.LeverNumbers`."""
_SLOTS |= {f"lever.{name}": (slot, _LEVER[name]) for name, slot in LEVER.items()}
_POLAR = {"counterweight.radius": "m", "counterweight.angle": "rad"}


def unit_of_number(path: str) -> str:
    """Return the SI unit of a number in a machine. Raises `InputError` for a number that designs cannot set."""
    return _POLAR[path] if path in _POLAR else _slot_and_unit_of_path(path)[1]


@cache
def _slot_and_unit_of_path(path: str) -> tuple[int, str]:
    load = re.fullmatch(r"loads\.(\d+)\.(\w+)", path)
    if load is not None and load[2] in _LOAD:
        slot, unit = _LOAD[load[2]]
        return Raw.END + LOAD_SLOTS * int(load[1]) + slot, unit
    if path not in _SLOTS:
        raise InputError(f"{path!r} must not vary, as no quantity depends smoothly on it; make it a choice instead")
    return _SLOTS[path]


@dataclass(frozen=True)
class RawNumbers:
    """Raw numbers for n designs.

    columns: indices (c,) of the raw numbers; crank, rod and offset first. values: (n, c). slopes: (n, c, 3 + k), their
    derivatives with respect to the design's numbers; None if these are the identity.
    """

    columns: IntArray
    values: Array
    slopes: Array | None

    def gradients_by_design_numbers(self, gradients: Array) -> Array:
        """Convert derivatives with respect to raw numbers, (n, ..., c), to the design's own, (n, ..., 3 + k)."""
        if self.slopes is None:
            return gradients
        return np.asarray(np.einsum("n...c,nck->n...k", gradients, self.slopes))


_THREE = np.arange(3)


@memoise_by_batch
def raw_machine_numbers(mechanism: Mechanism, designs: Array, *, slot_count: int, gradients: bool) -> RawNumbers:
    """Return the raw numbers that designs (n, 3 + k) of a machine with k variables set.

    limit: number of raw numbers; a signal independent of loads has fewer. gradients: whether to return slopes.
    """
    require_design_columns(mechanism, designs)
    if not mechanism.varying:
        return RawNumbers(_THREE, designs, None)
    by_slot = {slot: value for slot, value in raw_numbers_by_slot(mechanism, designs).items() if slot < slot_count}
    columns = np.array(list(by_slot), dtype=np.int64)
    values = np.ascontiguousarray(np.stack(list(by_slot.values()), axis=1))
    shape = len(designs) if gradients else 0, len(columns), designs.shape[1]
    rates = _raw_number_slopes(mechanism.varying)
    if rates is not None:
        by_column = np.array([rates[slot] for slot in by_slot])
        return RawNumbers(columns, values, np.array(np.broadcast_to(by_column, shape)))
    slopes = np.empty(shape)
    for v in range(designs.shape[1] if gradients else 0):
        stepped = designs.astype(np.complex128)
        stepped[:, v] += 1j * STEP
        moved = raw_numbers_by_slot(mechanism, stepped)
        slopes[:, :, v] = np.stack([moved[slot].imag for slot in by_slot], axis=1) / STEP
    return RawNumbers(columns, values, slopes)


def raw_number_at_slot(mechanism: Mechanism, slot: int, designs: Array, *, otherwise: float) -> tuple[Array, Array]:
    """Return one raw number (n,) for designs (n, 3 + k) and its derivatives (n, 3 + k).

    `otherwise`: value if designs do not set it.
    """
    numbers = raw_machine_numbers(mechanism, designs, slot_count=10**9, gradients=True)
    place = np.flatnonzero(numbers.columns == slot)
    if numbers.slopes is None or not len(place):
        return np.full(len(designs), otherwise), np.zeros(designs.shape)
    return numbers.values[:, place[0]], numbers.slopes[:, place[0]]


def evaluate_formula_of_raw_numbers(
    mechanism: Mechanism, designs: Array, formula: Callable[[Callable[[int], Any]], Any], *, gradients: bool
) -> tuple[Array, Array | None]:
    """Return a formula for designs (n, 3 + k): values (n,) and complex-step derivatives (n, 3 + k).

    formula: smooth formula that accepts real or complex numbers. Its argument is a function that returns the raw number
    at a slot (`Raw`, `PINS`, `DRIVE`, `LEVER`), (n,) or one for all designs.
    """
    numbers = raw_machine_numbers(mechanism, designs, slot_count=10**9, gradients=gradients)
    set_numbers: dict[int, Any] = dict(zip(numbers.columns.tolist(), numbers.values.T, strict=True))
    slots_used: dict[int, None] = {}

    def number(slot: int) -> Any:
        slots_used[slot] = None
        return set_numbers[slot] if slot in set_numbers else nominal_raw_number(mechanism, slot)

    plain = formula(number) + np.zeros(len(designs))
    if not gradients:
        return plain, None
    by_number = np.zeros((len(designs), len(set_numbers)))
    for place, slot in enumerate(set_numbers):
        if slot in slots_used:
            set_numbers[slot] = set_numbers[slot] + 1j * STEP
            by_number[:, place] = np.imag(formula(number)) / STEP
            set_numbers[slot] = set_numbers[slot].real
    return plain, numbers.gradients_by_design_numbers(by_number)


def nominal_raw_number(mechanism: Mechanism, slot: int) -> float:
    """Return the raw number at a slot (`Raw`, `PINS`, `DRIVE`, `LEVER`) that designs do not set."""
    if mechanism.lever is None and slot in LEVER.values():
        return 0.0
    for owner, slots in ((mechanism.strength, PINS), (mechanism.drive, DRIVE), (mechanism.lever, LEVER)):
        for name, place in slots.items():
            if place == slot:
                number: Any = number_at_path(owner, name)
                return float(number)
    return float(_nominal_numbers(mechanism)[slot])


@memoise_by_machine
def _nominal_numbers(mechanism: Mechanism) -> Array:
    return raw_vector(mechanism.nominal)


def require_design_columns(mechanism: Mechanism, designs: Array) -> None:
    """Raise `InputError` unless designs (n, 3 + k) have as many numbers as the machine requires."""
    if designs.shape[1] != 3 + len(mechanism.varying):
        names = "".join(f", {item.name}" for item in mechanism.varying)
        raise InputError(
            f"a design of this machine must have {3 + len(mechanism.varying)} numbers: crank, rod, offset{names}; "
            f"got {designs.shape[1]}"
        )


@cache
def _raw_number_slopes(varying: tuple[Varying, ...]) -> dict[int, tuple[float, ...]] | None:
    """Return the derivatives (3 + k,) of each raw number that designs set; None if they are not constant."""
    rates = {column: {column: 1.0} for column in range(3)}
    for column, item in enumerate(varying):
        for path, factor in item.sets:
            if path in _POLAR:
                return None
            rates[_slot_and_unit_of_path(path)[0]] = {
                3 + column: factor * STEP / STEP
            }  # rounded as a complex step would
    count = 3 + len(varying)
    return {slot: tuple(row.get(column, 0.0) for column in range(count)) for slot, row in rates.items()}


def raw_numbers_by_slot(mechanism: Mechanism, designs: Any) -> dict[int, Any]:
    """Return the raw numbers that designs set, each (n,); complex if the designs are complex."""
    by_slot: dict[int, Any] = {column: designs[:, column] for column in range(3)}
    polar: dict[str, Any] = {}
    for column, item in enumerate(mechanism.varying):
        for path, factor in item.sets:
            if path in _POLAR:
                polar[path] = factor * designs[:, 3 + column]
            else:
                by_slot[_slot_and_unit_of_path(path)[0]] = factor * designs[:, 3 + column]
    if polar:
        weight = mechanism.counterweight
        radius = polar.get("counterweight.radius", weight.radius)
        angle = polar.get("counterweight.angle", weight.angle) + 0.0 * designs[:, 0]
        by_slot[Raw.COUNTERWEIGHT_ALONG] = radius * np.cos(angle)
        by_slot[Raw.COUNTERWEIGHT_ACROSS] = radius * np.sin(angle)
    return by_slot
