"""Limits that allow no motion law: which ones, by how much, and what to change."""

from __future__ import annotations

import math

import numpy as np

from ...model.errors import InputError
from ...model.motion_law.law_turn import LawTurn
from ...model.transient.crank_equation import TURN
from .cone_programme import Margins, Programme, Requirement
from .law_limits import LawLimits, rpm_text
from .reachable_energies import Reachable

_AMPLE = 1e3  # multiple of the loads' greatest torque that is effectively unlimited
_ROUNDING = 1e-9


def require_consistent_limits(turn: LawTurn, limits: LawLimits) -> None:
    """Raise `InputError` if the least crank speed exceeds what the slider's speed limit allows."""
    low, high = limits.energy_limits(turn.angle, turn.terms.inertia, turn.terms.travel)
    worst = np.unravel_index(int(np.argmax(low - high)), low.shape)
    if not low[worst] <= high[worst]:
        allowed = math.sqrt(2.0 * high[worst] / turn.terms.inertia[worst])
        angle = math.degrees(float(turn.angle[worst])) % 360.0
        raise InputError(
            f"limits of a motion law exclude each other: at a crank angle of {angle:.6g} deg the slider's speed limit "
            f"allows {rpm_text(allowed)}, and {limits.name('least_speed')} is {rpm_text(limits.least_speed)}; reduce "
            "the latter or raise the slider's speed"
        )


def unreachable_limits_error(turn: LawTurn, limits: LawLimits) -> InputError:
    """Return the error for limits without a law: which limits exclude each other, and the least change."""
    request, load = limits.request, float(np.abs(turn.terms.load).max())
    programme = Programme(turn, limits, Margins(*np.zeros((3, len(turn.width)))))
    longest = math.inf if request.objective == "cycle time" else limits.cycle_time * (1.0 + _ROUNDING)
    needs = Requirement(longest=None if math.isinf(longest) else longest)
    reachable = Reachable(turn, limits)
    shortest = reachable.laws_within(_AMPLE * max(load, request.torque_limit or 0.0, 1.0)).shortest
    if shortest > longest:
        return InputError(
            f"the speed limits allow no cycle shorter than {shortest:.6g} s; {limits.name('cycle_time')} is "
            f"{limits.cycle_time:.6g} s; extend it, or raise a limit"
        )
    slower = "; raise it, or widen the speed limits" + ("" if math.isinf(longest) else ", or extend the cycle time")
    if request.crank_acceleration is not None:
        needed = programme.solve("acceleration", needs)
        if needed is not None and needed.value > 1.0:
            return InputError(
                f"a law within these limits needs a crank acceleration of at least "
                f"{needed.value * request.crank_acceleration:.6g} rad/s^2; {limits.name('crank_acceleration')} is "
                f"{request.crank_acceleration:.6g} rad/s^2{slower}"
            )
    if request.torque_limit is not None:
        mean_torque, name = abs(turn.load_work) / TURN, limits.name("torque_limit")
        if mean_torque > request.torque_limit:
            return InputError(
                f"the loads take {abs(turn.load_work):.6g} J in a turn, a mean torque of {mean_torque:.6g} N m; "
                f"{name} is "
                f"{request.torque_limit:.6g} N m; raise it"
            )
        solved = programme.solve("peak torque", needs)
        by_reachable = reachable.least_torque(request.torque_limit, longest, 0.0)
        least = max(by_reachable, 0.0 if solved is None else solved.value)
        if least > request.torque_limit * (1.0 - _ROUNDING):
            return InputError(
                f"a law within these limits needs a torque of at least {least:.6g} N m; {name} is "
                f"{request.torque_limit:.6g} N m{slower}"
            )
    narrow = [limits.name(field) for field in request.narrowing_fields]
    return InputError(
        "a motion law must be resolved between the speed limits; got a machine whose kinetic energy is too small "
        "compared with the work of its loads, or limits that leave almost no room; state or raise the inertia in "
        f"[drive] (motor_inertia, gear_ratio, flywheel), or widen {' or '.join(narrow) or 'the limits'}"
    )
