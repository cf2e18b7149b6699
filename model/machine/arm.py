"""Arm that a rotating crank drives about a second pivot: slotted, with a ram, or an oscillating cylinder."""

from dataclasses import dataclass

from ..checks import require_numbers
from ..errors import InputError


@dataclass(frozen=True, kw_only=True)
class Arm:
    """The member that turns about the second pivot with the line to the crank's pin.

    mass: kg. centre: distance of its mass centre from the pivot along the line, m. inertia: about the mass centre,
    kg m^2. torque: N m, against its motion. ram: distance, m, from the pivot to a pin that slides in a ram; None
    without one. The ram moves at right angles to the line between both pivots. ram_mass: kg. ram_force: N, against the
    motion of the ram on its slow stroke.
    """

    mass: float = 0.0
    centre: float = 0.0
    inertia: float = 0.0
    torque: float = 0.0
    ram: float | None = None
    ram_mass: float = 0.0
    ram_force: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "mass", "inertia", "torque", phrase="the {} of an arm", least=0.0)
        require_numbers(self, "centre", phrase="the {} of an arm")
        require_numbers(self, "ram", phrase="the distance of a ram's pin", above=0.0, unit="m")
        require_numbers(self, "ram_mass", "ram_force", phrase="the {} of an arm", least=0.0)
        if self.ram is None and (self.ram_mass or self.ram_force):
            raise InputError(
                "mass and force of a ram need the distance of its pin from the arm's pivot; got none; give ram"
            )

    @property
    def text(self) -> str:
        """Stated data of the arm, as text."""
        given = (
            *(("mass", 1.0, "kg"), ("centre", 1e3, "mm"), ("inertia", 1.0, "kg m^2"), ("torque", 1.0, "N m")),
            *(("ram", 1e3, "mm"), ("ram_mass", 1.0, "kg"), ("ram_force", 1.0, "N")),
        )
        numbers = ((name.replace("_", " "), factor, getattr(self, name), unit) for name, factor, unit in given)
        return ", ".join(f"{name} {factor * number:.6g} {unit}" for name, factor, number, unit in numbers if number)
