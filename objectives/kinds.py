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

from ..model.input_warning import LONGEST

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


def per(symbol: str, factor: float = 1.0) -> Face:
    """Return the face of a quotient whose columns say so: N s/m in _Ns_per_m."""
    above, _, below = symbol.replace("^", "").partition("/")
    return Face(symbol, f"_{above.replace('N ', 'N').replace(' ', '_')}_per_{below}", factor)


@dataclass(frozen=True)
class Kind:
    """A kind of physical value.

    name: with its article, "a length". unit: the SI unit, "" if none. example: as a job file has it.
    limit: the greatest magnitude in SI that is believed. It lies orders beyond any machine: what exceeds it is a
    mistaken unit (80 Mm for 80 mm), and products of several values stay far from the ends of a double.
    metric, inch: how it is shown; inch is None where both systems use the same unit.
    typed: units that a form offers, the SI unit first; usual: the one that it begins with, the metric one if left out.
    spoken: units that mean something in a value of this kind alone, each with the unit that it means there.
    believed: the least and the greatest magnitude in SI that a number without a unit is believed to mean; None for any.
    amount: whether the unit is a text that stands for itself, such as a currency.
    """

    name: str
    unit: str
    example: str
    limit: float
    metric: Face
    inch: Face | None = None
    typed: tuple[str, ...] = ()
    usual: str = ""
    believed: tuple[float, float] | None = None
    spoken: tuple[tuple[str, str], ...] = ()
    amount: bool = False

    @property
    def si(self) -> Face:
        """The face of the SI unit."""
        return per(self.unit) if "_per_" in self.metric.suffix else face(self.unit)

    def face(self, system: System) -> Face:
        """Return how a system shows it."""
        return self.metric if system == "metric" or self.inch is None else self.inch

    @property
    def plain(self) -> str:
        """The name without its article: "length"."""
        return self.name.split(" ", 1)[-1]


_INCH = 0.0254
_PER_INCH = 1.0 / _INCH
_POUND = 0.45359237
_LBF = 4.4482216152605


def _kind(
    name: str,
    typed: str,
    example: str,
    limit: float,
    inch: Face | None = None,
    metric: Face | None = None,
    usual: str = "",
    believed: tuple[float, float] | None = None,
    spoken: tuple[tuple[str, str], ...] = (),
) -> Kind:
    """Return a kind by the units of a form, separated by commas; shown in the first, SI, unless said."""
    units = tuple(typed.split(", ")) if typed else ()
    unit = units[0] if units else ""
    return Kind(name, unit, example, limit, metric or face(unit), inch, units, usual, believed, spoken)


