"""Quantities of a swing, and their columns for designs that need not rotate fully."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...model.errors import InputError
from ...model.kinematics.geometry import offset_without_rounding
from ...model.linkage.linkage import Linkage
from ...model.linkage.require_single_linkage import require_single_rotating_linkage
from ...model.machine.arm import Arm
from ...model.machine.loads.load import Enters
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing, require_swing
from ...model.turning_cylinder.lever_of_design import movable_lever_linkage
from ..formula.quantity import basic_quantities
from ..lever_quantity import LeverQuantity
from ..quantity import Array, Quantity
from ..registry import FACTS, QUANTITIES
from ..swing_quantity import SwingQuantity
from .design_input import column_of_variable

SLOW_STROKE, LOADED_STROKE = "slow_stroke", "loaded_stroke"
OUTER_DEAD_CENTRE, INNER_DEAD_CENTRE = "outer_dead_centre_deg", "inner_dead_centre_deg"
PEAK_TORQUE_ANGLE = "peak_torque_angle_deg"
OF_A_TURN = (SLOW_STROKE, LOADED_STROKE, OUTER_DEAD_CENTRE, INNER_DEAD_CENTRE, PEAK_TORQUE_ANGLE)


def swing_quantity_facts() -> tuple[SwingQuantity, ...]:
    """Return the facts of all quantities that a swing may have."""
    return tuple(fact for fact in FACTS.values() if isinstance(fact, SwingQuantity))


def swing_quantities(swing: Swing) -> tuple[SwingQuantity, ...]:
    """Return the quantities that are defined for a swing."""
    return tuple(
        replace(fact, swing=swing) for fact in swing_quantity_facts() if fact.unfit_swing_reason(swing) is None
    )


def reason_undefined_for_swing(name: str, swing: Swing | None) -> str | None:
    """Return the reason why a motion does not have a swing quantity; None if it does, and for other names."""
    fact = FACTS.get(name)
    if not isinstance(fact, SwingQuantity):
        return None
    if swing is None:
        if isinstance(fact, LeverQuantity) and "cylinder" not in fact.moved_by:
            return (
                "needs a crank that turns a cylinder or an arm; got a crank with rod and slider; set [mechanism] "
                'inversion = "turning cylinder", or leave the quantity out'
            )
        if isinstance(fact, LeverQuantity):
            return (
                'needs a lever that swings; this crank rotates fully; set [mechanism] inversion = "turning cylinder" '
                'and [motion] kind = "swing", or leave the quantity out'
            )
        return (
            'needs a swinging crank; this crank rotates fully; add [motion] kind = "swing" with from and to, '
            "or leave the quantity out"
        )
    return fact.unfit_swing_reason(swing)


def require_quantities_of_motion(names: Iterable[str], custom: Iterable[Quantity], swing: Swing | None) -> None:
    """Raise `InputError` if a motion does not have a named swing quantity. custom: quantities of the problem."""
    custom_names = {item.name for item in custom}
    for name in names:
        reason = None if name in custom_names else reason_undefined_for_swing(name, swing)
        if reason is not None:
            raise InputError(f"{name}: {reason}")


def require_motion_of_machine_kind(mechanism: Mechanism, swing: Swing | None) -> None:
    """Raise `InputError` unless a lever has a motion of levers, and no other machine has one."""
    of_lever = swing is not None and swing.of_lever
    if (mechanism.lever is not None) != of_lever:
        if of_lever:
            raise InputError(
                "a cylinder drives a lever; got one with a slider-crank; set [mechanism] inversion, or another driver"
            )
        got = "no motion" if swing is None else f"a swing that the {swing.driver} drives"
        raise InputError(
            f"a lever needs a swing that its cylinder drives, or the full turn CRANK_TURN; got {got}; set one of them"
        )
    if mechanism.lever is None or swing is None:
        return
    if swing.of_full_turn:
        _require_nothing_of_a_driving_cylinder(mechanism)
    elif mechanism.with_largest_variables.speed:
        raise InputError(
            "mechanism.speed: is for a crank that rotates fully; got it with a lever that its cylinder swings; leave "
            "it out, and give [motion] a law and a duration"
        )
    elif mechanism.lever.arm != Arm():
        raise InputError(
            "arm: is for a crank that rotates fully; got it with a lever that its cylinder swings; leave it out"
        )
    require_possible_cylinder(mechanism)


def require_possible_cylinder(mechanism: Mechanism) -> None:
    """Raise `InputError` if the cylinder of a lever is impossible in every design within the ranges."""
    least, greatest = (machine.lever for machine in mechanism.at_bounds_of_variables)
    if least is None or greatest is None:
        return
    try:
        greatest.cylinder.require_sizes_to_agree(least.cylinder)
    except InputError as error:
        raise InputError(f"cylinder: {error}") from None


def _require_nothing_of_a_driving_cylinder(mechanism: Mechanism) -> None:
    """Raise `InputError` for properties that only apply to a cylinder that drives its lever.

    mechanism: a machine whose crank rotates fully.
    """
    machine = mechanism.with_largest_variables
    assert machine.lever is not None
    stated = {
        "cylinder.length_tolerance": machine.lever.cylinder.length_tolerance,
        "cylinder.supply_pressure": machine.lever.cylinder.supply_pressure,
    }
    for name, value in stated.items():
        if value:
            raise InputError(
                f"{name}: is for a lever that its cylinder swings; got it with a crank that rotates fully; leave it out"
            )


def linkage_that_can_move(mechanism: Mechanism, linkage: Linkage, swing: Swing | None) -> Linkage:
    """Return one linkage with dimensions as floats, which rotates fully, or makes a swing.

    Raises `AssemblyError` or `InputError` if it does not.
    """
    require_motion_of_machine_kind(mechanism, swing)
    if swing is None:
        return require_single_rotating_linkage(mechanism, linkage)
    return (require_swing if mechanism.lever is None else movable_lever_linkage)(mechanism, linkage, swing)


def require_loads_for_swing(mechanism: Mechanism) -> None:
    """Raise `InputError` for features that need a full turn: loads from a dead centre, cylinders, a speed profile."""
    of_turns = {
        "cylinders": mechanism.arrangement,
        "speed_profile": mechanism.speed_profile,
        "acceleration": mechanism.acceleration or None,
    }
    for key, value in of_turns.items():
        if value is not None:
            raise InputError(f"mechanism.{key}: it needs a crank that rotates fully; got a swing; leave it out")
    for load in mechanism.loads:
        if load.enters in (Enters.CYLINDER, Enters.BURNING_CYLINDER):
            raise InputError(
                "the cycle of a cylinder needs a crank that rotates fully; got a swing; leave it out, or give the "
                "forces on its piston over the slider position, from the crank pivot"
            )
        datum = getattr(load, "datum", "")
        if datum.endswith("dead centre"):
            instead = "zero crank angle" if load.enters is Enters.ANGLE_TABLE else "the crank pivot"
            raise InputError(
                f"a load on a swing must not be measured from the {datum}, which a swing need not reach; measure "
                f"it from {instead}, state a pressure as the force on its piston, or leave it out"
            )
        if load.cycle_turns > 1:
            raise InputError(
                "a cycle of 720 deg needs a crank that rotates fully; got a swing with such a load; state the load "
                "over 360 deg, or leave it out"
            )


def require_swing_quantity(key: str, quantity: Quantity, swing: Swing) -> None:
    """Raise `InputError` for a quantity that needs a slider-crank whose crank rotates fully."""
    for leaf in basic_quantities([quantity]):
        if leaf.turning:
            facts = (fact for fact in swing_quantity_facts() if isinstance(fact, LeverQuantity) == swing.of_lever)
            names = ", ".join(
                fact.name for fact in facts if not swing.of_full_turn or fact.unfit_swing_reason(swing) is None
            )
            needed = 'a crank that rotates fully; got [motion] kind = "swing"; use a quantity of a swing'
            if swing.of_full_turn:
                needed = "a crank with rod and slider; got a lever; use a quantity of a lever's full turn"
            raise InputError(f"{key}: {leaf.name} needs {needed} ({names}), or leave the quantity out")


def quantities_for_swing(custom: Sequence[Quantity]) -> tuple[Quantity, ...]:
    """Return the quantities of designs with a swing, in display order. custom: quantities of the problem."""
    every: Iterable[Quantity] = (*QUANTITIES.values(), *custom)
    quantities = [item for item in every if not any(leaf.turning for leaf in basic_quantities([item]))]
    return tuple(sorted(quantities, key=lambda item: item.place))


def swing_columns(mechanism: Mechanism, dimensions: Array, custom: Sequence[Quantity]) -> dict[str, NDArray[Any]]:
    """Return the columns (n,) for designs with a swing (n, 3 + k), as `analysis_columns` does for a full turn."""
    dimensions = np.atleast_2d(np.asarray(dimensions, dtype=np.float64)).copy()
    dimensions[:, 2] = offset_without_rounding(dimensions[:, 1], dimensions[:, 2])
    columns: dict[str, NDArray[Any]] = {
        name: 1e3 * dimensions[:, place] for place, name in enumerate(("crank_mm", "rod_mm", "offset_mm"))
    }
    for place, item in enumerate(mechanism.varying):
        key, unit = column_of_variable(item)
        columns[key] = unit.factor * dimensions[:, 3 + place]
    for quantity in quantities_for_swing(custom):
        if quantity.undefined_because([mechanism]):
            columns[quantity.field] = np.full(len(dimensions), np.nan)
        else:
            columns[quantity.field] = quantity.unit.factor * quantity.evaluate(mechanism, dimensions).values
    return columns
