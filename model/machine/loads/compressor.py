"""A single-stage compressor or pump with ideal valves."""

from __future__ import annotations

from typing import Any, Literal

from ...errors import InputError
from .cylinder import BACK_PRESSURE, BORE, CLEARANCES, EXPONENTS, HEAD, PISTON_ROD, Cylinder
from .load import Entry, Table

Medium = Literal["gas", "liquid"]


class Compressor(Cylinder):
    """A cylinder that draws in at `low` and delivers at `high` pressure, through valves that open without loss.

    Gas left in the clearance expands before the suction valve opens. A machine that never delivers raises an error if
    its clearance is a ratio; with a clearance volume, delivery depends on the design (`volumetric_efficiency`).
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.high > self.low:
            raise InputError(
                "the discharge pressure must exceed the suction pressure; got "
                f"{1e-5 * self.high:g} bar over {1e-5 * self.low:g} bar; "
                + ("raise the discharge pressure" if self.high == self.low else "swap the two")
            )
        ratio = self.high / self.low
        n = min(self.compression_exponent, self.expansion_exponent)
        if n > 0.0:
            limit = 1.0 / (ratio ** (1.0 / n) - 1.0)
            if self.clearance >= limit:
                raise InputError(
                    f"the clearance must be below {limit:.4g} of the swept volume, or nothing is delivered at "
                    f"{ratio:.4g} times the suction pressure with exponent {n:g}; got {self.clearance:g}; reduce "
                    "the clearance or the pressure ratio"
                )

    @property
    def never_drives(self) -> bool:
        """True."""
        return True

    @property
    def effect_text(self) -> str:
        """It takes work."""
        return "absorbs net work over a cycle"

    @property
    def magnitude_text(self) -> str:
        """Pressures, exponents and size."""
        machine = "pump" if self.compression_exponent == 0.0 else "compressor"
        exponents = (
            ""
            if self.compression_exponent == 0.0
            else f", exponents {self.compression_exponent:.6g} and {self.expansion_exponent:.6g}"
        )
        pressures = f"from {1e-5 * self.low:.6g} to {1e-5 * self.high:.6g} bar"
        return f"{machine} {pressures}{exponents}, {self.bore_and_clearance_text}"


def _compressor_of_table(
    suction: float,
    discharge: float,
    medium: Medium,
    compression_exponent: float,
    expansion_exponent: float,
    **size: Any,
) -> Compressor:
    gas = medium == "gas"
    return Compressor(
        low=suction,
        high=discharge,
        compression_exponent=compression_exponent if gas else 0.0,
        expansion_exponent=expansion_exponent if gas else 0.0,
        **size,
    )


Compressor.tables = (
    Table(
        "suction",
        "CompressorLoad",
        "compressor or pump",
        "The closed cycle of a single-stage compressor or pump with ideal valves; pressures are absolute.",
        (
            BORE,
            Entry("suction", "AbsolutePressure", "absolute intake pressure", "1 bar"),
            Entry("discharge", "AbsolutePressure", "absolute delivery pressure", "8 bar"),
            Entry("medium", ("gas", "liquid"), "what it delivers", "gas", default="gas"),
            *CLEARANCES,
            *EXPONENTS,
            HEAD,
            PISTON_ROD,
            BACK_PRESSURE,
        ),
        {"bore": "70 mm", "suction": "1 bar", "discharge": "8 bar", "clearance": 0.05},
        _compressor_of_table,
        motion="turn",
    ),
)