_MM = face("in", _PER_INCH), face("mm", 1e3)
LENGTH = _kind("a length", "m, mm, cm, µm, in, foot", "80 mm", 1e4, *_MM, believed=(1e-4, LONGEST))
AREA = _kind("an area", "m^2, cm^2, mm^2, in^2", "0.25 m^2", 1e8, face("in^2", 1.0 / _INCH**2))
_DEG = face("deg", 57.29577951308232)
ANGLE = _kind("an angle", "rad, deg", "0.1 deg", 1e4, metric=_DEG, believed=(0.0, 12.6))  # two turns
_RPM = face("rpm", 9.549296585513721)
_PER_MINUTE = (
    *("/min", "1/min", "min^-1", "min-1", "min**-1", "U/min", "u/min", "Upm", "UPM", "r/min", "r.p.m.", "Rpm"),
    *("spm", "SPM", "stroke/min", "strokes/min", "Strokes/min"),
)
_PLATES = (*((unit, "rpm") for unit in _PER_MINUTE), *((unit, "rev/s") for unit in ("Hz", "hz", "HZ")))
"""Units on plates of motors and machines, which count turns."""
_SPEEDS = "rad/s, rpm, rev/s"
ANGULAR_SPEED = _kind("an angular speed", _SPEEDS, "300 rpm", 1e6, metric=_RPM, believed=(0.0, 0.0), spoken=_PLATES)
ANGULAR_ACCELERATION = _kind("an angular acceleration", "rad/s^2, deg/s^2", "20 rad/s^2", 1e9)
MASS = _kind("a mass", "kg, g, t, lb", "0.8 kg", 1e8, face("lb", 1.0 / _POUND))
_INERTIA = face("lb in^2", 1.0 / (_POUND * _INCH**2))
INERTIA = _kind("a moment of inertia", "kg m^2, kg mm^2, lb in^2", "0.015 kg m^2", 1e12, _INERTIA)
DENSITY = _kind("a density", "kg/m^3, g/cm^3, lb/in^3", "7800 kg/m^3", 1e6, face("lb/in^3", _INCH**3 / _POUND))
SPEED = _kind("a speed", "m/s, mm/s, in/s", "2.5 m/s", 1e6, face("in/s", _PER_INCH))
ACCELERATION = _kind("an acceleration", "m/s^2, mm/s^2, in/s^2", "9.81 m/s^2", 1e9, face("in/s^2", _PER_INCH))
FORCE = _kind("a force", "N, kN, lbf", "200 N", 1e12, face("lbf", 1.0 / _LBF))
TORQUE = _kind("a torque", "N m, kN m, N mm, lbf in, lbf ft", "25 N m", 1e15, face("lbf in", 1.0 / (_LBF * _INCH)))
POWER = _kind("a power", "W, kW, hp", "250 W", 1e15, face("hp", 1.0 / (6600.0 * _LBF * _INCH)))
_STIFFNESS = per("lbf/in", _INCH / _LBF), per("N/m")
STIFFNESS = _kind("a stiffness", "N/m, N/mm, lbf/in", "20 N/mm", 1e15, *_STIFFNESS, "N/mm")
_ANGULAR = per("lbf in/rad", 1.0 / (_LBF * _INCH)), per("N m/rad")
ANGULAR_STIFFNESS = _kind("an angular stiffness", "N m/rad, N m/deg, lbf in/rad", "40 N m/rad", 1e15, *_ANGULAR)
_DAMPING = per("lbf s/in", _INCH / _LBF), per("N s/m")
DAMPING = _kind("a viscous coefficient", "N s/m, N s/mm, lbf s/in", "50 N s/m", 1e15, *_DAMPING)
_DRAG = per("lbf s^2/in^2", _INCH**2 / _LBF), per("N s^2/m^2")
QUADRATIC_DAMPING = _kind("a coefficient of drag", "N s^2/m^2, N s^2/mm^2, lbf s^2/in^2", "20 N s^2/m^2", 1e15, *_DRAG)
_PRESSURE = face("psi", _INCH**2 / _LBF), face("MPa", 1e-6)
PRESSURE = _kind("a pressure", "Pa, kPa, bar, MPa, GPa, psi", "20 MPa", 1e15, *_PRESSURE)
_HEAT = face("ft lbf/in^3", _INCH**2 / (12.0 * _LBF)), face("MJ/m^3", 1e-6)
_HEATS = "J/m^3, MJ/m^3, J/cm^3, kJ/L, ft lbf/in^3"
HEAT_PER_VOLUME = _kind("a heat per volume", _HEATS, "1.2 MJ/m^3", 1e15, *_HEAT)
_RUBBED = face("psi ft/min", 60.0 * _INCH / (12.0 * _LBF)), face("MPa m/s", 1e-6)
PRESSURE_SPEED = _kind(
    "a pressure times a speed", "Pa m/s, MPa m/s, psi ft/min", "1 MPa m/s", 1e15, *_RUBBED, "MPa m/s"
)
_WEAR = face("in^2/lbf", _LBF / _INCH**2), face("mm^2/N", 1e6)
WEAR = _kind("a wear coefficient", "m^2/N, mm^2/N, in^2/lbf", "1e-9 mm^2/N", 1.0, *_WEAR, "mm^2/N")
RATIO = _kind("a ratio", "", "3.2", 1e9)
JERK = _kind("a jerk", "m/s^3, in/s^3", "2000 m/s^3", 1e12, face("in/s^3", _PER_INCH))
_VOLUME = face("in^3", 1.0 / _INCH**3), face("cm^3", 1e6)
VOLUME = _kind("a volume", "m^3, cm^3, mm^3, in^3", "250 cm^3", 1e12, *_VOLUME, believed=(1e-9, 1.0))
_FLOW = face("gal/min", 60.0 / (231.0 * _INCH**3)), face("L/min", 6e4)
VOLUME_FLOW = _kind("a volume flow", "m^3/s, L/min, L/s, gal/min, in^3/s", "20 L/min", 1e9, *_FLOW)
ENERGY = _kind("an energy", "J, kJ, ft lbf", "60 J", 1e15, face("ft lbf", 1.0 / (12.0 * _LBF * _INCH)))
TIME = _kind("a time", "s, min", "30 s", 1e9)

KINDS = tuple(kind for kind in list(globals().values()) if isinstance(kind, Kind))
"""The kinds above, in their order: those of numbers of a job and of quantities."""
SMALL_LENGTH = replace(LENGTH, example="0.1 mm")
"""Steps and misses, which are shorter than links."""
PERCENT = Kind("a percentage", "", "50 %", 1e4, face("%", 100.0))
STROKE_RATE = _kind("a number of strokes per minute", "", "30", 9e6)
PER_ANGLE, PER_SQUARED_ANGLE, PER_CUBED_ANGLE = (
    Kind(f"a length per {name}", f"m/{unit}", "", 0.0, per(f"mm/{unit}", 1e3), per(f"in/{unit}", _PER_INCH))
    for name, unit in (("angle", "rad"), ("squared angle", "rad^2"), ("cubed angle", "rad^3"))
)
MASS_MOMENT = Kind("a mass times a length", "kg m", "", 0.0, face("kg m"), face("lb in", _PER_INCH / _POUND))

SHOWN = (*(kind for kind in KINDS if kind.unit), PER_ANGLE, PER_SQUARED_ANGLE, PER_CUBED_ANGLE, MASS_MOMENT)
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


def amount_in(unit: str) -> Kind:
    """Return the kind of an amount in a unit that is none of physics, such as EUR."""
    return Kind(f"an amount in {unit}", unit, f"100 {unit}", 1e15, face(unit), typed=(unit,), amount=True)


def kind_in(symbol: str, factor: float = 1.0, kind: Kind | None = None) -> Kind:
    """Return the kind of a value shown in any unit, its suffix made from the unit's symbol.

    factor: what one SI unit is in it. kind: that of the table, if it is known; else one named after the unit.
    """
    if kind is None:
        return Kind(f"a value in {symbol or 'no unit'}", symbol, f"1 {symbol}", 1e30, face(symbol, factor))
    return replace(kind, metric=face(symbol, factor), inch=None)
