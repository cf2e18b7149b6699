"""Ideal engine cycles of two and of four strokes."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, ClassVar

from ...checks import require_numbers
from ...errors import InputError
from .cylinder import BACK_PRESSURE, BORE, EXPONENTS, HEAD, PISTON_ROD, Cylinder
from .load import CYCLE, CycleAngle, Entry, Load, Passage, Table


@dataclass(frozen=True, kw_only=True)
class Engine(Cylinder):
    """A cylinder that is filled at `low` pressure, compresses, and burns at its top at once to `high` pressure.

    The gas expands in the next stroke. At the other dead centre it is changed at once: two strokes make a cycle.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if not (self.clearance > 0.0 and self.clearance_volume == 0.0):
            raise InputError(
                "an engine has its clearance as a share of the swept volume; got "
                f"{self.clearance:g} and {1e6 * self.clearance_volume:g} cm^3; give its compression ratio"
            )
        volumes = 1.0 + 1.0 / self.clearance
        compressed = self.low * volumes**self.compression_exponent
        if not self.high > compressed:
            raise InputError(
                f"the peak pressure must exceed that of compression alone, {1e-5 * compressed:.6g} bar; got "
                f"{1e-5 * self.high:.6g} bar; raise it, or lower the compression ratio or the intake pressure"
            )
        if not self.high / volumes**self.expansion_exponent >= self.low:
            raise InputError(
                f"the gas must not expand below its intake pressure, {1e-5 * self.low:.6g} bar; got "
                f"{1e-5 * self.high / volumes**self.expansion_exponent:.6g} bar at the end of the stroke; raise the "
                "peak pressure, or lower the exponent of expansion"
            )

    @property
    def text(self) -> str:
        """Pressures, exponents and size."""
        return f"two-stroke engine cycle {self._gas_text}, {self.size_text}"

    @property
    def _gas_text(self) -> str:
        exponents = f"exponents {self.compression_exponent:.6g} and {self.expansion_exponent:.6g}"
        return f"from {1e-5 * self.low:.6g} to {1e-5 * self.high:.6g} bar, {exponents}"


@dataclass(frozen=True, kw_only=True)
class FourStroke(Engine):
    """A cylinder that compresses and burns in one turn, as `Engine`, and changes its gas in the next.

    The piston pushes out at the `exhaust` pressure, Pa, and draws in at `low`. A turn begins at the dead centre away
    from the head; compression and expansion are the first one.
    """

    exhaust: float

    slots: ClassVar = {**Cylinder.slots, "exhaust": Cylinder.slots["high"]}
    tables: ClassVar = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        require_numbers(self, "exhaust", what="the {} pressure, absolute,", above=0.0, unit="Pa")

    @property
    def cycle_turns(self) -> int:
        """Two."""
        return 2

    @property
    def cycle_datum(self) -> str:
        """The dead centre away from the head."""
        return "inner dead centre" if self.head == "outer dead centre" else "outer dead centre"

    def on_turn(self, turn: int) -> Load:
        """Return the two-stroke cycle of turn 1, or the change of gas of turn 2, each stroke at constant pressure."""
        own = {field.name: getattr(self, field.name) for field in fields(Cylinder)}
        if turn == 1:
            return Engine(**own)
        return Cylinder(**own | {"high": self.exhaust, "compression_exponent": 0.0, "expansion_exponent": 0.0})

    def number_on_turn(self, name: str, turn: int) -> str | None:
        """Return its name; the exhaust pressure is the high one of turn 2, which has neither peak nor exponents."""
        if turn == 1:
            return None if name == "exhaust" else name
        if name in ("high", "compression_exponent", "expansion_exponent"):
            return None
        return "high" if name == "exhaust" else name

    def stroke_work(self, passage: Passage) -> Any:
        """Return the mean work of both turns."""
        return 0.5 * (self.on_turn(1).stroke_work(passage) + self.on_turn(2).stroke_work(passage))

    @property
    def text(self) -> str:
        """Pressures, exponents and size."""
        return f"four-stroke engine cycle {self._gas_text}, exhaust at {1e-5 * self.exhaust:.6g} bar, {self.size_text}"


def _built(
    cycle: CycleAngle,
    exhaust: float,
    back_pressure: float,
    intake: float,
    compression_ratio: float,
    peak_pressure: float,
    heat: float,
    heat_capacity_ratio: float,
    compression_exponent: float,
    expansion_exponent: float,
    **size: Any,
) -> Engine:
    if not compression_ratio > 1.0:
        raise InputError(f"the compression ratio must exceed 1; got {compression_ratio:g}; 6 to 20 are usual")
    if (peak_pressure > 0.0) == (heat > 0.0):
        raise InputError(
            "an engine cycle has either a peak pressure or heat; got "
            f"{'both' if heat > 0.0 else 'neither'}; give one of peak_pressure and heat"
        )
    compressed = intake * compression_ratio**compression_exponent
    # An ideal gas at constant volume takes the heat (p_h - p_end) V_c / (k - 1); V_c is V_s / (ratio - 1).
    added = heat * (heat_capacity_ratio - 1.0) * (compression_ratio - 1.0)
    size |= {
        "low": intake,
        "high": peak_pressure or compressed + added,
        "clearance": 1.0 / (compression_ratio - 1.0),
        "compression_exponent": compression_exponent,
        "expansion_exponent": expansion_exponent,
        "back_pressure": back_pressure,
    }
    if cycle == "720 deg":
        return FourStroke(exhaust=exhaust or back_pressure, **size)
    if exhaust:
        raise InputError(
            "an exhaust pressure is of a cycle of four strokes; got one with a cycle of 360 deg; add "
            'cycle = "720 deg", or leave the exhaust pressure out'
        )
    return Engine(**size)


Engine.tables = (
    Table(
        "compression_ratio",
        "EngineLoad",
        "ideal engine cycle",
        "The ideal cycle of an engine of two or four strokes, burning at constant volume; pressures are absolute.",
        (
            BORE,
            Entry("compression_ratio", "PositiveRatio", "greatest volume over the least one", 8.0),
            Entry("intake", "AbsolutePressure", "absolute pressure at the start of compression", "1 bar"),
            Entry(
                "peak_pressure",
                "LeastPressure",
                "absolute pressure after burning, at the start of expansion; this or heat",
                "40 bar",
                default=0.0,
            ),
            Entry(
                "heat",
                "EnergyDensity",
                "heat set free at the top per swept volume, J/m^3; this or peak_pressure",
                "1.2 MJ/m^3",
                default=0.0,
            ),
            Entry("heat_capacity_ratio", "PositiveRatio", "of the burning gas, for heat", 1.4, default=1.4),
            CYCLE,
            Entry(
                "exhaust",
                "LeastPressure",
                "absolute pressure of the exhaust stroke, of four strokes; the back pressure where it is left out",
                "1.05 bar",
                default=0.0,
            ),
            *EXPONENTS,
            HEAD,
            PISTON_ROD,
            BACK_PRESSURE,
        ),
        {"bore": "70 mm", "compression_ratio": 8.0, "intake": "1 bar", "peak_pressure": "40 bar"},
        _built,
    ),
)
