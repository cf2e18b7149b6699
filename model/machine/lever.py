"""A lever and a cylinder that turns, as a machine: the slider-crank with its rod fixed as the frame."""

import math
from dataclasses import dataclass
from typing import Any

from ..checks import require_field_types, require_numbers
from ..errors import InputError
from .arm import Arm
from .lever_cylinder import Cylinder
from .lever_spring import LeverSpring


@dataclass(frozen=True, kw_only=True)
class Lever:
    """Data of a lever besides crank (the lever), rod (the frame) and offset.

    frame_angle: direction from the lever's pivot to the cylinder's, rad from +x. pin_angle: angle from the crank's own
    line to its pin, rad. cylinder: its known data. arm: the arm that the cylinder's line turns if the crank rotates
    fully. spring: spring on the lever, if any.
    """

    frame_angle: float
    pin_angle: float = 0.0
    cylinder: Cylinder = Cylinder()
    arm: Arm = Arm()
    spring: LeverSpring | None = None

    def __post_init__(self) -> None:
        require_numbers(self, "frame_angle", "pin_angle", phrase="the {} of a lever")
        parts = {"cylinder": Cylinder, "arm": Arm, "spring": LeverSpring | None}
        require_field_types(self, parts, "tables of a job state them")

    @property
    def has_masses(self) -> bool:
        """Whether the cylinder or the arm has a mass."""
        cylinder, arm = self.cylinder, self.arm
        return any((cylinder.barrel_mass, cylinder.piston_rod_mass, arm.mass, arm.ram_mass))

    @property
    def texts(self) -> list[str]:
        """Sentences on frame and cylinder."""
        pin = f", pin {math.degrees(self.pin_angle):.6g} deg from the crank's line" if self.pin_angle else ""
        frame = f"the rod is the frame, at {math.degrees(self.frame_angle):.6g} deg from the lever's pivot{pin}"
        arm = [] if self.arm == Arm() else [f"arm: {self.arm.text}"]
        arm += [] if self.spring is None else [f"spring: {self.spring.text}"]
        return [frame, *([] if self.cylinder == Cylinder() else [f"cylinder: {self.cylinder.text}"]), *arm]


def require_lever_alone(machine: Any) -> None:
    """Raise `InputError` for features of a slider-crank that a lever does not have. machine: a `Mechanism`."""
    tolerances = machine.tolerances
    features = {
        "mechanism.acceleration": machine.acceleration,
        "mechanism.speed_profile": machine.speed_profile,
        "mechanism.rod": machine.rod != type(machine)().rod,
        "mechanism.slider": machine.slider_mass or machine.slider != type(machine)().slider,
        "mechanism.cylinders": machine.arrangement,
        'mechanism.branch = "crossed"': machine.branch == "crossed",
        "[[load]]": machine.loads,
        "[drive]": machine.drive,
        "[friction]": machine.friction != type(machine)().friction,
        "[clearance]": machine.clearance,
        "[sections]": machine.strength,
        "tolerances.crank_angle": tolerances.crank_angle.absolute,
        "tolerances.clearances": tolerances.clearances != type(tolerances)().clearances,
    }
    stated = [name for name, value in features.items() if value]
    if stated:
        raise InputError(
            'inversion = "turning cylinder" has a lever and a cylinder, but neither rod nor slider; '
            f"got {', '.join(stated)}; leave it out"
        )
