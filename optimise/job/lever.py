"""The turning-cylinder inversion in a job file: [cylinder], [arm], its keys in [mechanism] and [motion]."""

from dataclasses import replace

from ...model.errors import JobError
from ...model.machine.arm import Arm
from ...model.machine.lever import Lever
from ...model.machine.lever_cylinder import Cylinder
from ...model.machine.lever_spring import LeverSpring
from ...model.machine.mounting import Mounting
from ...model.swing.swing import CRANK_TURN, Swing
from .mechanism import MechanismPart
from .motion import MotionPart
from .value_types import (
    Angle,
    Checked,
    Clearance,
    DrivingTorque,
    Force,
    Inertia,
    Length,
    Mass,
    NonNegativeForce,
    PositiveLength,
    Pressure,
    Stiffness,
    optional_entry,
    required_entry,
)

TURNING_CYLINDER = "turning cylinder"


class CylinderPart(Checked[Cylinder]):
    """The single-stage cylinder of a lever; numbers that are not given are unknown."""

    makes = Cylinder

    closed_length: PositiveLength | None = optional_entry("least length between its pins; with it the stroke", "650 mm")
    stroke: PositiveLength | None = optional_entry("stroke of the cylinder; with it the closed length", "430 mm")
    dead_length: PositiveLength | None = optional_entry(
        "instead of a closed length: closed length minus stroke, or minus travel if no stroke is given",
        "210 mm",
    )
    mounting: Mounting = optional_entry(
        "clevis or eye at the end of the barrel, or trunnion, beyond which the barrel extends",
        "trunnion",
        default="clevis",
    )
    bore: PositiveLength | None = optional_entry("bore, for pressures and flow", "40 mm")
    rod: PositiveLength | None = optional_entry(
        "diameter of the piston rod, for the pulling force and buckling", "25 mm"
    )
    supply_pressure: Pressure | None = optional_entry(
        "greatest pressure above the pressure on the other side", "160 bar"
    )
    seal_friction: NonNegativeForce = optional_entry("force of the seal against the motion", "50 N", default=0.0)
    barrel_mass: Mass = optional_entry(
        "of the barrel, a uniform bar as long as the closed cylinder", "8 kg", default=0.0
    )
    piston_rod_mass: Mass = optional_entry(
        "of the piston rod, a uniform bar as long as the barrel", "3 kg", default=0.0
    )
    length_tolerance: Clearance = optional_entry("of the length of the cylinder", "1 mm", default=0.0)


class ArmPart(Checked[Arm]):
    """Slotted arm or oscillating cylinder that a rotating crank turns about the cylinder's pivot."""

    makes = Arm

    mass: Mass = optional_entry("of the arm", "12 kg", default=0.0)
    centre: Length = optional_entry("from the pivot to the arm's mass centre, along its line", "250 mm", default=0.0)
    inertia: Inertia = optional_entry("about its mass centre", "0.5 kg m^2", default=0.0)
    torque: DrivingTorque = optional_entry("on the arm, against its motion", "50 N m", default=0.0)
    ram: PositiveLength | None = optional_entry(
        "from the pivot to a pin that slides in a ram, which moves at right angles to the line between both pivots",
        "500 mm",
    )
    ram_mass: Mass = optional_entry("of the ram", "30 kg", default=0.0)
    ram_force: NonNegativeForce = optional_entry(
        "against the motion of the ram on its slow stroke", "2 kN", default=0.0
    )


class SpringPart(Checked[LeverSpring]):
    """A gas or coil spring between the frame and a lever."""

    makes = LeverSpring

    frame: PositiveLength = required_entry("from the lever's pivot to the spring's pin on the frame", "500 mm")
    frame_angle: Angle = required_entry("direction to that pin, counter-clockwise from +x", "-90 deg")
    lever: PositiveLength = required_entry("from the lever's pivot to the spring's pin on the lever", "300 mm")
    pin_angle: Angle = optional_entry("angle to that pin from the lever's own line", "10 deg", default=0.0)
    force: Force = required_entry("push at its length; below 0 for a pull", "600 N")
    length: PositiveLength = required_entry("length between its pins at which it has the force", "450 mm")
    stiffness: Stiffness = optional_entry("loss of push per unit of extension", "1.2 N/mm", default=0.0)


def lever_of(
    mechanism: MechanismPart, cylinder: CylinderPart | None, arm: ArmPart | None, spring: SpringPart | None
) -> Lever | None:
    """Return the lever that a job states; None for a slider-crank. Raises `JobError` for keys of the other machine."""
    if mechanism.inversion is None:
        stated = {
            "mechanism.frame_angle": mechanism.frame_angle,
            "mechanism.pin_angle": mechanism.pin_angle or None,
            "cylinder": cylinder,
            "arm": arm,
            "spring": spring,
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
            "lever's pivot to the cylinder's; for example, add frame_angle = \"-60 deg\""
        )
    known = Cylinder() if cylinder is None else cylinder.build()
    driven = Arm() if arm is None else arm.build()
    pushing = None if spring is None else spring.build()
    angles = {"frame_angle": mechanism.frame_angle, "pin_angle": mechanism.pin_angle}
    return Lever(**angles, cylinder=known, arm=driven, spring=pushing)


def require_parts_of_lever(mechanism: MechanismPart, **parts: object) -> None:
    """Raise `JobError` if a lever has tables of a job that only a slider-crank has. parts: these tables by name."""
    for name, part in parts.items():
        if mechanism.inversion is not None and part is not None:
            raise JobError(
                f"{name}: is for a crank with rod and slider; got it for a lever moved by a cylinder that turns; leave "
                "it out"
            )


def swing_of(mechanism: MechanismPart, motion: MotionPart) -> Swing | None:
    """Return the swing of a crank or lever; None for a slider-crank whose crank rotates fully. Raises `JobError`."""
    swing = motion.build()
    if mechanism.inversion is None:
        return swing
    if "driver" in motion.model_fields_set:
        raise JobError(
            f"motion.driver: the cylinder drives the lever; got {'crank' if swing is None else swing.driver}; leave it "
            "out, and give the tolerance of the cylinder as length_tolerance in [cylinder]"
        )
    return CRANK_TURN if swing is None else replace(swing, driver="cylinder")
