"""The inversion with a cylinder that turns in a job file: [cylinder], and what [mechanism] and [motion] say of it."""

from __future__ import annotations

from dataclasses import replace

from ...model.errors import JobError
from ...model.machine.lever import Lever
from ...model.machine.lever_cylinder import Cylinder
from ...model.swing.swing import Swing
from .mechanism import MechanismPart
from .motion import MotionPart
from .value_types import Checked, Clearance, Mass, NonNegativeForce, PositiveLength, Pressure, optional

TURNING_CYLINDER = "turning cylinder"


class CylinderPart(Checked[Cylinder]):
    """The single-stage cylinder of a lever; what is not given is not known."""

    makes = Cylinder

    closed_length: PositiveLength | None = optional("least length between its pins; with it the stroke", "650 mm")
    stroke: PositiveLength | None = optional("stroke of the cylinder; with it the closed length", "430 mm")
    bore: PositiveLength | None = optional("bore, for pressures and flow", "40 mm")
    rod: PositiveLength | None = optional("diameter of the piston rod, for the pulling force and buckling", "25 mm")
    supply_pressure: Pressure | None = optional("greatest pressure above that of the other side", "160 bar")
    seal_friction: NonNegativeForce = optional("force of the seal against the motion", "50 N", default=0.0)
    barrel_mass: Mass = optional("of the barrel, a uniform bar as long as the closed cylinder", "8 kg", default=0.0)
    piston_rod_mass: Mass = optional("of the piston rod, a uniform bar as long as the barrel", "3 kg", default=0.0)
    length_tolerance: Clearance = optional("of the length of the cylinder", "1 mm", default=0.0)


def lever_of(mechanism: MechanismPart, cylinder: CylinderPart | None) -> Lever | None:
    """Return the lever that a job states; None for a slider-crank. Raises `JobError` for keys of the other machine."""
    if mechanism.inversion is None:
        stated = {
            "mechanism.frame_angle": mechanism.frame_angle,
            "mechanism.pin_angle": mechanism.pin_angle or None,
            "cylinder": cylinder,
        }
        for key, value in stated.items():
            if value is not None:
                raise JobError(
                    f"{key}: is for a lever moved by a cylinder that turns; got it for a crank with rod and slider; "
                    f'set [mechanism] inversion = "{TURNING_CYLINDER}", or leave it out'
                )
        return None
    if mechanism.frame_angle is None:
        raise JobError(
            f'mechanism.frame_angle: is missing, but inversion = "{TURNING_CYLINDER}" needs the direction from the '
            "lever's pivot to the cylinder's; add for example frame_angle = \"-60 deg\""
        )
    known = Cylinder() if cylinder is None else cylinder.build()
    return Lever(frame_angle=mechanism.frame_angle, pin_angle=mechanism.pin_angle, cylinder=known)


def swing_of(mechanism: MechanismPart, motion: MotionPart) -> Swing | None:
    """Return the swing of a crank or lever; None for a crank that rotates fully. Raises `JobError`."""
    swing = motion.build()
    if mechanism.inversion is None:
        return swing
    if swing is None:
        raise JobError(
            f'motion: inversion = "{TURNING_CYLINDER}" needs a swing of its lever; got a crank that rotates fully; '
            'add [motion] kind = "swing" with from and to'
        )
    if "driver" in motion.model_fields_set:
        raise JobError(
            f"motion.driver: the cylinder drives the lever; got {swing.driver}; leave it out, and give the tolerance "
            "of the cylinder as length_tolerance in [cylinder]"
        )
    return replace(swing, driver="cylinder")
