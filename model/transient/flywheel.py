"""The flywheel for a target coefficient of speed fluctuation: classical estimate, then exact value.

Classical (e.g. Norton, Design of Machinery, 5th ed., section 11.11): with the torque T(theta) that a constant speed w
needs, and the maximum change dE in the energy, the integral of mean T - T, between two angles in the turn,

    J = dE / (delta w^2),    delta = (w_max - w_min) / w_mean.

It holds to first order in delta: T is the torque at constant speed, and the mechanism's own inertia is neglected
compared with J. A root search on steady running, with the speed from the equation of motion, gives the exact J. w_mean
is 2 pi divided by the time of a turn rather than the middle of w_max and w_min: for a crank that nearly stops, delta
may have any value above 1. The search uses 1 / delta, which is nearly linear in J, and 0 if the crank does not complete
the turn.
"""

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ..errors import InputError
from ..linkage.linkage import Linkage
from ..machine.drive import ConstantTorque, Drive
from ..machine.mechanism import Mechanism
from .steady_running import Runner, SteadyRunning

_WIDEST = 60
"""Number of times that the largest trial flywheel is enlarged."""
_BETWEEN = 12
"""Trial flywheels between none and a sufficient one: the smallest is sought, and a larger one need not run more
steadily."""


@dataclass(frozen=True, kw_only=True)
class FlywheelDesign:
    """A flywheel on the crankshaft.

    inertia: kg m^2; 0 if no flywheel is needed. estimate: inertia by the classical method, kg m^2. target: coefficient
    of speed fluctuation. running: steady running with the flywheel. drive: motor with the flywheel.
    """

    inertia: float
    estimate: float
    target: float
    running: SteadyRunning
    drive: Drive

    @property
    def is_needed(self) -> bool:
        """Whether the machine without a flywheel runs less evenly than required."""
        return self.inertia > 0.0


def design_flywheel(
    mechanism: Mechanism, linkage: Linkage, fluctuation: float, drive: Drive | None = None
) -> FlywheelDesign:
    """Return the smallest flywheel that keeps the coefficient of speed fluctuation within the target.

    drive: motor and flywheel, by default those of the mechanism; its flywheel is replaced. Without a drive, the motor
    has the constant torque that maintains the mechanism's speed as the mean. Raises `InputError` for a fluctuation that
    is not between 0 and 1 (from 1 on the crank may stop within the turn), and if no steady running exists.
    """
    from scipy.optimize import brentq

    if not 0.0 < fluctuation < 1.0:
        raise InputError(f"a coefficient of speed fluctuation must lie between 0 and 1; got {fluctuation:g}; try 0.02")
    drive = mechanism.drive if drive is None else drive
    runner = Runner(mechanism, linkage)
    speed = runner.speed if drive is None else runner.balanced_speed(drive)

    def run(flywheel: float) -> SteadyRunning:
        return (
            runner.run_under_constant_torque(flywheel)
            if drive is None
            else runner.run_under_drive(replace(drive, flywheel=flywheel))
        )

    @cache
    def surplus(flywheel: float) -> float:
        """Return 1 / delta minus its target; 1 / delta is 0 if the crank does not complete the turn."""
        try:
            delta = run(flywheel).fluctuation
        except InputError:
            delta = math.inf
        return (1.0 / delta if delta > 0.0 else math.inf) - 1.0 / fluctuation

    estimate = runner.energy_range_at_constant_speed(speed) / (fluctuation * speed**2) if speed else 0.0
    inertia = 0.0
    if not surplus(0.0) >= 0.0:
        if speed and not estimate:
            raise InputError(
                "sizing a flywheel needs a torque that varies over the cycle; got a constant torque and no inertia at "
                "some crank angle, so that any flywheel holds the speed; add masses, or loads that vary"
            )
        enough = 1.1 * estimate
        for _ in range(_WIDEST):
            if surplus(enough) >= 0.0:
                break
            enough *= 1.6
        else:
            run(enough)  # explains the reason if it does not run at all
            raise InputError(
                f"no flywheel up to {enough:.3g} kg m^2 keeps the fluctuation within {fluctuation:g}; allow more"
            )
        sizes = [float(size) for size in np.linspace(0.0, enough, _BETWEEN)]
        least = next(i for i, size in enumerate(sizes) if surplus(size) >= 0.0)
        inertia = float(brentq(surplus, sizes[least - 1], sizes[least], xtol=1e-13 * enough, rtol=1e-13))
    running = run(inertia)
    motor = Drive(motor=ConstantTorque(torque=abs(float(running.motor_torque[0])))) if drive is None else drive
    sized = replace(motor, flywheel=inertia)
    return FlywheelDesign(inertia=inertia, estimate=estimate, target=fluctuation, running=running, drive=sized)
