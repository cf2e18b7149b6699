"""Kinds of physical values, and the units that they are shown in: one table for files, tables, figures and the page.

SI inside, always. A metric face is what columns and JSON have; an inch face what a reader of US customary units asks
for: inch, pound-mass, pound-force, second, and what is made of these; horsepower and psi where the field has them.
Factors are exact to rounding: inch and pound are defined (international, 1959), pound-force by the standard
acceleration of gravity (3rd CGPM, 1901), horsepower as 550 foot-pounds-force a second.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

System = Literal["metric", "inch"]
"""Systems of units that values are shown in. Inch: US customary units of machine design, lengths in inches."""


@dataclass(frozen=True)
class Face:
    """Unit of a kind in a system. symbol: of the unit. suffix: of columns in it. factor: what one SI unit is in it."""

    symbol: str
    suffix: str
    factor: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of physical value.

    name: with its article, "a length". unit: the SI unit, "" if none. example: as a job file has it.
    limit: the greatest magnitude in SI that is believed. It lies orders beyond any machine: what exceeds it is a
    mistaken unit (80 Mm for 80 mm), and products of several values stay far from the ends of a double.
    metric, inch: how it is shown, None where no column has it; inch is metric where both systems use the same unit.
    """

    name: str
    unit: str
    example: str
    limit: float
    metric: Face | None = None
    inch: Face | None = None


_INCH = 0.0254
_POUND = 0.45359237
_LBF = 4.4482216152605
LENGTH = Kind(
    name="a length",
    unit="m",
    example="80 mm",
    limit=1e4,
    metric=Face("mm", "_mm", 1e3),
    inch=Face("in", "_in", 1.0 / _INCH),
)
AREA = Kind(
    name="an area",
    unit="m^2",
    example="0.25 m^2",
    limit=1e8,
    metric=Face("m^2", "_m2"),
    inch=Face("in^2", "_in2", 1.0 / _INCH**2),
)
ANGLE = Kind(name="an angle", unit="rad", example="0.1 deg", limit=1e4, metric=Face("deg", "_deg", 57.29577951308232))
ANGULAR_SPEED = Kind(
    name="an angular speed", unit="rad/s", example="300 rpm", limit=1e6, metric=Face("rpm", "_rpm", 9.549296585513721)
)
ANGULAR_ACCELERATION = Kind(
    name="an angular acceleration",
    unit="rad/s^2",
    example="20 rad/s^2",
    limit=1e9,
    metric=Face("rad/s^2", "_rad_s2"),
)
MASS = Kind(
    name="a mass",
    unit="kg",
    example="0.8 kg",
    limit=1e8,
    metric=Face("kg", "_kg"),
    inch=Face("lb", "_lb", 1.0 / _POUND),
)
INERTIA = Kind(
    name="a moment of inertia",
    unit="kg m^2",
    example="0.015 kg m^2",
    limit=1e12,
    metric=Face("kg m^2", "_kg_m2"),
    inch=Face("lb in^2", "_lb_in2", 1.0 / (_POUND * _INCH**2)),
)
DENSITY = Kind(
    name="a density",
    unit="kg/m^3",
    example="7800 kg/m^3",
    limit=1e6,
    metric=Face("kg/m^3", "_kg_m3"),
    inch=Face("lb/in^3", "_lb_in3", _INCH**3 / _POUND),
)
SPEED = Kind(
    name="a speed",
    unit="m/s",
    example="2.5 m/s",
    limit=1e6,
    metric=Face("m/s", "_m_s"),
    inch=Face("in/s", "_in_s", 1.0 / _INCH),
)
ACCELERATION = Kind(
    name="an acceleration",
    unit="m/s^2",
    example="9.81 m/s^2",
    limit=1e9,
    metric=Face("m/s^2", "_m_s2"),
    inch=Face("in/s^2", "_in_s2", 1.0 / _INCH),
)
FORCE = Kind(
    name="a force",
    unit="N",
    example="200 N",
    limit=1e12,
    metric=Face("N", "_N"),
    inch=Face("lbf", "_lbf", 1.0 / _LBF),
)
TORQUE = Kind(
    name="a torque",
    unit="N m",
    example="25 N m",
    limit=1e15,
    metric=Face("N m", "_Nm"),
    inch=Face("lbf in", "_lbf_in", 1.0 / (_LBF * _INCH)),
)
POWER = Kind(
    name="a power",
    unit="W",
    example="250 W",
    limit=1e15,
    metric=Face("W", "_W"),
    inch=Face("hp", "_hp", 1.0 / (6600.0 * _LBF * _INCH)),
)
STIFFNESS = Kind(
    name="a stiffness",
    unit="N/m",
    example="20 N/mm",
    limit=1e15,
    metric=Face("N/m", "_N_per_m"),
    inch=Face("lbf/in", "_lbf_per_in", _INCH / _LBF),
)
DAMPING = Kind(
    name="a viscous coefficient",
    unit="N s/m",
    example="50 N s/m",
    limit=1e15,
    metric=Face("N s/m", "_Ns_per_m"),
    inch=Face("lbf s/in", "_lbf_s_per_in", _INCH / _LBF),
)
PRESSURE = Kind(
    name="a pressure",
    unit="Pa",
    example="207 GPa",
    limit=1e15,
    metric=Face("MPa", "_MPa", 1e-6),
    inch=Face("psi", "_psi", _INCH**2 / _LBF),
)
RATIO = Kind(name="a ratio", unit="", example="3.2", limit=1e9)

KINDS = (
    *(LENGTH, AREA, ANGLE, ANGULAR_SPEED, ANGULAR_ACCELERATION, MASS, INERTIA, DENSITY),
    *(SPEED, ACCELERATION, FORCE, TORQUE, POWER, STIFFNESS, DAMPING, PRESSURE, RATIO),
)
TIME = Kind(name="a time", unit="s", example="30 s", limit=1e9)
_JERK = Kind(
    name="a jerk",
    unit="m/s^3",
    example="",
    limit=0.0,
    metric=Face("m/s^3", "_m_s3"),
    inch=Face("in/s^3", "_in_s3", 1.0 / _INCH),
)
_PER_ANGLE = Kind(
    name="a length per angle",
    unit="m/rad",
    example="",
    limit=0.0,
    metric=Face("mm/rad", "_mm_per_rad", 1e3),
    inch=Face("in/rad", "_in_per_rad", 1.0 / _INCH),
)
_PER_SQUARED_ANGLE = Kind(
    name="a length per squared angle",
    unit="m/rad^2",
    example="",
    limit=0.0,
    metric=Face("mm/rad^2", "_mm_per_rad2", 1e3),
    inch=Face("in/rad^2", "_in_per_rad2", 1.0 / _INCH),
)
SHOWN = (*(kind for kind in KINDS if kind.metric is not None), _JERK, _PER_ANGLE, _PER_SQUARED_ANGLE)
"""Kinds that are shown: the one table of units for columns, figures, reports and the page."""


def shown_in(symbol: str, system: System) -> tuple[str, float]:
    """Return the unit that a system shows for a metric one, and the value of one of the metric unit in it.

    "mm" is ("in", 1 / 25.4) in the inch system. A unit that is no metric one of `SHOWN`, such as one of an own
    quantity, stays as it is.
    """
    for kind in SHOWN if system == "inch" else ():
        if kind.metric is not None and kind.inch is not None and kind.metric.symbol == symbol:
            return kind.inch.symbol, kind.inch.factor / kind.metric.factor
    return symbol, 1.0
