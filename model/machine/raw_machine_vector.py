"""Raw numbers of a machine as one vector, and the fixed structure of its loads.

A kernel takes the vector (`Raw` names its entries; loads follow, `LOAD_SLOTS` each) and overwrites the entries that
vary from design to design. It then derives the numbers for the equations of motion (`design`).
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..kernel.kernel import Integers, Row, Table
from .cylinders_and_turns import require_one_turn
from .links_and_joints import Bar, Link
from .loads.load import Load
from .loads.registry import kernel_code_of_load
from .loads.stroke_force import StrokeForce
from .mechanism import Mechanism
from .memoise import memoise_by_machine

Raw = IntEnum(
    "Raw",
    "CRANK ROD OFFSET BRANCH SPEED ACCELERATION SLIDER_MASS GRAVITY_X GRAVITY_Y "
    "CRANK_WIDTH CRANK_DEPTH CRANK_DENSITY CRANK_MASS CRANK_CENTRE CRANK_CENTRE_SHARE "
    "CRANK_CENTRE_ACROSS CRANK_INERTIA CRANK_INERTIA_SHARE "
    "ROD_WIDTH ROD_DEPTH ROD_DENSITY ROD_MASS ROD_CENTRE ROD_CENTRE_SHARE "
    "ROD_CENTRE_ACROSS ROD_INERTIA ROD_INERTIA_SHARE "
    "COUNTERWEIGHT_MASS COUNTERWEIGHT_ALONG COUNTERWEIGHT_ACROSS COUNTERWEIGHT_INERTIA "
    "CRANK_TOLERANCE CRANK_TOLERANCE_SHARE ROD_TOLERANCE ROD_TOLERANCE_SHARE "
    "OFFSET_TOLERANCE OFFSET_TOLERANCE_SHARE ANGLE_TOLERANCE "
    "CRANK_PIVOT_CLEARANCE CRANK_PIN_CLEARANCE SLIDER_PIN_CLEARANCE GUIDE_CLEARANCE "
    "GUIDE_FRICTION CRANK_PIVOT_RADIUS CRANK_PIVOT_FRICTION CRANK_PIN_RADIUS CRANK_PIN_FRICTION "
    "SLIDER_PIN_RADIUS SLIDER_PIN_FRICTION GUIDE_DISTANCE END",
    start=0,
)
LOAD_SLOTS = 13
"""Raw numbers per load: factor in the outward stroke, factor in the inward stroke, and its own numbers."""

_DATUMS = {"crank pivot": 0, "zero crank angle": 0, "inner dead centre": 1, "outer dead centre": 2}


class Loads(NamedTuple):
    """Fixed structure of the loads.

    kind: (k,), see `loads.registry.kernel_code_of_load`. datum: (k,). factor: (k, 3), whether a table acts in the
    outward stroke, in the inward stroke, and as a torque on the crank. start: (k + 1,), index at which a load's table
    begins. knots, force: of the tables. on_crank: whether any load is a torque on the crank.
    """

    kind: Integers
    datum: Integers
    factor: Table
    start: Integers
    knots: Row
    force: Row
    on_crank: bool


def raw_vector(mechanism: Mechanism) -> Array:
    """Return the raw numbers of a mechanism; the three dimensions are zero, to be overwritten.

    Raises `InputError` for a mechanism with variables, whose values only a design determines.
    """
    if mechanism.varying:
        names = ", ".join(item.name for item in mechanism.varying)
        raise InputError(
            f"only a machine with fixed numbers is possible here; got one whose {names} varies; pass "
            "mechanism.with_values(values)"
        )
    raw = [0.0] * (Raw.END + LOAD_SLOTS * len(mechanism.loads))  # faster to slice than an array
    raw[Raw.BRANCH] = mechanism.sign
    raw[Raw.SPEED] = mechanism.speed
    raw[Raw.ACCELERATION] = mechanism.acceleration
    raw[Raw.SLIDER_MASS] = mechanism.slider_mass
    raw[Raw.GRAVITY_X], raw[Raw.GRAVITY_Y] = mechanism.gravity
    raw[Raw.CRANK_WIDTH : Raw.CRANK_WIDTH + 9] = _link_numbers(mechanism.crank)
    raw[Raw.ROD_WIDTH : Raw.ROD_WIDTH + 9] = _link_numbers(mechanism.rod)
    weight = mechanism.counterweight
    raw[Raw.COUNTERWEIGHT_MASS] = weight.mass
    raw[Raw.COUNTERWEIGHT_ALONG] = weight.radius * math.cos(weight.angle)
    raw[Raw.COUNTERWEIGHT_ACROSS] = weight.radius * math.sin(weight.angle)
    raw[Raw.COUNTERWEIGHT_INERTIA] = weight.inertia
    tolerances = mechanism.tolerances
    for slot, tolerance in (
        (Raw.CRANK_TOLERANCE, tolerances.crank),
        (Raw.ROD_TOLERANCE, tolerances.rod),
        (Raw.OFFSET_TOLERANCE, tolerances.offset),
    ):
        raw[slot : slot + 2] = tolerance.absolute, tolerance.fraction
    raw[Raw.ANGLE_TOLERANCE] = tolerances.crank_angle.absolute
    gap = tolerances.clearances
    raw[Raw.CRANK_PIVOT_CLEARANCE : Raw.GUIDE_CLEARANCE + 1] = gap.crank_pivot, gap.crank_pin, gap.slider_pin, gap.guide
    friction = mechanism.friction
    raw[Raw.GUIDE_FRICTION] = friction.guide
    for index, pin in enumerate((friction.crank_pivot, friction.crank_pin, friction.slider_pin)):
        place = Raw.CRANK_PIVOT_RADIUS + 2 * index
        raw[place : place + 2] = pin.radius, pin.coefficient
    raw[Raw.GUIDE_DISTANCE] = mechanism.slider.guide or 0.0
    for index, load in enumerate(mechanism.loads):
        place = Raw.END + LOAD_SLOTS * index
        numbers = load.numbers_for_kernel()
        raw[place : place + len(numbers)] = numbers
    return np.array(raw, dtype=np.float64)


@memoise_by_machine
def raw_inputs_with_all_features(mechanism: Mechanism) -> tuple[Array, Loads]:
    """Return the raw numbers, read-only, and the loads of a machine that has all features of any of its designs."""
    raw = raw_vector(mechanism.with_largest_variables)
    raw.flags.writeable = False
    return raw, load_structure(mechanism)


def _link_numbers(link: Link) -> tuple[float, ...]:
    if isinstance(link, Bar):
        return (link.width, link.depth, link.density, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    centre, share = (0.0, 0.5) if link.centre is None else (link.centre, 0.0)
    inertia, per_mass = (0.0, 1.0 / 12.0) if link.inertia is None else (link.inertia, 0.0)
    return (0.0, 0.0, 0.0, link.mass, centre, share, link.centre_across, inertia, per_mass)


def _stroke_and_crank_factors(load: Load) -> tuple[float, float, float]:
    if load.on_crank:
        return (0.0, 0.0, 1.0)
    outward, inward = load.numbers_for_kernel()[:2]
    return (outward, inward, 0.0)


@memoise_by_machine
def load_knot_count(mechanism: Mechanism) -> int:
    """Return the number of knots in the tables of a mechanism's loads."""
    return sum(len(load.knots()[0]) for load in mechanism.loads)


