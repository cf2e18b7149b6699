"""Causes that a quantity needs from its machine: without them it is not defined, or zero for every design."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.machine.dissipation import crank_weighs, linkage_loaded, moves, pivot_loaded
from ...model.machine.mechanism import Mechanism
from ...model.signals.signals import Signal
from ...objectives.cycle_average import CycleAverage
from ...objectives.cycle_peak import CyclePeak
from ...objectives.position_error import POSITION_ERRORS
from ...objectives.quantity import Quantity
from ...objectives.self_locking import SELF_LOCKING_MARGIN

_BEYOND_CRANK = (Signal.CRANK_PIN_FORCE, Signal.SLIDER_PIN_FORCE, Signal.GUIDE_FORCE)
_SHAKING = (Signal.SHAKING_FORCE, Signal.SHAKING_MOMENT)
_MASSES = 'it comes from masses; got none; add for example [mechanism] slider = { mass = "0.8 kg" }'
_LOADS = (
    "it comes from masses and loads; got none that matter; add for example "
    '[mechanism] slider = { mass = "0.8 kg" }, or a [[load]]'
)
_SPEED = 'it comes from a turning crank; got speed 0; add for example [mechanism] speed = "300 rpm"'
_WORK = (
    "a machine that takes no work over a turn has none, whatever its dimensions; got no friction, no viscous load and "
    "no load that differs between the strokes; use {}, or add what the machine works against"
)


def undefined_because(quantity: Quantity, machines: Iterable[Mechanism]) -> str | None:
    """Return rule, value and remedy for a quantity that one of the machines does not define; None if all do."""
    of = _nominal(quantity)
    fullest = [machine.fullest for machine in machines]
    if of in POSITION_ERRORS and not all(machine.tolerances.given for machine in fullest):
        return 'a position error comes from tolerances; got none; add for example [tolerances] crank = "0.05 mm"'
    if of is SELF_LOCKING_MARGIN and not all(machine.friction.acts for machine in fullest):
        return (
            "a self-locking margin comes from friction; got none; add for example [friction] guide = 0.1, "
            "or use transmission_angle"
        )
    return None


def zero_because(quantity: Quantity, machines: Iterable[Mechanism]) -> str | None:
    """Return rule, value and remedy for a quantity that is zero for every design of all machines; None if it is not."""
    reasons = [_zero_because(_nominal(quantity), machine) for machine in machines]
    return reasons[0] if all(reasons) else None


def _zero_because(of: Quantity, machine: Mechanism) -> str | None:
    m = machine.fullest
    weighs = crank_weighs(m)
    # At constant speed and without gravity, crank and counterweight load the pivot but need no torque.
    driven = linkage_loaded(m) or (weighs and (any(m.gravity) or m.acceleration != 0.0))
    if not isinstance(of, CyclePeak | CycleAverage):
        return None
    powers = of.signal is Signal.POWER or (isinstance(of, CycleAverage) and of.times_speed)
    if m.speed == 0.0 and (powers or of.signal is Signal.SLIDER_SPEED):
        return _SPEED
    if m.speed == m.acceleration == 0.0 and (of.signal is Signal.SLIDER_ACCELERATION or of.signal in _SHAKING):
        return _SPEED
    if (of.signal is Signal.REFLECTED_INERTIA or of.signal in _SHAKING) and not (weighs or moves(m)):
        return _MASSES
    if of.signal is Signal.SHAKING_MOMENT and not (moves(m) or m.acceleration != 0.0):
        return _MASSES  # a crank at constant speed shakes by a force through its pivot
    if of.signal in _BEYOND_CRANK and not linkage_loaded(m):
        return _LOADS
    if of.signal in (Signal.TORQUE, Signal.POWER) and not driven:
        return _LOADS
    if of.signal is Signal.PIVOT_FORCE and not pivot_loaded(m):
        return _LOADS
    if isinstance(of, CycleAverage) and of.zero_for(machine):
        return _WORK.format("peak_power" if of.times_speed else "peak_torque or rms_torque")
    return None


def _nominal(quantity: Quantity) -> Quantity:
    """Return the quantity that a robust one is made of."""
    found: Quantity = getattr(quantity, "inner", quantity)
    return found
