"""Ideal two-stroke and four-stroke engine cycles, with combustion at constant volume or at limited pressure."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np

from ...checks import require_numbers
from ...errors import InputError
from ...kernel.arithmetic import analytic, inverse, power
from .cylinder import BACK_PRESSURE, BORE, EXPONENTS, HEAD, PISTON_ROD, Cylinder
from .load import CYCLE, CycleAngle, Enters, Entry, Load, Passage, Table

_TYPED = 5e-6  # relative rounding error of a pressure written with six digits


@analytic
def burning_stroke_fraction(clearance: Any, low: Any, high: Any, exponent: Any, heat: Any, kappa: Any) -> Any:
    """Return the fraction of the stroke over which gas burns at its peak pressure `high`.

    Of the heat q per swept volume, (p_h - p_2) c / (kappa - 1) is added at constant volume, starting from the pressure
    p_2 at the end of compression. The remaining heat expands the gas by (kappa - 1) / (kappa p_h) times that heat.
    """
    compressed = low * power((1.0 + clearance) * inverse(clearance), exponent)
    return (heat * (kappa - 1.0) - (high - compressed) * clearance) * inverse(kappa * high)


@dataclass(frozen=True, kw_only=True)
class Engine(Cylinder):
    """A cylinder that fills at `low` pressure, compresses, and burns instantly at the top to `high` pressure.

    The gas expands in the next stroke. At the other dead centre the gas is exchanged instantly, so two strokes form a
    cycle.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if not (self.clearance > 0.0 and self.clearance_volume == 0.0):
            raise InputError(
                "the clearance of an engine must be a fraction of the swept volume; got "
                f"{self.clearance:g} and {1e6 * self.clearance_volume:g} cm^3; give its compression ratio"
            )
        self._require_burning()
        if not self.final_pressure >= self.low:
            raise InputError(
                f"the gas must not expand below its intake pressure, {1e-5 * self.low:.6g} bar; got "
                f"{1e-5 * self.final_pressure:.6g} bar at the end of the stroke; raise the "
                f"{self._raised}, or lower the exponent of expansion"
            )

    every_corner: ClassVar = True
    _raised: ClassVar = "peak pressure"

    def _require_burning(self) -> None:
        if not self.high > self.compression_pressure:
            raise InputError(
                f"the peak pressure must exceed that of compression alone, {1e-5 * self.compression_pressure:.6g} bar; "
                f"got {1e-5 * self.high:.6g} bar; raise it, or lower the compression ratio or the intake pressure"
            )

    @property
    def compression_pressure(self) -> float:
        """Pressure at the end of compression, Pa."""
        return float(self.low * (1.0 + 1.0 / self.clearance) ** self.compression_exponent)

    @property
    def final_pressure(self) -> float:
        """Pressure at the end of expansion, Pa."""
        return float(self.high / (1.0 + 1.0 / self.clearance) ** self.expansion_exponent)

    @property
    def may_drive(self) -> bool:
        """True."""
        return True

    @property
    def effect_text(self) -> str:
        """It gives work."""
        return "delivers more work in expansion than it absorbs in compression"

    @property
    def magnitude_text(self) -> str:
        """Pressures, exponents and size."""
        return f"two-stroke engine cycle {self._gas_text}, {self.bore_and_clearance_text}"

    @property
    def _gas_text(self) -> str:
        exponents = f"exponents {self.compression_exponent:.6g} and {self.expansion_exponent:.6g}"
        return f"from {1e-5 * self.low:.6g} to {1e-5 * self.high:.6g} bar, {exponents}"


