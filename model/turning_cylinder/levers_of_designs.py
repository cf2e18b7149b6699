"""Many levers with their turning cylinders from the designs of a machine, and which of them can make a motion."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..arrays import Array, Mask
from ..kernel.arithmetic import STEP, magnitude
from ..machine.derived_designs import derived_blocks
from ..machine.design import Design
from ..machine.lever_cylinder import euler_load_times_squared_length, piston_areas
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_batch, memoise_by_machine
from ..machine.raw_machine_vector import raw_inputs_with_all_features
from ..machine.raw_numbers_of_designs import LEVER, SPRING, START, RawNumbers, raw_machine_numbers
from ..machine.varying_numbers import number_at_path
from ..swing.swing import Swing
from .curve_peaks import LeverBatch, table_of_numbers
from .lever_state import LeverNumbers

_FIELDS = Design._fields
_MARGIN = 1e-9
"""Distance from a dead point, rad, or from locking, as a fraction of the frame, within which rounding decides."""


@memoise_by_batch
def lever_batch(
    mechanism: Mechanism, designs: Array, /, swing: Swing, *, gradients: bool
) -> tuple[LeverBatch, RawNumbers]:
    """Return levers of designs (n, 3 + k), and the raw numbers that these set. gradients: whether to step each."""
    raw, loads = raw_inputs_with_all_features(mechanism)
    numbers = raw_machine_numbers(mechanism, designs, slot_count=10**9, gradients=gradients)
    inside = np.flatnonzero(numbers.columns < len(raw))
    values = np.ascontiguousarray(numbers.values[:, inside])
    blocks, steps = derived_blocks(raw, loads, numbers.columns[inside], values, steps=gradients)
    own = dict(zip(numbers.columns.tolist(), numbers.values.T, strict=True))
    plain = _lever_numbers(mechanism, swing, blocks[:, :, 0], own)
    stepped = []
    by_number = steps.reshape(len(designs), len(inside) if gradients else 0, blocks.shape[1])
    for place, slot in enumerate(numbers.columns.tolist() if gradients else ()):
        block = by_number[:, int(np.searchsorted(inside, place))] if slot < len(raw) else blocks[:, :, 0]
        moved = own if slot < len(raw) else own | {slot: own[slot] + 1j * STEP}
        stepped.append(_lever_numbers(mechanism, swing, block, moved))
    law: Any = swing.law
    return LeverBatch(plain, law, tuple(stepped), of_full_turn=swing.of_full_turn), numbers


def _lever_numbers(mechanism: Mechanism, swing: Swing, block: Any, raw_numbers_by_slot: dict[int, Any]) -> Any:
    """Return the table of `LeverBatch`.

    block: (n, rows), see `machine.design`. raw_numbers_by_slot: those that designs set.
    """
    machine, nominal = mechanism.nominal, _nominal_numbers(mechanism)

    def part(name: str) -> Any:
        slot = LEVER[name]
        return raw_numbers_by_slot[slot] if slot in raw_numbers_by_slot else nominal[name]

    def of_block(*names: str) -> list[Any]:
        return [block[:, _FIELDS.index(name)] for name in names]

    crank, frame, offset = of_block("r", "l", "e")
    if swing.of_full_turn:  # the lengths of the cylinder are least and greatest at psi = 0 and 180 deg
        start = part("frame_angle") - part("pin_angle")
        end = start + np.pi
    else:
        start = raw_numbers_by_slot.get(START["crank"], swing.start)
        end = start + (swing.end - swing.start) if swing.follows else swing.end
    cylinder_numbers = {name.removeprefix("cylinder."): part(name) for name in LEVER if name.startswith("cylinder.")}
    cylinder = SimpleNamespace(**cylinder_numbers)
    bore, rod = cylinder.bore, cylinder.rod
    rod_of_area = 0.0 if machine.lever is not None and machine.lever.cylinder.rod is None else rod
    angles = part("frame_angle"), offset, part("pin_angle"), start, end
    sizes = LeverNumbers._make([crank, frame, *angles, *[0.0] * (len(LeverNumbers._fields) - 7)])
    first, last = sizes.cylinder_end_lengths
    rises = np.real(last - first) > 0.0
    closed_length, stroke = cylinder.closed_length, cylinder.stroke
    if _is_number_given(cylinder.dead_length):
        closed_length = cylinder.dead_length + (stroke if _is_number_given(stroke) else magnitude(last - first))
    length = closed_length if _is_number_given(closed_length) else np.where(rises, first, last)
    numbers: tuple[Any, ...] = (
        *(crank, frame, *angles, 0.0 if swing.duration is None else 1.0 / swing.duration),
        *of_block("crank_mass", "crank_along", "crank_across", "crank_inertia", "gravity_x", "gravity_y"),
        *(cylinder.barrel_mass, length, cylinder.piston_rod_mass, length),
        *of_block("crank_error", "rod_error", "offset_error"),
        *(cylinder.length_tolerance, cylinder.seal_friction, *piston_areas(bore, rod_of_area)),
        *(cylinder.supply_pressure, euler_load_times_squared_length(rod, cylinder.modulus)),
        *(closed_length, stroke, *of_block("speed"), *_arm_numbers(part)),
        *(() if machine.lever is None or machine.lever.spring is None else map(part, SPRING)),
    )
    is_complex = np.iscomplexobj(block) or any(map(np.iscomplexobj, raw_numbers_by_slot.values()))
    return table_of_numbers(LeverNumbers(*numbers), len(crank), np.complex128 if is_complex else np.float64)


@memoise_by_machine
def _nominal_numbers(mechanism: Mechanism) -> dict[str, float]:
    """Return the numbers of a lever by name; NaN for those that are not given."""
    has_spring = mechanism.lever is not None and mechanism.lever.spring is not None
    names = [name for name in LEVER if has_spring or name not in SPRING]
    numbers = {name: number_at_path(mechanism.nominal, f"lever.{name}") for name in names}
    return {name: np.nan if number is None else number for name, number in numbers.items()}


def _is_number_given(number: Any) -> bool:
    """Return whether a number is given."""
    return not bool(np.isnan(np.real(number)).all())


def _arm_numbers(number_by_name: Callable[[str], Any]) -> tuple[Any, ...]:
    """Return the numbers of the arm as `LeverNumbers` has them. number_by_name: function of a name."""
    mass, centre, inertia, torque, ram, *rest = (number_by_name(name) for name in LEVER if name.startswith("arm."))
    moment = mass * centre
    return mass, moment, inertia + moment * centre, torque, ram if _is_number_given(ram) else 0.0, *rest


def can_make_motion(mechanism: Mechanism, swing: Swing, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) make the swing without a dead point, or the full turn.

    Where they vary, the bore must exceed the piston rod, and the closed length the stroke, in each design.
    """
    return _can_make_motion(mechanism, np.ascontiguousarray(designs, dtype=np.float64), swing).copy()


