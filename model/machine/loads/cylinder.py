"""A cylinder whose piston is the slider: gas on one side, back pressure on the other."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from ...checks import require_numbers
from ...errors import InputError
from .load import Enters, Entry, Load, Passage, Table, require_word

Head = Literal["outer dead centre", "inner dead centre"]
ATMOSPHERE = 101_325.0
"""Pa, the standard atmosphere (10th CGPM, 1954)."""


_LEAST_EXPONENT = 0.2


def piston_area(bore: float, piston_rod: float) -> float:
    """Return the area of a piston, m^2, with a piston rod on one side.

    Raises `InputError` for a piston rod that leaves no area.
    """
    if piston_rod >= bore:
        raise InputError(
            f"the piston rod must be thinner than the bore; got {1e3 * piston_rod:g} mm in a bore of "
            f"{1e3 * bore:g} mm; give a thinner rod, or leave it out"
        )
    return 0.25 * math.pi * (bore**2 - piston_rod**2)


@dataclass(frozen=True, kw_only=True)
class Cylinder(Load):
    """A cylinder with a two-stroke cycle: compression towards its head, expansion away from it. SI, absolute.

    bore, piston_rod: diameters, m; the piston area is that of the bore minus that of the rod. head: dead centre with
    the minimum volume: gas beyond the outer one pushes inward. clearance: minimum volume divided by swept volume;
    clearance_volume: additional volume, m^3. low: pressure at the start of compression, and minimum pressure in
    expansion. high: pressure at the start of expansion, and maximum pressure in compression. compression_exponent,
    expansion_exponent: n in p V^n = const; both zero for a liquid, whose pressure jumps at the dead centres.
    back_pressure: pressure on the other side of the piston.
    """

    bore: float
    low: float
    high: float
    clearance: float = 0.0
    clearance_volume: float = 0.0
    compression_exponent: float
    expansion_exponent: float
    back_pressure: float = ATMOSPHERE
    piston_rod: float = 0.0
    head: Head = "outer dead centre"

    enters: ClassVar = Enters.CYLINDER
    slots: ClassVar = {
        "bore": (2, "m"),
        "piston_rod": (3, "m"),
        "clearance": (4, ""),
        "clearance_volume": (5, "m^3"),
        "low": (6, "Pa"),
        "high": (7, "Pa"),
        "compression_exponent": (8, ""),
        "expansion_exponent": (9, ""),
        "back_pressure": (10, "Pa"),
    }
    tables: ClassVar[tuple[Table, ...]] = ()

    def __post_init__(self) -> None:
        require_numbers(self, "bore", phrase="the {}", above=0.0, unit="m")
        require_numbers(self, "piston_rod", phrase="the diameter of the piston rod", least=0.0, unit="m")
        require_numbers(self, "clearance", "clearance_volume", phrase="the {}", least=0.0)
        require_numbers(self, "low", "high", phrase="the {} pressure, absolute,", above=0.0, unit="Pa")
        require_numbers(self, "back_pressure", phrase="the back pressure, absolute,", least=0.0, unit="Pa")
        require_numbers(self, "compression_exponent", "expansion_exponent", phrase="the {}", least=0.0)
        for exponent in (self.compression_exponent, self.expansion_exponent):
            if 0.0 < exponent < _LEAST_EXPONENT:
                raise InputError(
                    f"an exponent of p V^n must be at least {_LEAST_EXPONENT:g}, or zero for a liquid; got "
                    f"{exponent:g}; 1 is isothermal, 1.4 adiabatic for air"
                )
        require_word("head", self.head, Head)
        piston_area(self.bore, self.piston_rod)
        if (self.compression_exponent == 0.0) != (self.expansion_exponent == 0.0):
            raise InputError(
                f"both exponents must be zero, for a liquid, or neither; got {self.compression_exponent:g} and "
                f"{self.expansion_exponent:g}"
            )

    @property
    def datum(self) -> Head:
        """Dead centre from which the piston's distance from its top is counted."""
        return self.head

    @property
    def area(self) -> float:
        """Area of the piston, m^2."""
        return piston_area(self.bore, self.piston_rod)

    def numbers_for_kernel(self) -> tuple[float, ...]:
        """Return unit factors, then the numbers in `slots`."""
        return (1.0, 1.0, *(getattr(self, name) for name in Cylinder.slots))

    @property
    def has_stroke_dependent_formula(self) -> bool:
        """True, because gas expands in one stroke and is compressed in the other."""
        return True

    def work_deciding_loaded_stroke(self, passage: Passage) -> Any:
        """Return the work done by gas and back pressure."""
        inner = passage.distance.min(axis=1, keepdims=True)
        outer = passage.distance.max(axis=1, keepdims=True)
        at, stroke = 0.5 * (passage.distance[:, 1:] + passage.distance[:, :-1]), outer - inner
        z, sign = (outer - at, -1.0) if self.head == "outer dead centre" else (at - inner, 1.0)
        expanding = passage.outward == (sign > 0.0)
        pressure = self.pressure(np.asarray(z), stroke, expanding=expanding)
        return passage.work_of_force(sign * self.area * (pressure - self.back_pressure))

    def pressure(self, z: Any, stroke: Any, *, expanding: bool) -> Any:
        """Return the pressure, Pa, when the piston is z from its top, m; broadcasts."""
        if self.compression_exponent == 0.0:
            return (self.low if expanding else self.high) + 0.0 * z
        h = self.clearance * stroke + self.clearance_volume / self.area
        with np.errstate(divide="ignore", invalid="ignore"):  # at the top itself without clearance
            if expanding:
                return np.fmax(self.low, self.high * (h / (h + z)) ** self.expansion_exponent)
            return np.fmin(self.high, self.low * ((h + stroke) / (h + z)) ** self.compression_exponent)

    @property
    def bore_and_clearance_text(self) -> str:
        """A short description of bore, clearance and head."""
        parts = [f"bore {1e3 * self.bore:.6g} mm"]
        parts += [f"piston rod {1e3 * self.piston_rod:.6g} mm"] if self.piston_rod else []
        parts += [f"clearance {100.0 * self.clearance:.6g} %"] if self.clearance or not self.clearance_volume else []
        parts += [f"clearance {1e6 * self.clearance_volume:.6g} cm^3"] if self.clearance_volume else []
        return f"{', '.join(parts)}, head at the {self.head}, {1e-5 * self.back_pressure:.6g} bar behind the piston"


