"""Kinds of physical values with their display units: one table for files, tables, figures and the page.

Values are always SI inside the program. Columns and JSON use metric units. Inch units are the US customary units that
readers may choose: inch, pound-mass, pound-force, second, and combinations; horsepower and psi where usual. Factors are
exact to rounding. Inch and pound have exact definitions (international, 1959); pound-force uses standard gravity (3rd
CGPM, 1901), and horsepower is 550 foot-pounds-force per second.

Keys of table columns and JSON end with a unit: `peak_torque_Nm`, `crank_in`.
"""

import re
from dataclasses import dataclass, replace
from typing import Literal

from ..model.errors import LONGEST

System = Literal["metric", "inch"]
"""Systems of units in which values are shown. Inch: US customary units as in machine design, with lengths in inches."""


@dataclass(frozen=True)
class DisplayUnit:
    """Unit of a kind in a system. symbol: its symbol. suffix: suffix of its columns. factor: value of one SI unit."""

    symbol: str
    suffix: str
    factor: float = 1.0


def display_unit(symbol: str, factor: float = 1.0) -> DisplayUnit:
    """Return a display unit whose columns end with its symbol: rad/s^2 gives _rad_s2."""
    plain = symbol.replace("N m", "Nm").replace("^", "").replace("*", "_")
    name = re.sub(r"[^A-Za-z0-9]+", "_", plain).strip("_")
    return DisplayUnit(symbol, f"_{name}" if name else "", factor)


def display_unit_of_quotient(symbol: str, factor: float = 1.0) -> DisplayUnit:
    """Return the display unit for a quotient, with "per" in its columns: N s/m gives _Ns_per_m."""
    numerator, _, denominator = symbol.replace("^", "").partition("/")
    return DisplayUnit(symbol, f"_{numerator.replace('N ', 'N').replace(' ', '_')}_per_{denominator}", factor)


@dataclass(frozen=True)
class Kind:
    """A kind of physical value.

    name: name with its article, "a length". unit: the SI unit, "" if none. example: a value as in a job file. limit:
    largest credible magnitude in SI. It is orders of magnitude beyond any machine. A larger value indicates a wrong
    unit (80 Mm for 80 mm), and products of several values stay in the range of a double. metric, inch: display units;
    inch is None if both systems use the same unit. typed: units that a form offers, the SI unit first. usual: unit that
    the form preselects, by default the metric one. spoken: units that are meaningful only in values of this kind, each
    with its meaning. believed: smallest and largest credible magnitude in SI of a number without a unit; None for any.
    amount: whether the unit is free text, such as a currency.
    """

    name: str
    unit: str
    example: str
    limit: float
    metric: DisplayUnit
    inch: DisplayUnit | None = None
    typed: tuple[str, ...] = ()
    usual: str = ""
    believed: tuple[float, float] | None = None
    spoken: tuple[tuple[str, str], ...] = ()
    amount: bool = False

    @property
    def si_display_unit(self) -> DisplayUnit:
        """The SI unit as a display unit."""
        return display_unit_of_quotient(self.unit) if "_per_" in self.metric.suffix else display_unit(self.unit)

    def is_plausible(self, number: float) -> bool:
        """Return whether a number without a unit has a credible magnitude in SI."""
        return self.believed is None or self.believed[0] <= abs(number) < self.believed[1]

    def display_unit(self, system: System) -> DisplayUnit:
        """Return its display unit in a system."""
        return self.metric if system == "metric" or self.inch is None else self.inch

    @property
    def name_without_article(self) -> str:
        """The name without its article: "length"."""
        return self.name.split(" ", 1)[-1]


_INCH = 0.0254
_PER_INCH = 1.0 / _INCH
_POUND = 0.45359237
_LBF = 4.4482216152605


def _build_kind(
    name: str,
    typed: str,
    example: str,
    limit: float,
    inch: DisplayUnit | None = None,
    metric: DisplayUnit | None = None,
    usual: str = "",
    believed: tuple[float, float] | None = None,
    spoken: tuple[tuple[str, str], ...] = (),
) -> Kind:
    """Return a kind from a form's units, separated by commas; the first, SI, is the default display unit."""
    units = tuple(typed.split(", ")) if typed else ()
    unit = units[0] if units else ""
    return Kind(name, unit, example, limit, metric or display_unit(unit), inch, units, usual, believed, spoken)