@dataclass(frozen=True, kw_only=True)
class LimitedPressure(Engine):
    """An engine with a dual cycle: it burns at the top up to `high` pressure, then continues at that pressure.

    heat: heat released per swept volume, J/m^3. heat_capacity_ratio: heat capacity ratio of the burning gas. Without a
    pressure rise at the top, this is the Diesel cycle.
    """

    heat: float
    heat_capacity_ratio: float = 1.4

    enters: ClassVar = Enters.BURNING_CYLINDER
    slots: ClassVar = {**Cylinder.slots, "heat": (11, "J/m^3"), "heat_capacity_ratio": (12, "")}
    tables: ClassVar = ()
    _raised: ClassVar = "heat"

    def _require_burning(self) -> None:
        require_numbers(self, "heat", phrase="the {}", above=0.0, unit="J/m^3")
        require_numbers(self, "heat_capacity_ratio", phrase="the heat capacity ratio", above=1.0)
        if not self.high >= self.compression_pressure:
            raise InputError(
                f"the peak pressure must not be below that of compression alone, "
                f"{1e-5 * self.compression_pressure:.6g} bar; got {1e-5 * self.high:.6g} bar; raise it, or lower the "
                "compression ratio or the intake pressure"
            )
        k, share = self.heat_capacity_ratio, self.burning_share
        instant_heat = (self.high - self.compression_pressure) * self.clearance / (k - 1.0)
        if share < 0.0:
            reached = self.compression_pressure + self.heat * (k - 1.0) / self.clearance
            raise InputError(
                f"the heat must reach the peak pressure of {1e-5 * self.high:.6g} bar, which takes "
                f"{1e-6 * instant_heat:.6g} MJ/m^3; got {1e-6 * self.heat:.6g} MJ/m^3, which reaches "
                f"{1e-5 * reached:.6g} bar; raise the heat, lower the peak pressure, or leave it out"
            )
        if share > 1.0:
            heat_limit = instant_heat + self.high * k / (k - 1.0)
            raise InputError(
                f"burning must end within the stroke, with at most {1e-6 * heat_limit:.6g} MJ/m^3 of heat; got "
                f"{1e-6 * self.heat:.6g} MJ/m^3; lower the heat, or raise the peak pressure"
            )

    @property
    def burning_share(self) -> float:
        """Fraction of the stroke over which it burns at peak pressure."""
        numbers = self.clearance, self.low, self.high, self.compression_exponent, self.heat, self.heat_capacity_ratio
        return float(burning_stroke_fraction(*numbers))

    @property
    def final_pressure(self) -> float:
        """Pressure at the end of expansion, Pa."""
        burnt = self.clearance + self.burning_share
        return float(self.high * (burnt / (1.0 + self.clearance)) ** self.expansion_exponent)

    def numbers_for_kernel(self) -> tuple[float, ...]:
        """Return the numbers of a cylinder, plus heat and heat capacity ratio."""
        return (*super().numbers_for_kernel(), self.heat, self.heat_capacity_ratio)

    def pressure(self, z: Any, stroke: Any, *, expanding: bool) -> Any:
        """Return the pressure, Pa, when the piston is z from its top, m; broadcasts."""
        h = self.clearance * stroke
        if not expanding:
            return self.low * ((h + stroke) / (h + z)) ** self.compression_exponent
        burnt = h + self.burning_share * stroke
        return self.high * (burnt / np.fmax(burnt, h + z)) ** self.expansion_exponent

    @property
    def _gas_text(self) -> str:
        burning = f"at peak pressure over {100.0 * self.burning_share:.4g} % of the stroke"
        return f"{super()._gas_text}, heat {1e-6 * self.heat:.6g} MJ/m^3, {burning}"


@dataclass(frozen=True, kw_only=True)
class FourStroke(Engine):
    """A cylinder that compresses and burns in one turn, like `Engine`, and exchanges its gas in the next.

    The piston pushes gas out at the `exhaust` pressure, Pa, and draws it in at `low`. A turn begins at the dead centre
    away from the head; compression and expansion are in the first turn.
    """

    exhaust: float

    slots: ClassVar = {**Cylinder.slots, "exhaust": Cylinder.slots["high"]}
    tables: ClassVar = ()
    working: ClassVar[type[Engine]] = Engine
    """The two-stroke cycle of turn 1."""

    def __post_init__(self) -> None:
        super().__post_init__()
        require_numbers(self, "exhaust", phrase="the {} pressure, absolute,", above=0.0, unit="Pa")

    @property
    def cycle_turns(self) -> int:
        """Two."""
        return 2

    @property
    def cycle_datum(self) -> str:
        """The dead centre away from the head."""
        return "inner dead centre" if self.head == "outer dead centre" else "outer dead centre"

    def load_on_turn(self, turn: int) -> Load:
        """Return the two-stroke cycle of turn 1, or the gas exchange of turn 2, at constant pressure in each stroke."""
        if turn == 1:
            return self.working(**{field.name: getattr(self, field.name) for field in fields(self.working)})
        values = {field.name: getattr(self, field.name) for field in fields(Cylinder)}
        return Cylinder(**values | {"high": self.exhaust, "compression_exponent": 0.0, "expansion_exponent": 0.0})

    def name_of_number_on_turn(self, name: str, turn: int) -> str | None:
        """Return its name; the exhaust pressure is the `high` of turn 2, which has neither peak nor exponents."""
        if turn == 1:
            return None if name == "exhaust" else name
        if name in ("high", "compression_exponent", "expansion_exponent", "heat", "heat_capacity_ratio"):
            return None
        return "high" if name == "exhaust" else name

    def work_deciding_loaded_stroke(self, passage: Passage) -> Any:
        """Return the mean work over both turns."""
        return 0.5 * (
            self.load_on_turn(1).work_deciding_loaded_stroke(passage)
            + self.load_on_turn(2).work_deciding_loaded_stroke(passage)
        )

    @property
    def magnitude_text(self) -> str:
        """Pressures, exponents and size."""
        exhaust = f"exhaust at {1e-5 * self.exhaust:.6g} bar"
        return f"four-stroke engine cycle {self._gas_text}, {exhaust}, {self.bore_and_clearance_text}"


