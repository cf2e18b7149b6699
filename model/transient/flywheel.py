"""The flywheel for a wanted coefficient of speed fluctuation: classical estimate, then exact.

Classical (e.g. Norton, Design of Machinery, 5th ed., section 11.11): with the torque T(theta) that a constant speed w
needs, and the greatest change dE of the energy, the integral of mean T - T, between two angles of the turn,

    J = dE / (delta w^2),    delta = (w_max - w_min) / w_mean.

It holds to first order in delta: T is that of the constant speed, and the mechanism's own inertia is neglected beside
J. The exact J is a root search on steady running, whose speed is that of the equation of motion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

from ..errors import InputError
from ..linkage import Linkage
from ..mechanism import Mechanism
from .drive import ConstantTorque, Drive
from .steady import Runner, SteadyRunning

_WIDEST = 25
"""Steps away from the estimate."""
_GREATEST = 2.0
"""No fluctuation reaches it while the crank goes on turning one way; stands for a crank that stops."""


@dataclass(frozen=True, kw_only=True)
class FlywheelDesign:
    """A flywheel on the crank shaft.

    inertia: kg m^2; 0 if none is needed. estimate: by the classical method, kg m^2. wanted: the coefficient of speed
    fluctuation. running: the steady running with it. drive: the motor, with the flywheel in it.
    """

    inertia: float
    estimate: float
    wanted: float
    running: SteadyRunning
    drive: Drive

    @property
    def needed(self) -> bool:
        """Whether the machine runs less evenly than wanted without a flywheel."""
        return self.inertia > 0.0


def design_flywheel(
    mechanism: Mechanism, linkage: Linkage, fluctuation: float, drive: Drive | None = None
) -> FlywheelDesign:
    """Return the least flywheel that keeps the coefficient of speed fluctuation at the wanted one.

    drive: the mechanism's own if None; its flywheel is replaced. Without any, the motor is one of constant torque that
    keeps the mechanism's speed as the mean one. Raises `InputError` for a fluctuation that is not between 0 and 1, and
    where no steady running exists.
    """
    from scipy.optimize import brentq

    if not 0.0 < fluctuation < 1.0:
        raise InputError(f"a coefficient of speed fluctuation must lie between 0 and 1; got {fluctuation:g}; try 0.02")
    drive = mechanism.drive if drive is None else drive
    runner = Runner(mechanism, linkage)
    speed = runner.speed if drive is None else runner.balanced_speed(drive)

    def run(flywheel: float) -> SteadyRunning:
        return runner.constant(flywheel) if drive is None else runner.under(replace(drive, flywheel=flywheel))

    @cache
    def excess(flywheel: float) -> float:
        try:
            return min(run(flywheel).fluctuation, _GREATEST) - fluctuation
        except InputError:
            return _GREATEST

    estimate = runner.energy_change(speed) / (fluctuation * speed**2) if speed else 0.0
    inertia = 0.0
    if excess(0.0) > 0.0:
        low, high = 0.9 * estimate, 1.1 * estimate
        for _ in range(_WIDEST):
            low, high = low * (0.6 if excess(low) < 0.0 else 1.0), high * (1.6 if excess(high) > 0.0 else 1.0)
            if excess(high) <= 0.0 <= excess(low):
                break
        else:
            run(high)  # says why, if it does not run at all
            raise InputError(
                f"no flywheel up to {high:.3g} kg m^2 keeps the fluctuation at {fluctuation:g}; allow more"
            )
        inertia = float(brentq(excess, low, high, xtol=1e-13 * high, rtol=1e-13))
    running = run(inertia)
    motor = Drive(motor=ConstantTorque(torque=abs(float(running.motor_torque[0])))) if drive is None else drive
    return FlywheelDesign(
        inertia=inertia,
        estimate=estimate,
        wanted=fluctuation,
        running=running,
        drive=replace(motor, flywheel=inertia),
    )