@memoise_by_machine
def load_structure(mechanism: Mechanism) -> Loads:
    """Return kinds, datums and tables of a mechanism's loads. Raises `InputError` for a cycle of two turns."""
    require_one_turn(mechanism, "this analysis")
    at: list[float] = []
    force: list[float] = []
    start = [0]
    for load in mechanism.loads:
        places, forces = load.knots()
        back = mechanism.direction < 0.0 and load.has_knots_in_sense_of_rotation
        at.extend([-place for place in reversed(places)] if back else places)
        force.extend(reversed(forces) if back else forces)
        start.append(len(at))
    return Loads(
        np.array([kernel_code_of_load(type(load)) for load in mechanism.loads], dtype=np.int64),
        np.array([_DATUMS[getattr(load, "datum", "crank pivot")] for load in mechanism.loads], dtype=np.int64),
        np.array([_stroke_and_crank_factors(load) for load in mechanism.loads], dtype=np.float64).reshape(-1, 3),
        np.array(start, dtype=np.int64),
        np.array(at, dtype=np.float64),
        np.array(force, dtype=np.float64),
        any(load.on_crank for load in mechanism.loads),
    )


@memoise_by_machine
def raw_inputs_with_added_masses_only(mechanism: Mechanism) -> tuple[Array, Loads]:
    """Return raw numbers and loads in which only added masses act: loads without effect create no breakpoints."""
    raw, _ = raw_inputs_with_all_features(mechanism)
    if not any(load.is_moving_mass for load in mechanism.loads):
        return raw[: int(Raw.END)], load_structure(Mechanism())
    nothing = StrokeForce(outward=0.0, inward=0.0)
    return raw, load_structure(
        Mechanism(loads=tuple(own if own.is_moving_mass else nothing for own in mechanism.loads))
    )
