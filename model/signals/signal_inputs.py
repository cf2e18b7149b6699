"""Inputs for following a signal over the cycle: loads, and the angles at which its curve is piecewise."""

from ..arrays import Array
from ..dynamics.segments import CycleWindow
from ..machine.cylinders_and_turns import machine_of_first_turn
from ..machine.loads.crank_torque import require_loads_repeating_each_turn
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_machine
from ..machine.raw_machine_vector import Loads, raw_inputs_with_added_masses_only, raw_inputs_with_all_features
from .signals import Signal


def cycle_window(mechanism: Mechanism, kind: Signal, *, during: str = "cycle") -> CycleWindow:
    """Return the part of the cycle that counts for a mechanism's signal."""
    strokes = {"cycle": 0, "outward stroke": 1, "inward stroke": 2}
    friction = mechanism.with_largest_variables.friction
    split = kind.needs_forces and (has_load_change_at_dead_centres(mechanism) or friction.guide > 0.0)
    swing = kind.needs_forces and friction.slider_pin.friction_circle_radius > 0.0
    if kind in (Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS):
        window = mechanism.tolerances.window
        return CycleWindow(strokes[window.during], float(window.start), float(window.end), False)
    return CycleWindow(strokes[during], 0.0, 1.0, split, swing)


def signal_inputs(mechanism: Mechanism, kind: Signal) -> tuple[Array, Loads]:
    """Return the raw numbers and loads that a signal needs; irrelevant loads create no breakpoints."""
    if kind.needs_forces:
        require_loads_repeating_each_turn(mechanism)
        return raw_inputs_with_all_features(mechanism)
    return raw_inputs_with_added_masses_only(machine_of_first_turn(mechanism))


@memoise_by_machine
def has_load_change_at_dead_centres(mechanism: Mechanism) -> bool:
    """Whether a load changes at the dead centres."""
    if any(load.has_stroke_dependent_formula for load in mechanism.with_largest_variables.loads):
        return True
    # Forces in the two strokes that vary independently may agree at one value only.
    forces: dict[str, list[tuple[str, float]]] = {}
    for item in mechanism.varying:
        for path, factor in item.sets:
            load, _, name = path.rpartition(".")
            if name in ("outward", "inward"):
                forces.setdefault(load, []).append((item.name, factor))
    return any(len(setters) < 2 or setters[0] != setters[1] for setters in forces.values())
