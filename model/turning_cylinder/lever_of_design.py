"""One design of a machine as a lever with its cylinder: the input to the analysis of a single swing."""

import numpy as np

from ..arrays import Array
from ..cycle.cycle import derived_design
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..machine.mechanism import Mechanism
from ..swing.swing import CRANK_TURN, Swing, with_start_set_by_machine
from .crank_turn_state import TurnState, fast_stroke_ends, place_in_turn, turn_state
from .cylinder_and_pin_forces import LeverBody, LeverMachine, LeverSwing, UniformBar
from .lever_geometry import DimensionErrors, TurningCylinder
from .lever_state import LeverNumbers
from .levers_of_designs import lever_batch


def lever_sizes(mechanism: Mechanism, linkage: Linkage) -> TurningCylinder:
    """Return the fixed dimensions of the lever of a design."""
    lever = mechanism.lever
    assert lever is not None
    return TurningCylinder(
        crank=float(linkage.crank),
        frame=float(linkage.rod),
        frame_angle=lever.frame_angle,
        offset=float(linkage.offset),
        pin_angle=lever.pin_angle,
    )


def lever_swing(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> LeverSwing:
    """Return the swing of the lever of a design, or the fast stroke of its crank if it rotates fully."""
    if swing.of_full_turn:
        sizes = lever_sizes(mechanism, linkage)
        before, after = (float(angle) for angle in fast_stroke_ends(sizes))
        zero = sizes.frame_angle - sizes.pin_angle
        return LeverSwing(zero - before, zero + after, of_full_turn=True)
    placed = with_start_set_by_machine(mechanism, swing)
    if placed.law == "table":
        raise InputError("the law of a lever's swing must be given by name; got a table; name a law such as cycloidal")
    return LeverSwing(placed.start, placed.end, placed.law, placed.duration)


def movable_lever_linkage(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Linkage:
    """Return crank, frame and offset of one lever as floats.

    Raises `InputError` for a dead point within its swing, `AssemblyError` where it does not close or rotate fully.
    """
    if swing.of_full_turn:
        lever_sizes(mechanism, linkage).require_turn()
        return Linkage(float(linkage.crank), float(linkage.rod), float(linkage.offset), linkage.branch)
    placed = lever_swing(mechanism, linkage, swing)
    lever_sizes(mechanism, linkage).require_swing(placed.start, placed.end)
    return Linkage(float(linkage.crank), float(linkage.rod), float(linkage.offset), linkage.branch)


def lever_machine(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> tuple[LeverMachine, DimensionErrors]:
    """Return the lever of one design with its masses, and its tolerances."""
    assert mechanism.lever is not None
    design, sizes, placed = (
        derived_design(mechanism, linkage),
        lever_sizes(mechanism, linkage),
        lever_swing(mechanism, linkage, swing),
    )
    cylinder = mechanism.lever.cylinder
    ends = float(sizes.cylinder_length(placed.start)), float(sizes.cylinder_length(placed.end))
    shortest, longest = sorted(sizes.closable_length_range if placed.of_full_turn else ends)
    known = cylinder.closed_length_and_stroke(longest - shortest)
    length = shortest if known is None else known[0]
    machine = LeverMachine(
        sizes=sizes,
        lever=LeverBody(
            mass=float(design.crank_mass),
            moment_along=float(design.crank_along),
            moment_across=float(design.crank_across),
            inertia=float(design.crank_inertia),
        ),
        barrel=UniformBar(mass=cylinder.barrel_mass, length=length),
        piston_rod=UniformBar(mass=cylinder.piston_rod_mass, length=length),
        gravity=mechanism.gravity,
        spring=mechanism.lever.spring,
        ram=mechanism.lever.arm.ram or 0.0,
    )
    errors = (float(design.crank_error), float(design.rod_error), float(design.offset_error), cylinder.length_tolerance)
    return machine, DimensionErrors(*errors)


def state_at_crank_angles(mechanism: Mechanism, linkage: Linkage, crank_angle: Array) -> TurnState:
    """Return the state of a design whose crank rotates fully, at crank angles (n,), rad. Raises `AssemblyError`."""
    checked = movable_lever_linkage(mechanism, linkage, CRANK_TURN)
    design = np.array([[checked.crank, checked.rod, checked.offset]])
    batch, _ = lever_batch(mechanism.nominal, design, CRANK_TURN, gradients=False)
    numbers = LeverNumbers(*(float(number[0]) for number in batch.plain))
    places = place_in_turn(numbers, crank_angle)
    return turn_state(numbers, places, places)