_MM = display_unit("in", _PER_INCH), display_unit("mm", 1e3)
LENGTH = _build_kind("a length", "m, mm, cm, µm, in, foot", "80 mm", 1e4, *_MM, believed=(1e-4, LONGEST))
AREA = _build_kind("an area", "m^2, cm^2, mm^2, in^2", "0.25 m^2", 1e8, display_unit("in^2", 1.0 / _INCH**2))
_DEG = display_unit("deg", 57.29577951308232)
ANGLE = _build_kind("an angle", "rad, deg", "0.1 deg", 1e4, metric=_DEG, believed=(0.0, 12.6))  # two turns
_RPM = display_unit("rpm", 9.549296585513721)
_PER_MINUTE = (
    *("/min", "1/min", "min^-1", "min-1", "min**-1", "U/min", "u/min", "Upm", "UPM", "r/min", "r.p.m.", "Rpm"),
    *("spm", "SPM", "stroke/min", "strokes/min", "Strokes/min"),
)
_PLATES = (*((unit, "rpm") for unit in _PER_MINUTE), *((unit, "rev/s") for unit in ("Hz", "hz", "HZ")))
"""Units on nameplates of motors and machines, where speed is in turns."""
_SPEEDS = "rad/s, rpm, rev/s"
ANGULAR_SPEED = _build_kind(
    "an angular speed", _SPEEDS, "300 rpm", 1e6, metric=_RPM, believed=(0.0, 0.0), spoken=_PLATES
)
ANGULAR_ACCELERATION = _build_kind("an angular acceleration", "rad/s^2, deg/s^2", "20 rad/s^2", 1e9)
MASS = _build_kind("a mass", "kg, g, t, lb", "0.8 kg", 1e8, display_unit("lb", 1.0 / _POUND))
_INERTIA = display_unit("lb in^2", 1.0 / (_POUND * _INCH**2))
INERTIA = _build_kind("a moment of inertia", "kg m^2, kg mm^2, lb in^2", "0.015 kg m^2", 1e12, _INERTIA)
DENSITY = _build_kind(
    "a density", "kg/m^3, g/cm^3, lb/in^3", "7850 kg/m^3", 1e6, display_unit("lb/in^3", _INCH**3 / _POUND)
)
SPEED = _build_kind("a speed", "m/s, mm/s, in/s", "2.5 m/s", 1e6, display_unit("in/s", _PER_INCH))
ACCELERATION = _build_kind(
    "an acceleration", "m/s^2, mm/s^2, in/s^2", "9.81 m/s^2", 1e9, display_unit("in/s^2", _PER_INCH)
)
FORCE = _build_kind("a force", "N, kN, lbf", "200 N", 1e12, display_unit("lbf", 1.0 / _LBF))
TORQUE = _build_kind(
    "a torque", "N m, kN m, N mm, lbf in, lbf ft", "25 N m", 1e15, display_unit("lbf in", 1.0 / (_LBF * _INCH))
)
POWER = _build_kind("a power", "W, kW, hp", "250 W", 1e15, display_unit("hp", 1.0 / (6600.0 * _LBF * _INCH)))
_STIFFNESS = display_unit_of_quotient("lbf/in", _INCH / _LBF), display_unit_of_quotient("N/m")
STIFFNESS = _build_kind("a stiffness", "N/m, N/mm, lbf/in", "20 N/mm", 1e15, *_STIFFNESS, "N/mm")
_ANGULAR = display_unit_of_quotient("lbf in/rad", 1.0 / (_LBF * _INCH)), display_unit_of_quotient("N m/rad")
ANGULAR_STIFFNESS = _build_kind("an angular stiffness", "N m/rad, N m/deg, lbf in/rad", "40 N m/rad", 1e15, *_ANGULAR)
_DAMPING = display_unit_of_quotient("lbf s/in", _INCH / _LBF), display_unit_of_quotient("N s/m")
DAMPING = _build_kind("a viscous coefficient", "N s/m, N s/mm, lbf s/in", "50 N s/m", 1e15, *_DAMPING)
_DRAG = display_unit_of_quotient("lbf s^2/in^2", _INCH**2 / _LBF), display_unit_of_quotient("N s^2/m^2")
QUADRATIC_DAMPING = _build_kind(
    "a coefficient of drag", "N s^2/m^2, N s^2/mm^2, lbf s^2/in^2", "20 N s^2/m^2", 1e15, *_DRAG
)
_PRESSURE = display_unit("psi", _INCH**2 / _LBF), display_unit("MPa", 1e-6)
PRESSURE = _build_kind("a pressure", "Pa, kPa, bar, MPa, GPa, psi", "20 MPa", 1e15, *_PRESSURE)
_HEAT = display_unit("ft lbf/in^3", _INCH**2 / (12.0 * _LBF)), display_unit("MJ/m^3", 1e-6)
_HEATS = "J/m^3, MJ/m^3, J/cm^3, kJ/L, ft lbf/in^3"
HEAT_PER_VOLUME = _build_kind("a heat per volume", _HEATS, "1.2 MJ/m^3", 1e15, *_HEAT)
_PRESSURE_SPEEDS = display_unit("psi ft/min", 60.0 * _INCH / (12.0 * _LBF)), display_unit("MPa m/s", 1e-6)
PRESSURE_SPEED = _build_kind(
    "a pressure times a speed", "Pa m/s, MPa m/s, psi ft/min", "1 MPa m/s", 1e15, *_PRESSURE_SPEEDS, "MPa m/s"
)
_WEAR = display_unit("in^2/lbf", _LBF / _INCH**2), display_unit("mm^2/N", 1e6)
WEAR = _build_kind("a wear coefficient", "m^2/N, mm^2/N, in^2/lbf", "1e-9 mm^2/N", 1.0, *_WEAR, "mm^2/N")
RATIO = _build_kind("a ratio", "", "3.2", 1e9)
JERK = _build_kind("a jerk", "m/s^3, in/s^3", "2000 m/s^3", 1e12, display_unit("in/s^3", _PER_INCH))
_VOLUME = display_unit("in^3", 1.0 / _INCH**3), display_unit("cm^3", 1e6)
VOLUME = _build_kind("a volume", "m^3, cm^3, mm^3, in^3", "250 cm^3", 1e12, *_VOLUME, believed=(1e-9, 1.0))
_FLOW = display_unit("gal/min", 60.0 / (231.0 * _INCH**3)), display_unit("L/min", 6e4)
VOLUME_FLOW = _build_kind("a volume flow", "m^3/s, L/min, L/s, gal/min, in^3/s", "20 L/min", 1e9, *_FLOW)
ENERGY = _build_kind("an energy", "J, kJ, ft lbf", "60 J", 1e15, display_unit("ft lbf", 1.0 / (12.0 * _LBF * _INCH)))
TIME = _build_kind("a time", "s, min", "30 s", 1e9)