@memoise_by_batch
def _can_make_motion(mechanism: Mechanism, designs: Array, /, swing: Swing) -> Mask:
    passing = np.isfinite(designs).all(axis=1) & (designs[:, 0] > 0.0) & (designs[:, 1] > 0.0)
    rows = np.flatnonzero(passing)
    if not len(rows):
        return passing
    c = lever_batch(mechanism, designs[rows], swing, gradients=False)[0].plain
    if swing.of_full_turn:
        gap = np.abs(c.crank - c.frame) - np.abs(c.offset)
        passing[rows] = (gap > _MARGIN * c.frame) & ~_has_impossible_cylinder(mechanism, c)
        return passing
    first, last = (end + c.pin_angle - c.frame_angle for end in (c.start, c.end))
    between = np.floor(first / np.pi) == np.floor(last / np.pi)
    off = np.minimum(*(np.abs(np.sin(angle)) for angle in (first, last))) > _MARGIN
    with np.errstate(invalid="ignore"):
        closing = np.minimum(*c.cylinder_end_lengths) > 0.0
    passing[rows] = between & off & closing & ~_has_impossible_cylinder(mechanism, c) & (np.abs(last - first) < np.pi)
    return passing


def _has_impossible_cylinder(mechanism: Mechanism, c: LeverNumbers) -> Mask:
    """Return which levers have an impossible cylinder, as far as it is known."""
    assert mechanism.lever is not None
    on_clevis = mechanism.lever.cylinder.mounting == "clevis"
    with np.errstate(invalid="ignore"):  # NaN where it is not
        return np.asarray((c.annular_area <= 0.0) | (on_clevis & (c.stroke >= c.closed_length)))
