"""A mass that moves with the slider: fluid in a pipe, rollers, or a flywheel driven by the slider."""

from dataclasses import dataclass
from typing import ClassVar

from ...checks import require_numbers
from .load import Enters, Entry, Load, Table, load_builder


@dataclass(frozen=True, kw_only=True)
class AddedMass(Load):
    """A force = -mass times the slider's acceleration. mass: kg.

    A column of fluid with density rho, length L and area A ahead of a piston of area A_p: rho L A_p^2 / A. A roller of
    inertia I driven by the slider without slip at radius r: I / r^2. The added mass has no weight here and its reaction
    stays within the machine, so it does not shake the frame. It adds to the kinetic energy and to the inertia reflected
    to the crank, and so also affects start-up and flywheel, but not the load curve.
    """

    mass: float

    enters: ClassVar = Enters.ADDED_MASS
    sizes: ClassVar = ("mass",)
    slots: ClassVar = {"mass": (2, "kg")}

    def __post_init__(self) -> None:
        require_numbers(self, "mass", least=0.0, unit="kg")

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return the mass, after unit factors."""
        return (1.0, 1.0, self.mass, 0.0)

    @property
    def is_conservative(self) -> bool:
        """True, because the kinetic energy repeats."""
        return True

    @property
    def magnitude_text(self) -> str:
        """The mass."""
        return f"added mass, {self.mass:.6g} kg"

    @property
    def effect_text(self) -> str:
        """It opposes acceleration."""
        return "resists acceleration of the slider; does no net work over a cycle"


AddedMass.tables = (
    Table(
        "added_mass",
        "AddedMassLoad",
        "mass that moves with the slider",
        "Fluid or rollers accelerated by the slider: inertia without weight.",
        (Entry("added_mass", "Mass", "mass that moves at the slider's speed", "2 kg"),),
        {"added_mass": "1 kg"},
        load_builder(AddedMass, added_mass="mass"),
    ),
)