BORE = Entry("bore", "PositiveLength", "bore of the cylinder", "70 mm")
CLEARANCES = (
    Entry("clearance", "Fraction", "least volume divided by the swept volume", 0.05, default=0.0),
    Entry("clearance_volume", "Volume", "least volume, added to that from the ratio", "8 cm^3", default=0.0),
)
BACK_PRESSURE = Entry(
    "back_pressure",
    "LeastPressure",
    "absolute pressure on the other side of the piston; the standard atmosphere if left out",
    "1 bar",
    default=ATMOSPHERE,
)
PISTON_ROD = Entry("piston_rod", "Radius", "diameter of a piston rod on this side", "20 mm", default=0.0)
HEAD = Entry(
    "head",
    ("outer dead centre", "inner dead centre"),
    "the dead centre with the least volume; a head at the outer one lets gas push the slider inward",
    "outer dead centre",
    default="outer dead centre",
)
EXPONENTS = (
    Entry("compression_exponent", "GasExponent", "n of p V^n = const in compression", 1.3, default=1.3),
    Entry("expansion_exponent", "GasExponent", "n of p V^n = const in expansion", 1.3, default=1.3),
)
PRESSURES = (
    BORE,
    Entry(
        "pressures",
        "LeastPressure",
        "absolute pressure at each point",
        ["8 bar", "1 bar"],
        several=True,
    ),
    HEAD,
    PISTON_ROD,
    BACK_PRESSURE,
)
"""Entries in a table of pressures, besides the locations."""


def piston_forces(
    places: tuple[float, ...],
    *,
    bore: float,
    piston_rod: float,
    pressures: tuple[float, ...],
    back_pressure: float,
    head: Head,
) -> tuple[float, ...]:
    """Return the forces, N outward, that pressures exert on a piston, less the back pressure on its other side.

    places: one location for each pressure. Raises `InputError` for more or fewer locations, and as `piston_area` does.
    """
    if len(places) != len(pressures):
        raise InputError(
            f"a table needs one pressure for each of its points; got {len(pressures)} pressures at {len(places)} "
            "points; add what is missing"
        )
    area = piston_area(bore, piston_rod)
    return tuple(
        (-area if head == "outer dead centre" else area) * (pressure - back_pressure) for pressure in pressures
    )