KINDS = tuple(kind for kind in list(globals().values()) if isinstance(kind, Kind))
"""The kinds above, in order: those of numbers in jobs and of quantities."""
SMALL_LENGTH = replace(LENGTH, example="0.1 mm")
"""Kinds of steps and deviations, which are shorter than links."""
PERCENT = Kind("a percentage", "", "50 %", 1e4, display_unit("%", 100.0))
STROKE_RATE = _build_kind("a number of strokes per minute", "", "30", 9e6)
PER_ANGLE, PER_SQUARED_ANGLE, PER_CUBED_ANGLE = (
    Kind(
        f"a length per {name}",
        f"m/{unit}",
        "",
        0.0,
        display_unit_of_quotient(f"mm/{unit}", 1e3),
        display_unit_of_quotient(f"in/{unit}", _PER_INCH),
    )
    for name, unit in (("angle", "rad"), ("squared angle", "rad^2"), ("cubed angle", "rad^3"))
)
MASS_MOMENT = Kind(
    "a mass times a length", "kg m", "", 0.0, display_unit("kg m"), display_unit("lb in", _PER_INCH / _POUND)
)

DISPLAYED_KINDS = (*(kind for kind in KINDS if kind.unit), PER_ANGLE, PER_SQUARED_ANGLE, PER_CUBED_ANGLE, MASS_MOMENT)
"""Kinds of columns: the only table of units for columns, figures, reports and the page."""


def metric_unit_in(symbol: str, system: System) -> tuple[str, float]:
    """Return a system's display unit for a metric unit, and the value of one metric unit in it.

    "mm" is ("in", 1 / 25.4) in the inch system. A unit that is not a metric unit in `DISPLAYED_KINDS`, such as that of
    a custom quantity, stays unchanged.
    """
    for kind in DISPLAYED_KINDS if system == "inch" else ():
        if kind.inch is not None and kind.metric.symbol == symbol:
            return kind.inch.symbol, kind.inch.factor / kind.metric.factor
    return symbol, 1.0


def unit_text(symbol: str) -> str:
    """Return a unit as printed: m/s^2 with a superscript 2."""
    return symbol.replace("^2", "²").replace("^3", "³")


