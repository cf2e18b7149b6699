"""A linear spring between the slider and the frame."""

from dataclasses import dataclass
from typing import ClassVar

from ...checks import require_numbers
from .load import DATUM, Datum, Enters, Entry, Load, Table, load_builder, require_word
from .load_text import spring_effect


@dataclass(frozen=True, kw_only=True)
class Spring(Load):
    """A linear spring: force = -stiffness (position - free_position), N, position counted outward from the datum.

    stiffness: N/m. free_position: m. datum: a dead centre moves with the design. From the outer dead centre, both the
    position and the restoring force are positive inward: the spring is the same, and only its rest point moves.
    """

    stiffness: float
    free_position: float = 0.0
    datum: Datum = "crank pivot"

    enters: ClassVar = Enters.SPRING
    sizes: ClassVar = ("stiffness",)
    slots: ClassVar = {"stiffness": (2, "N/m"), "free_position": (3, "m")}

    def __post_init__(self) -> None:
        require_numbers(self, "stiffness", "free_position")
        require_word("datum", self.datum, Datum)

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return stiffness and free position, after unit factors."""
        return (1.0, 1.0, self.stiffness, self.free_position)

    @property
    def is_conservative(self) -> bool:
        """True."""
        return True

    @property
    def effect_text(self) -> str:
        """Effect on motion away from its free position, and back."""
        return spring_effect(self.stiffness)

    @property
    def magnitude_text(self) -> str:
        """Stiffness and free position."""
        return f"spring {self.stiffness:.6g} N/m, free at {1e3 * self.free_position:.6g} mm from the {self.datum}"


Spring.tables = (
    Table(
        "stiffness",
        "SpringLoad",
        "spring",
        "A linear spring between slider and frame.",
        (
            Entry("stiffness", "Stiffness", "of the spring", "20 N/mm"),
            Entry("free_position", "Length", "slider position at which the spring is relaxed", "25 mm"),
            DATUM,
        ),
        {"stiffness": "1 N/mm", "free_position": "0 mm", "measured_from": "inner dead centre"},
        load_builder(Spring, measured_from="datum"),
    ),
)
