"""An ideal engine cycle of two strokes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import InputError
from .cylinder import BACK_PRESSURE, BORE, EXPONENTS, HEAD, PISTON_ROD, Cylinder
from .load import Entry, Table


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
        exponents = f"exponents {self.compression_exponent:.6g} and {self.expansion_exponent:.6g}"
        return (
            f"two-stroke engine cycle from {1e-5 * self.low:.6g} to {1e-5 * self.high:.6g} bar, {exponents}, "
            f"{self.size_text}"
        )


def _built(
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
    return Engine(
        low=intake,
        high=peak_pressure or compressed + added,
        clearance=1.0 / (compression_ratio - 1.0),
        compression_exponent=compression_exponent,
        expansion_exponent=expansion_exponent,
        **size,
    )


Engine.tables = (
    Table(
        "compression_ratio",
        "EngineLoad",
        "ideal two-stroke engine cycle",
        "The ideal cycle of a two-stroke engine, burning at constant volume; pressures are absolute.",
        (
            BORE,
            Entry("compression_ratio", "PositiveRatio", "greatest volume over the least one", 8.0),
            Entry("intake", "Pressure", "absolute pressure at the start of compression", "1 bar"),
            Entry(
                "peak_pressure",
                "LeastPressure",
                "absolute pressure after burning, at the start of expansion; this or heat",
                "40 bar",
                default=0.0,
            ),
            Entry(
                "heat",
                "LeastPressure",
                "heat set free at the top per swept volume, J/m^3; this or peak_pressure",
                "1.2 MJ/m^3",
                default=0.0,
            ),
            Entry("heat_capacity_ratio", "PositiveRatio", "of the burning gas, for heat", 1.4, default=1.4),
            *EXPONENTS,
            HEAD,
            PISTON_ROD,
            BACK_PRESSURE,
        ),
        {"bore": "70 mm", "compression_ratio": 8.0, "intake": "1 bar", "peak_pressure": "40 bar"},
        _built,
    ),
)
