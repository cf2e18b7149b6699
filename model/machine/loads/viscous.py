"""A resistance proportional to the slider speed."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from ...checks import require_numbers
from .load import Enters, Entry, Load, Table, load_builder


@dataclass(frozen=True, kw_only=True)
class Viscous(Load):
    """A viscous resistance: force = -coefficient velocity. coefficient: N s/m."""

    coefficient: float

    enters: ClassVar = Enters.VISCOUS
    speed_power: ClassVar = 1
    sizes: ClassVar = ("coefficient",)
    slots: ClassVar = {"coefficient": (2, "N s/m")}

    def __post_init__(self) -> None:
        require_numbers(self, "coefficient")

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return the coefficient, after unit factors."""
        return (1.0, 1.0, self.coefficient, 0.0)

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return the coefficient."""
        return {Viscous: (self.coefficient,)} if moving else {}

    @property
    def magnitude_text(self) -> str:
        """The coefficient."""
        return f"viscous, {self.coefficient:.6g} N s/m"

    @property
    def possible_stroke_forces(self) -> tuple[Sequence[float], Sequence[float]]:
        """Forces at a speed of 1 m/s."""
        return (-self.coefficient,), (self.coefficient,)

    @property
    def range_text(self) -> str:
        """Dependence on the speed."""
        return "proportional to the speed"


Viscous.tables = (
    Table(
        "viscous",
        "ViscousLoad",
        "damper",
        "A resistance proportional to the slider speed.",
        (Entry("viscous", "Damping", "force per speed", "50 N s/m"),),
        {"viscous": "10 N s/m"},
        load_builder(Viscous, viscous="coefficient"),
    ),
)
