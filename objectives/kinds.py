"""Kinds of physical values and their display units: one table for files, tables, figures and the page.

SI inside, always. A metric face is what columns and JSON have; an inch face what a reader of US customary units asks
for: inch, pound-mass, pound-force, second, and what is made of these; horsepower and psi where the field has them.
Factors are exact to rounding: inch and pound are defined (international, 1959), pound-force by the standard
acceleration of gravity (3rd CGPM, 1901), horsepower as 550 foot-pounds-force a second.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Literal

System = Literal["metric", "inch"]
"""Systems of units that values are shown in. Inch: US customary units of machine design, lengths in inches."""


@dataclass(frozen=True)
class Face:
    """Unit of a kind in a system. symbol: of the unit. suffix: of columns in it. factor: what one SI unit is in it."""

    symbol: str
    suffix: str
    factor: float = 1.0


def face(symbol: str, factor: float = 1.0) -> Face:
    """Return the face of a unit whose columns end as its symbol says: rad/s^2 in _rad_s2."""
    plain = symbol.replace("N m", "Nm").replace("^", "").replace("*", "_")
    name = re.sub(r"[^A-Za-z0-9]+", "_", plain).strip("_")
    return Face(symbol, f"_{name}" if name else "", factor)


@dataclass(frozen=True)
class Kind:
    """A kind of physical value.

    name: with its article, "a length". unit: the SI unit, "" if none. example: as a job file has it.
    limit: the greatest magnitude in SI that is believed. It lies orders beyond any machine: what exceeds it is a
    mistaken unit (80 Mm for 80 mm), and products of several values stay far from the ends of a double.
    metric, inch: how it is shown; inch is None where both systems use the same unit.
    typed: units that a form offers, the SI unit first; usual: the one that it begins with, the metric one if left out.
    """

    name: str
    unit: str
    example: str
    limit: float
    metric: Face
    inch: Face | None = None
    typed: tuple[str, ...] = ()
    usual: str = ""

    @property
    def plain(self) -> str:
        """The name without its article: "length"."""
        return self.name.split(" ", 1)[-1]


_INCH = 0.0254
_PER_INCH = 1.0 / _INCH
_POUND = 0.45359237
_LBF = 4.4482216152605
# Name, SI unit, example, limit, metric face, inch face, units of a form.
LENGTH = Kind(
    "a length", "m", "80 mm", 1e4, face("mm", 1e3), face("in", _PER_INCH), ("m", "mm", "cm", "µm", "in", "foot")
)
AREA = Kind(
    "an area", "m^2", "0.25 m^2", 1e8, face("m^2"), face("in^2", 1.0 / _INCH**2), ("m^2", "cm^2", "mm^2", "in^2")
)
ANGLE = Kind("an angle", "rad", "0.1 deg", 1e4, face("deg", 57.29577951308232), None, ("rad", "deg"))
ANGULAR_SPEED = Kind(
    "an angular speed", "rad/s", "300 rpm", 1e6, face("rpm", 9.549296585513721), None, ("rad/s", "rpm", "rev/s")
)
ANGULAR_ACCELERATION = Kind(
    "an angular acceleration", "rad/s^2", "20 rad/s^2", 1e9, face("rad/s^2"), None, ("rad/s^2", "deg/s^2")
)
MASS = Kind("a mass", "kg", "0.8 kg", 1e8, face("kg"), face("lb", 1.0 / _POUND), ("kg", "g", "t", "lb"))
INERTIA = Kind(
    name="a moment of inertia",
    unit="kg m^2",
    example="0.015 kg m^2",
    limit=1e12,
    metric=face("kg m^2"),
    inch=face("lb in^2", 1.0 / (_POUND * _INCH**2)),
    typed=("kg m^2", "kg mm^2", "lb in^2"),
)
DENSITY = Kind(
    name="a density",
    unit="kg/m^3",
    example="7800 kg/m^3",
    limit=1e6,
    metric=face("kg/m^3"),
    inch=face("lb/in^3", _INCH**3 / _POUND),
    typed=("kg/m^3", "g/cm^3", "lb/in^3"),
)
SPEED = Kind("a speed", "m/s", "2.5 m/s", 1e6, face("m/s"), face("in/s", _PER_INCH), ("m/s", "mm/s", "in/s"))
ACCELERATION = Kind(
    "an acceleration",
    "m/s^2",
    "9.81 m/s^2",
    1e9,
    face("m/s^2"),
    face("in/s^2", _PER_INCH),
    ("m/s^2", "mm/s^2", "in/s^2"),
)
FORCE = Kind("a force", "N", "200 N", 1e12, face("N"), face("lbf", 1.0 / _LBF), ("N", "kN", "lbf"))
TORQUE = Kind(
    name="a torque",
    unit="N m",
    example="25 N m",
    limit=1e15,
    metric=face("N m"),
    inch=face("lbf in", 1.0 / (_LBF * _INCH)),
    typed=("N m", "kN m", "N mm", "lbf in", "lbf ft"),
)
POWER = Kind("a power", "W", "250 W", 1e15, face("W"), face("hp", 1.0 / (6600.0 * _LBF * _INCH)), ("W", "kW", "hp"))
STIFFNESS = Kind(
    name="a stiffness",
    unit="N/m",
    example="20 N/mm",
    limit=1e15,
    metric=Face("N/m", "_N_per_m"),
    inch=Face("lbf/in", "_lbf_per_in", _INCH / _LBF),
    typed=("N/m", "N/mm", "lbf/in"),
    usual="N/mm",
)
ANGULAR_STIFFNESS = Kind(
    name="an angular stiffness",
    unit="N m/rad",
    example="40 N m/rad",
    limit=1e15,
    metric=Face("N m/rad", "_Nm_per_rad"),
    inch=Face("lbf in/rad", "_lbf_in_per_rad", 1.0 / (_LBF * _INCH)),
    typed=("N m/rad", "N m/deg", "lbf in/rad"),
)
DAMPING = Kind(
    name="a viscous coefficient",
    unit="N s/m",
    example="50 N s/m",
    limit=1e15,
    metric=Face("N s/m", "_Ns_per_m"),
    inch=Face("lbf s/in", "_lbf_s_per_in", _INCH / _LBF),
    typed=("N s/m", "N s/mm", "lbf s/in"),
)
QUADRATIC_DAMPING = Kind(
    name="a coefficient of drag",
    unit="N s^2/m^2",
    example="20 N s^2/m^2",
    limit=1e15,
    metric=Face("N s^2/m^2", "_Ns2_per_m2"),
    inch=Face("lbf s^2/in^2", "_lbf_s2_per_in2", _INCH**2 / _LBF),
    typed=("N s^2/m^2", "N s^2/mm^2", "lbf s^2/in^2"),
)
PRESSURE = Kind(
    name="a pressure",
    unit="Pa",
    example="207 GPa",
    limit=1e15,
    metric=face("MPa", 1e-6),
    inch=face("psi", _INCH**2 / _LBF),
    typed=("Pa", "kPa", "bar", "MPa", "GPa", "psi"),
)
PRESSURE_SPEED = Kind(
    name="a pressure times a speed",
    unit="Pa m/s",
    example="1 MPa m/s",
    limit=1e15,
    metric=face("MPa m/s", 1e-6),
    inch=face("psi ft/min", 60.0 * _INCH / (12.0 * _LBF)),
    typed=("Pa m/s", "MPa m/s", "psi ft/min"),
    usual="MPa m/s",
)
WEAR = Kind(
    name="a wear coefficient",
    unit="m^2/N",
    example="1e-9 mm^2/N",
    limit=1.0,
    metric=face("mm^2/N", 1e6),
    inch=face("in^2/lbf", _LBF / _INCH**2),
    typed=("m^2/N", "mm^2/N", "in^2/lbf"),
    usual="mm^2/N",
)
VOLUME = Kind(
    name="a volume",
    unit="m^3",
    example="250 cm^3",
    limit=1e12,
    metric=face("cm^3", 1e6),
    inch=face("in^3", 1.0 / _INCH**3),
    typed=("m^3", "cm^3", "mm^3", "in^3"),
)
ENERGY = Kind(
    name="an energy",
    unit="J",
    example="60 J",
    limit=1e15,
    metric=face("J"),
    inch=face("ft lbf", 1.0 / (12.0 * _LBF * _INCH)),
    typed=("J", "kJ", "ft lbf"),
)
RATIO = Kind("a ratio", "", "3.2", 1e9, face(""))
JERK = Kind("a jerk", "m/s^3", "2000 m/s^3", 1e12, face("m/s^3"), face("in/s^3", _PER_INCH), ("m/s^3", "in/s^3"))
TIME = Kind("a time", "s", "30 s", 1e9, face("s"), None, ("s", "min"))
_PER_ANGLE = Kind(
    name="a length per angle",
    unit="m/rad",
    example="",
    limit=0.0,
    metric=Face("mm/rad", "_mm_per_rad", 1e3),
    inch=Face("in/rad", "_in_per_rad", _PER_INCH),
)
_PER_SQUARED_ANGLE = Kind(
    name="a length per squared angle",
    unit="m/rad^2",
    example="",
    limit=0.0,
    metric=Face("mm/rad^2", "_mm_per_rad2", 1e3),
    inch=Face("in/rad^2", "_in_per_rad2", _PER_INCH),
)

KINDS = (
    *(LENGTH, AREA, ANGLE, ANGULAR_SPEED, ANGULAR_ACCELERATION, MASS, INERTIA, DENSITY),
    *(
        SPEED,
        ACCELERATION,
        FORCE,
        TORQUE,
        POWER,
        STIFFNESS,
        ANGULAR_STIFFNESS,
        DAMPING,
        QUADRATIC_DAMPING,
        PRESSURE,
        PRESSURE_SPEED,
        WEAR,
        RATIO,
        JERK,
        VOLUME,
        ENERGY,
    ),
)
SHOWN = (*(kind for kind in KINDS if kind.unit), _PER_ANGLE, _PER_SQUARED_ANGLE)
"""Kinds that columns are of: the one table of units for columns, figures, reports and the page."""


def shown_in(symbol: str, system: System) -> tuple[str, float]:
    """Return the unit in which a system shows a metric one, and the metric unit's value in it.

    "mm" is ("in", 1 / 25.4) in the inch system. A unit that is no metric one of `SHOWN`, such as one of an own
    quantity, stays as it is.
    """
    for kind in SHOWN if system == "inch" else ():
        if kind.inch is not None and kind.metric.symbol == symbol:
            return kind.inch.symbol, kind.inch.factor / kind.metric.factor
    return symbol, 1.0


def unit_text(symbol: str) -> str:
    """Return a unit as printed: m/s^2 with a raised 2."""
    return symbol.replace("^2", "²").replace("^3", "³")


def kind_in(symbol: str, factor: float = 1.0, kind: Kind | None = None) -> Kind:
    """Return the kind of a value shown in any unit, its suffix made from the unit's symbol.

    factor: what one SI unit is in it. kind: that of the table, if it is known; else one named after the unit.
    """
    if kind is None:
        return Kind(f"a value in {symbol or 'no unit'}", symbol, f"1 {symbol}", 1e30, face(symbol, factor))
    return replace(kind, metric=face(symbol, factor), inch=None)