@dataclass(frozen=True, kw_only=True)
class FourStrokeLimitedPressure(FourStroke, LimitedPressure):
    """A four-stroke cylinder that burns like `LimitedPressure`."""

    slots: ClassVar = {**FourStroke.slots, **LimitedPressure.slots}
    working: ClassVar = LimitedPressure


def _engine_of_table(
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
    if not (peak_pressure > 0.0 or heat > 0.0):
        raise InputError(
            "an engine cycle must have a peak pressure, heat or both; got neither; add peak_pressure or heat"
        )
    compressed = intake * compression_ratio**compression_exponent
    # An ideal gas at constant volume absorbs the heat (p_h - p_end) V_c / (k - 1); V_c is V_s / (ratio - 1).
    added = heat * (heat_capacity_ratio - 1.0) * (compression_ratio - 1.0)
    size |= {
        "low": intake,
        "high": peak_pressure or compressed + added,
        "clearance": 1.0 / (compression_ratio - 1.0),
        "compression_exponent": compression_exponent,
        "expansion_exponent": expansion_exponent,
        "back_pressure": back_pressure,
    }
    limited = peak_pressure > 0.0 and heat > 0.0
    if limited:
        if abs(peak_pressure - compressed) < _TYPED * compressed:
            size["high"] = compressed
        size |= {"heat": heat, "heat_capacity_ratio": heat_capacity_ratio}
    if cycle == "720 deg":
        return (FourStrokeLimitedPressure if limited else FourStroke)(exhaust=exhaust or back_pressure, **size)
    if exhaust:
        raise InputError(
            'an exhaust pressure needs a four-stroke cycle; got one with a cycle of 360 deg; add cycle = "720 '
            'deg", or leave the exhaust pressure out'
        )
    return (LimitedPressure if limited else Engine)(**size)


Engine.tables = (
    Table(
        "compression_ratio",
        "EngineLoad",
        "ideal engine cycle",
        "The ideal cycle of a two-stroke or four-stroke engine; pressures are absolute. The fuel burns at constant "
        "volume, or at limited pressure if both peak_pressure and heat are given.",
        (
            BORE,
            Entry("compression_ratio", "CompressionRatio", "greatest volume divided by the least", 8.0),
            Entry("intake", "AbsolutePressure", "absolute pressure at the start of compression", "1 bar"),
            Entry(
                "peak_pressure",
                "LeastPressure",
                "greatest absolute pressure during combustion; with heat, the rest of the fuel burns at this pressure",
                "40 bar",
                default=0.0,
            ),
            Entry(
                "heat",
                "HeatPerVolume",
                "heat released per swept volume: at the top, or up to peak_pressure and then at that pressure",
                "1.2 MJ/m^3",
                default=0.0,
            ),
            Entry(
                "heat_capacity_ratio",
                "HeatCapacityRatio",
                "ratio for the burning gas, used with heat",
                1.4,
                default=1.4,
            ),
            CYCLE,
            Entry(
                "exhaust",
                "LeastPressure",
                "absolute pressure of the exhaust stroke in a four-stroke cycle; the back pressure if left out",
                "1.05 bar",
                default=0.0,
            ),
            *EXPONENTS,
            HEAD,
            PISTON_ROD,
            BACK_PRESSURE,
        ),
        {"bore": "70 mm", "compression_ratio": 8.0, "intake": "1 bar", "peak_pressure": "40 bar"},
        _engine_of_table,
        motion="turn",
    ),
)
