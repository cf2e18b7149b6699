"""A gas or coil spring between the frame and a lever."""

import math
from dataclasses import dataclass

from ..checks import require_numbers
from ..errors import InputError


@dataclass(frozen=True, kw_only=True)
class LeverSpring:
    """A spring that pushes between a pin on the frame and one on the lever.

    frame, frame_angle: distance, m, and direction, rad from +x, of the frame's pin from the lever's pivot. lever,
    pin_angle: distance of the lever's pin from there, and its angle from the lever's own line. force: push at a length
    between both pins, N and m, below 0 for a pull. stiffness: loss of push per unit of extension, N/m.
    """

    frame: float
    frame_angle: float
    lever: float
    force: float
    length: float
    pin_angle: float = 0.0
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "frame", "lever", "length", phrase="the {} of a lever's spring", above=0.0, unit="m")
        require_numbers(self, "frame_angle", "pin_angle", "force", phrase="the {} of a lever's spring")
        require_numbers(self, "stiffness", phrase="the {} of a lever's spring", least=0.0, unit="N/m")
        if self.frame == self.lever:
            raise InputError(
                "the pins of a lever's spring must be at different distances from the lever's pivot, as they could "
                f"meet; got {1e3 * self.frame:.6g} mm for both; move one of them"
            )

    @property
    def text(self) -> str:
        """Places and force, as text."""
        soft = f", {1e-3 * self.stiffness:.6g} N/mm" if self.stiffness else ""
        return (
            f"pins {1e3 * self.frame:.6g} mm at {math.degrees(self.frame_angle):.6g} deg on the frame and "
            f"{1e3 * self.lever:.6g} mm at {math.degrees(self.pin_angle):.6g} deg on the lever, "
            f"{self.force:.6g} N at {1e3 * self.length:.6g} mm{soft}"
        )
