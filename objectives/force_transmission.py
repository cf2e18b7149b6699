"""Transmission of force: the minimum transmission angle, the force transmission, and the self-locking margin.

The transmission angle lies between the rod and the normal of the slider line. The margin is its distance from the
friction angles. The force transmission is the maximum force that moves the slider divided by that of the rod on it.
"""

import numpy as np

from ..model.cycle.self_locking import locking_margin_with_variables
from ..model.kinematics import geometry
from ..model.kinematics.closed_forms import ClosedForm
from ..model.machine.mechanism import Mechanism
from ..model.machine.work_absorption import carries_linkage_forces, has_slider_loads
from ..model.signals.peaks import Peaks, find_peaks
from ..model.signals.signals import Signal
from .bounds_over_ranges import LengthRanges, QuantityBounds
from .closed_form import ClosedFormQuantity
from .kinds import ANGLE, RATIO
from .machine_needs import FRICTION, Need
from .quantity import Array, Domain, Group, Pieces, Quantity, Values


def _transmission_angle_bounds(box: LengthRanges) -> tuple[float, float]:
    flattest = geometry.least_transmission_angle(box.r1, box.l0, box.a1) if box.rotates_fully_throughout else 0.0
    return float(flattest), float(geometry.least_transmission_angle(box.r0, box.l1, box.a0))


TRANSMISSION_ANGLE = ClosedFormQuantity(
    name="transmission_angle",
    key="least_transmission_angle",
    title="least transmission angle",
    kind=ANGLE,
    forms=(ClosedForm.TRANSMISSION_ANGLE,),
    rises=(False, True, False),
    place=30,
    group=Group.PROPORTIONS,
    sentence=(
        "The transmission angle is the angle between the rod and the normal of the slider line; its least value "
        "over the turn shows how well the rod pushes the slider along its guide rather than against it."
    ),
    advice="90 deg is ideal; least values of 30 to 50 deg are usual. A longer rod raises it; an offset lowers it.",
    formula="cos(mu_min) = (r + |e|) / l",
    picture="transmission angle",
    example="40 deg",
    better="high",
    domain=Domain.of_acute_angle("the least transmission angle must lie between 0 and 90 deg", "30 to 50 deg"),
    # Torque and error grow without bound towards locking.
    floor=float(np.radians(10.0)),
    bounds=QuantityBounds(
        compute=_transmission_angle_bounds,
        to_raise="a longer rod, a shorter crank or a smaller |offset|",
        to_lower="a shorter rod, a longer crank or a larger |offset|",
    ),
    offered=("requirement", "objective"),
)


class ForceTransmission(Quantity):
    """max |B_x| / max |B| over the cycle, where B is the force between rod and slider.

    For a massless rod under a constant force, this is the minimum of |B_x| / |B| over the cycle: the sine of the
    minimum transmission angle. In general that minimum would be 0 for nearly every machine: inertia reverses B_x during
    the turn while the rod's own mass maintains B_y. The ratio of the peaks is always the useful fraction of the force
    for which the rod and its pin are sized. Each peak is exact over the continuous crank angle; -inf where friction
    locks the linkage.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        peaks = [
            find_peaks(mechanism, signal, dimensions, gradients=gradients, limit=1)
            for signal in (Signal.LINE_FORCE, Signal.SLIDER_PIN_FORCE)
        ]
        values, slopes = _force_ratios(*peaks)
        return Values(values[:, 0], slopes[:, 0] if gradients else None)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the ratios for the highest local peaks of |B|; the minimum is the quantity; see `Quantity`."""
        line_peaks = find_peaks(mechanism, Signal.LINE_FORCE, dimensions, gradients=True, limit=1)
        pin_peaks = find_peaks(mechanism, Signal.SLIDER_PIN_FORCE, dimensions, gradients=True)
        return Pieces(*_force_ratios(line_peaks, pin_peaks), pin_peaks.angles, least=True)


def _force_ratios(line_peaks: Peaks, pin_peaks: Peaks) -> tuple[Array, Array]:
    """Return ratios (n, k) and their gradients: +inf for absent peaks, -inf where friction locks the linkage."""
    present = np.isfinite(pin_peaks.values)
    pin_forces = np.where(present & (pin_peaks.values > 0.0), pin_peaks.values, np.nan)
    ratios = line_peaks.values / pin_forces
    values = np.where(present, ratios, -pin_peaks.values)
    if line_peaks.gradients is None or pin_peaks.gradients is None:
        return values, np.empty(0)
    slopes = (line_peaks.gradients - ratios[:, :, None] * pin_peaks.gradients) / pin_forces[:, :, None]
    return values, np.where(present[:, :, None], slopes, 0.0)


def _slider_needs_force(machine: Mechanism) -> bool:
    m = machine.with_largest_variables
    inert = m.slider_mass > 0.0 and (m.speed != 0.0 or m.acceleration != 0.0 or m.gravity[0] != 0.0)
    return inert or has_slider_loads(m) or (m.friction.acts and carries_linkage_forces(m))


FORCE_TRANSMISSION = ForceTransmission(
    name="force_transmission",
    kind=RATIO,
    place=300,
    group=Group.PROPORTIONS,
    sentence="The greatest force that moves the slider, divided by the greatest rod force needed for it.",
    advice=(
        "1 is ideal; the remaining force only presses the slider against its guide. The rod's own inertia lowers it."
    ),
    formula="max |B_x| / max |B|; sin(mu_min) for a constant force and a rod without mass",
    section="8. Dynamics",
    picture="slider pin force",
    example=0.5,
    better="high",
    domain=Domain.of_fraction("force transmission", "0.5 to 0.9"),
    needs=(
        Need(
            _slider_needs_force,
            "it needs forces along the slider line; got none; for example, add "
            '[mechanism] slider = { mass = "0.8 kg" } with a speed, or a [[load]]',
            consequence="undefined",
        ),
    ),
)


class SelfLockingMargin(Quantity):
    """Minimum transmission angle minus the friction angles; -inf if the pins alone lock the linkage (no such angle)."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values, slopes = locking_margin_with_variables(mechanism, dimensions, gradients=gradients)
        return Values(values, slopes)


SELF_LOCKING_MARGIN = SelfLockingMargin(
    name="self_locking_margin",
    title="self-locking margin",
    kind=ANGLE,
    place=200,
    group=Group.PROPORTIONS,
    sentence=(
        "The margin of the least transmission angle over the angle at which friction locks the linkage, so that no "
        "torque can drive it."
    ),
    advice="It must stay above 0; 10 deg or more is usual. Without friction it is undefined.",
    formula="mu_min - arctan(f) - arcsin((rho_A + rho_B) / l): friction f of the guide, friction circles rho",
    section="15. Self-locking",
    picture="self-locking",
    example="10 deg",
    better="high",
    domain=Domain.of_acute_angle(
        "the self-locking margin must lie between 0, where friction locks, and 90 deg", "10 deg and more"
    ),
    floor=float(np.radians(5.0)),  # forces grow as 1 / sin(margin)
    needs=(FRICTION,),
    instead=TRANSMISSION_ANGLE.name,
)
