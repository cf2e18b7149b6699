"""A resistance that grows with the square of the slider speed."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from ...checks import require_numbers
from ...kernel.arithmetic import analytic
from .load import Enters, Entry, Load, Table


@analytic
def _drag_force(position: Any, velocity: Any, way: Any, first: Any, second: Any) -> Any:
    return -first * way * velocity * velocity


@dataclass(frozen=True, kw_only=True)
class Drag(Load):
    """A resistance due to turbulent flow: force = -drag v |v|, with v the slider velocity, N. drag: N s^2/m^2.

    Within a stroke it is -drag v^2 or +drag v^2, which is smooth; at the dead centres its second derivative jumps.
    """

    drag: float

    enters: ClassVar = Enters.FORMULA
    formula: ClassVar = _drag_force
    speed_power: ClassVar = 2
    sizes: ClassVar = ("drag",)
    slots: ClassVar = {"drag": (2, "N s^2/m^2")}

    def __post_init__(self) -> None:
        require_numbers(self, "drag")

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return the coefficient, after unit factors."""
        return (1.0, 1.0, self.drag, 0.0)

    @property
    def has_stroke_dependent_formula(self) -> bool:
        """True, because the formula for one stroke is the negative of that for the other."""
        return True

    @property
    def magnitude_text(self) -> str:
        """The coefficient."""
        return f"drag, {self.drag:.6g} N s^2/m^2"

    @property
    def possible_stroke_forces(self) -> tuple[Sequence[float], Sequence[float]]:
        """Forces at a speed of 1 m/s."""
        return (-self.drag,), (self.drag,)

    @property
    def range_text(self) -> str:
        """Dependence on the speed."""
        return "proportional to the square of the speed"


Drag.tables = (
    Table(
        "drag",
        "DragLoad",
        "resistance proportional to the square of the speed",
        "A resistance proportional to the square of the slider speed, such as that of a fluid.",
        (Entry("drag", "QuadraticDamping", "force per squared speed", "20 N s^2/m^2"),),
        {"drag": "10 N s^2/m^2"},
        Drag,
    ),
)