def amount_kind(unit: str) -> Kind:
    """Return the kind for an amount in a non-physical unit, such as EUR."""
    return Kind(f"an amount in {unit}", unit, f"100 {unit}", 1e15, display_unit(unit), typed=(unit,), amount=True)


def kind_displayed_in(symbol: str, factor: float = 1.0, kind: Kind | None = None) -> Kind:
    """Return the kind for a value displayed in any unit; the suffix derives from the unit's symbol.

    factor: value of one SI unit in it. kind: kind from the table if there is one, else a kind named after the unit.
    """
    if kind is None:
        return Kind(f"a value in {symbol or 'no unit'}", symbol, f"1 {symbol}", 1e30, display_unit(symbol, factor))
    return replace(kind, metric=display_unit(symbol, factor), inch=None)


def count_with_noun(count: int, noun: str) -> str:
    """Return a count with its noun: "1 design", "20 designs". The plural ends in s."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


# Suffixes of column names, longest first because "_lbf_in" also ends with "_in".
_DISPLAY_UNITS = sorted(
    {unit for kind in DISPLAYED_KINDS for unit in (kind.metric, kind.inch) if unit is not None},
    key=lambda unit: -len(unit.suffix),
)
_KINDS = {kind.metric.suffix: kind for kind in reversed(DISPLAYED_KINDS)}
_TO_INCH = {
    kind.metric.suffix: (kind.inch.suffix, kind.inch.factor / kind.metric.factor)
    for kind in DISPLAYED_KINDS
    if kind.inch is not None
}
_EXTRA_UNITS = {
    display_unit("bar", 1e-5): PRESSURE,  # for suction and discharge
    display_unit("um", 1e6): LENGTH,  # for small steps, such as saving_per_um
    DisplayUnit("kg m^2", "_kgm2"): INERTIA,  # of flywheels
}
"""Units in keys beyond those of the kinds."""
_DISPLAY_UNITS += _EXTRA_UNITS
_DISPLAY_UNITS += (display_unit("1/min", 60.0), display_unit("1/s"))  # for catalogues, such as an output speed
_CURRENCY = re.compile("_([A-Z]{3})$")  # ISO 4217, for an amount such as a price
_TO_METRIC = {inch: metric for metric, (inch, _) in _TO_INCH.items()}
for _unit, _kind in _EXTRA_UNITS.items():
    _KINDS[_unit.suffix] = replace(_kind, metric=_unit)
    _TO_INCH[_unit.suffix] = _kind.display_unit("inch").suffix, _kind.display_unit("inch").factor / _unit.factor


def name_unit_and_factor_of_key(key: str) -> tuple[str, str, float]:
    """Return the name, the unit and the factor from SI for a key such as "peak_torque_Nm"."""
    unit = _display_unit_of(key)
    return (key, "", 1.0) if unit is None else (key.removesuffix(unit.suffix), unit.symbol, unit.factor)


def name_and_kind_of_key(key: str) -> tuple[str, Kind]:
    """Return name and kind of a metric key; without a unit, the kind is a ratio."""
    unit = _display_unit_of(key)
    if unit is None:
        return key, RATIO
    return key.removesuffix(unit.suffix), _KINDS.get(unit.suffix) or kind_displayed_in(unit.symbol, unit.factor)


def column_key_in_system(key: str, system: System) -> tuple[str, float]:
    """Return the key for a metric column in a system of units, and the factor for its values."""
    unit = _display_unit_of(key)
    if system == "metric" or unit is None:
        return key, 1.0
    if key.removesuffix(unit.suffix).endswith("_per"):  # a quotient without a kind: convert both its units
        numerator, _, denominator = key.rpartition("_per_")
        (upper, up), (lower, down) = (
            column_key_in_system(numerator, system),
            column_key_in_system(f"_{denominator}", system),
        )
        return f"{upper}_per{lower}", up / down
    if unit.suffix not in _TO_INCH:
        return key, 1.0
    suffix, factor = _TO_INCH[unit.suffix]
    return key.removesuffix(unit.suffix) + suffix, factor


def metric_key(key: str) -> str:
    """Return the metric key for a column in any system of units."""
    unit = _display_unit_of(key)
    suffix = None if unit is None else _TO_METRIC.get(unit.suffix)
    return key if unit is None or suffix is None else key.removesuffix(unit.suffix) + suffix


def _display_unit_of(key: str) -> DisplayUnit | None:
    listed = next((unit for unit in _DISPLAY_UNITS if key.endswith(unit.suffix)), None)
    currency = _CURRENCY.search(key) if listed is None else None
    return listed if currency is None else DisplayUnit(currency[1], currency[0])
