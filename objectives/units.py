"""Physical values as people write them, "80 mm", "300 rpm", "0.05 inch", and their conversion to SI.

A value is one number and one unit; a plain number is in SI. Units come from this project's own short list, read by
pint, rather than from pint's default registry, for three reasons. In the default registry an angle has no dimension, so
"5 s^-1" or "5 Bq" would pass for a crank speed in rad/s, wrong by a factor of 2 pi. Thousands of units from other
fields turn slips such as "mM" or "degC" into valid units. And it takes 0.14 s to build; this one takes 3 ms.

Conversion is exact rational arithmetic, rounded once:
"80 mm" is the double 0.08, and 360 deg is the double nearest 2 pi.
"""

import difflib
import functools
import json
import math
import re
import reprlib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from datetime import date, time
from fractions import Fraction
from typing import Any, Literal

from ..model.errors import InputError
from .kinds import KINDS, DisplayUnit, Kind, amount_kind, count_with_noun, kind_displayed_in

Sign = Literal["any", "positive", "zero or more"]
Dimension = frozenset[tuple[str, int]]
"""Base dimensions with their powers: {("[length]", 1), ("[time]", -1)} for a speed."""

_OTHERS = (Kind("a frequency that may count turns or radians", "s^-1", "", 0.0, DisplayUnit("1/s", "")),)

# Exact by definition: inch, pound (international, 1959) and, in the two forces, standard gravity (3rd CGPM, 1901).
# Degrees use pi to 36 digits.
_DEFINITIONS = """
nano- = 1e-9 = n-
micro- = 1e-6 = µ- = μ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
deci- = 1e-1 = d-
deca- = 1e1 = da-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
metre = [length] = m = meter
kilogram = [mass] = kg
second = [time] = s = sec
radian = [angle] = rad
gram = 0.001 * kilogram = g
tonne = 1000 * kilogram = t
minute = 60 * second = min
hour = 3600 * second = h
inch = 0.0254 * metre = in = inches
foot = 0.3048 * metre = ft = feet
thou = 0.0000254 * metre = mil
pound = 0.45359237 * kilogram = lb = lbm
ounce = pound / 16 = oz
degree = 3.14159265358979323846264338327950288 / 180 * radian = deg = degrees
arcminute = degree / 60 = arcmin
arcsecond = degree / 3600 = arcsec
gradian = 3.14159265358979323846264338327950288 / 200 * radian = gon
turn = 6.28318530717958647692528676655900577 * radian = rev = revolution
rpm = turn / minute = RPM
rps = turn / second
litre = 0.001 * metre ** 3 = L = l = liter
gallon = 231 * inch ** 3 = gal
newton = kilogram * metre / second ** 2 = N
newton_metre = newton * metre = Nm
newton_centimetre = 0.01 * newton * metre = Ncm
newton_millimetre = 0.001 * newton * metre = Nmm
newton_second = newton * second = Ns
watt = newton * metre / second = W
joule = newton * metre = J
pascal = newton / metre ** 2 = Pa
bar = 1e5 * pascal
pound_force = 4.4482216152605 * newton = lbf
ounce_force = pound_force / 16 = ozf
kip = 1000 * pound_force
psi = pound_force / inch ** 2
ksi = 1000 * psi
slug = pound_force * second ** 2 / foot
horsepower = 550 * foot * pound_force / second = hp
kilogram_force = 9.80665 * newton = kgf = kp
"""

_PI, _TURN = Fraction("3.14159265358979323846264338327950288"), Fraction("6.28318530717958647692528676655900577")
_BASES = {"[length]": "m", "[mass]": "kg", "[time]": "s", "[angle]": "rad"}
_COMMON = (
    *("mm", "cm", "m", "µm", "inch", "foot", "thou", "deg", "rad", "arcmin", "rpm", "rad/s", "kg", "g", "t"),
    *("pound", "s", "min", "N", "kN", "lbf", "kgf", "Nm", "W", "kW", "Pa", "MPa"),
)
# Names that most jobs need, equal to the definitions above (a test compares them), because importing pint takes 0.2 s.
_FORCE = (("[length]", 1), ("[mass]", 1), ("[time]", -2))
_USUAL: dict[str, tuple[Fraction, tuple[tuple[str, int], ...]]] = {
    "m": (Fraction(1), (("[length]", 1),)),
    "cm": (Fraction(1, 100), (("[length]", 1),)),
    "mm": (Fraction(1, 1000), (("[length]", 1),)),
    "kg": (Fraction(1), (("[mass]", 1),)),
    "g": (Fraction(1, 1000), (("[mass]", 1),)),
    "s": (Fraction(1), (("[time]", 1),)),
    "rad": (Fraction(1), (("[angle]", 1),)),
    "deg": (_PI / 180, (("[angle]", 1),)),
    "rpm": (_TURN / 60, (("[angle]", 1), ("[time]", -1))),
    "N": (Fraction(1), _FORCE),
    "kN": (Fraction(1000), _FORCE),
}
_SPOKEN = frozenset(unit for kind in KINDS for unit, _ in kind.spoken)
_HINTS = {
    "degC": "temperatures are not used here",
    "°C": "temperatures are not used here",
    "J": "a torque is given in N m",
    "%": "only the tolerance of a length can be a percentage",
    '"': "write inch",
    "'": "write foot",
    "Grad": "write deg",
}

_AMBIGUOUS_SYMBOLS = (
    ("N m", r"J\b", "an energy; a torque is given in N m"),
    ("Pa", r"J\b", "a heat per volume"),
    ("J/m^3", r"(Pa|bar|psi|ksi)\b|/\s*\w+?\^?2\b", "a pressure"),
)
"""Kinds that share a dimension but are kept apart: SI unit of one kind, symbols of the other, and its description."""

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?"
PATTERN = rf"^\s*{_NUMBER.replace('[+-]', '[+−-]', 1)}\s*(1\s*/\s*)?[^\d\s.+-].*$"
"""Pattern for a value with a unit, in a JSON Schema."""
_VALUE = re.compile(rf"\s*({_NUMBER})(?:\s*([^\d\s.+\-].*)|\s+(1\s*/.*))?\s*", re.ASCII | re.DOTALL)
_FACTOR = re.compile(r"\s*([*/·⋅-]?)\s*([A-Za-zµμ°_]+)(?:(?:\^|\*\*)?([+-]?\d))?", re.ASCII)
_INVERSE = re.compile(r"^1?\s*/")
_SPREAD = re.compile(rf"({_NUMBER})\s*(.*?)\s*(?:\+/?-|±)\s*({_NUMBER})\s*(.*)", re.DOTALL)
_WEIGHT = re.compile(r"\b(lb|oz|kg)s?\b")  # masses that people write for the force of their weight
_IN = re.compile(r"\s*in[\s_]+(?=\S)(?!(?:lbf|ozf)\s*$)", re.IGNORECASE)
_LONGEST = 60
_GREATEST = 1e30  # largest magnitude of a number in a formula, SI: products of a few stay within the range of a double
SPACES = "\u00a0\u2007\u2009\u202f"
"""Non-breaking spaces, which web pages and papers put between number and unit."""
_TYPESET = str.maketrans(f"−⁻⁰¹²³⁴⁵⁶⁷⁸⁹{SPACES}", f"--0123456789{' ' * len(SPACES)}")


def kind_of_symbol(symbol: str) -> Kind:
    """Return the kind whose unit has the dimension of a symbol ("mm", "deg", "N m", "").

    Raises InputError for a symbol that is not a unit, or whose dimension has no kind.
    """
    for kind in KINDS:
        if symbol in (kind.unit, kind.metric.symbol):  # without pint, which takes 0.2 s to import
            return kind
    if (kind := kind_of_any_unit(symbol)) in KINDS:
        return kind
    raise InputError(f"no kind of value has the unit {quote(symbol)}; add one to the list of kinds")


def kind_of_any_unit(symbol: str) -> Kind:
    """Return the kind for any unit, one of `KINDS` or a new one. Raises InputError unless it is a unit."""
    kind = kind_of_dimension(dimension_of(symbol), symbol)
    if kind in KINDS:
        return kind
    plain = symbol if _parse_unit(symbol)[0] == 1 else kind.unit
    return replace(kind_displayed_in(symbol, value_of_one_si_unit_in(symbol)), name=f"a value in {plain}", unit=plain)


def dimension_of(symbol: str) -> Dimension:
    """Return the dimension of a unit, "" if it has none. Raises InputError unless it is a unit."""
    return _parse_unit(symbol)[1]


def dimension_of_kind(kind: Kind) -> Dimension:
    """Return the dimension of a kind; an amount has its own dimension."""
    return frozenset({(f"[{kind.unit}]", 1)}) if kind.amount else dimension_of(kind.unit)


def kind_of_dimension(dimension: Dimension, symbol: str = "") -> Kind:
    """Return the kind with a dimension: one of `KINDS`, or a new kind in base units.

    symbol: a unit that distinguishes kinds with the same dimension, such as a torque and an energy.
    """
    candidates = [kind for kind in KINDS if dimension_of(kind.unit) == dimension]
    if candidates:
        return next((kind for kind in candidates if symbol in kind.typed), candidates[0])
    powers = sorted(dimension, key=lambda item: (item[1] < 0, item[0]))
    unit = " ".join(unit_of_base_dimension(base) + (f"^{power}" if power != 1 else "") for base, power in powers)
    return kind_displayed_in(unit) if all(base in _BASES for base, _ in powers) else amount_kind(unit)


def unit_of_base_dimension(base: str) -> str:
    """Return the unit of a base dimension: "m" for "[length]"."""
    return _BASES.get(base, base[1:-1])


def number_in_si(digits: str, symbol: str) -> float:
    """Return a number with a unit, converted to SI.

    Raises InputError for an unknown unit, and for a magnitude beyond any machine.
    """
    exact = Fraction(digits) * _parse_unit(symbol)[0]
    if abs(exact) > _GREATEST:
        raise InputError(f"{digits} {symbol} is beyond any machine: a number in SI must be at most {_GREATEST:g}")
    return float(exact)


def value_of_one_si_unit_in(symbol: str) -> float:
    """Return the value of one SI unit in another unit: 1000 for "mm". Raises InputError for an unknown unit."""
    return float(1 / _parse_unit(symbol)[0])


def to_si(value: object, kind: Kind, *, sign: Sign = "any", plain: bool = True) -> float:
    """Return a value in SI, from a string with number and unit or from a plain number in SI.

    sign: required sign of the value. plain: whether messages suggest a plain number, which commands do not accept. A
    ratio is a plain number, given as a number or as a string. Raises InputError, with rule, value and remedy, for
    anything
    else: another dimension, an unknown unit, an expression, NaN, infinity, a boolean.
    """
    rule = f"must be {kind.name}"
    example = f'"{kind.example}"' if kind.unit else kind.example
    write = f"write it like {example}" + (f", or as a plain number in {kind.unit}" if kind.unit and plain else "")
    if isinstance(value, str):
        exact = _read_exact_value(value, kind, rule, write)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        if not math.isfinite(value if isinstance(value, float) else 0):
            raise InputError(f"must be a finite number; got {quote(value)}; {write}")
        exact = Fraction(value)
    else:
        raise InputError(f"{rule}; got {quote(value)}; {write}")
    if abs(exact) > kind.limit:
        raise InputError(
            f"{rule} of at most {kind.limit:g} {kind.unit}".rstrip()
            + f"; got {quote(value)}, beyond any machine; check the unit"
        )
    number = float(exact)
    if (sign == "positive" and number <= 0.0) or (sign == "zero or more" and number < 0.0):
        if number < 0.0 and isinstance(value, str):
            write = f"write {quote(value.translate(_TYPESET).strip().removeprefix('-'))}"
        raise InputError(f"must be {sign}; got {quote(value)}; {write}")
    return number


def plus_minus_ends(value: object) -> tuple[str, str] | None:
    """Return the ends of a range given as middle and half width, "180 mm +- 0.5 mm".

    Each is a text in the unit of the middle value; a unit missing on one side is taken from the other. None if the
    value is not such a range. Raises InputError for units of different kinds.
    """
    parts = _SPREAD.fullmatch(value.translate(_TYPESET).strip()) if isinstance(value, str) else None
    if parts is None:
        return None
    middle, half = Fraction(parts[1]), abs(Fraction(parts[3]))
    unit = parts[2] or parts[4].strip()
    if (second_unit := parts[4].strip() or unit) != unit:
        (middle_factor, dimension), (factor, another) = _parse_unit(unit), _parse_unit(second_unit)
        if dimension != another:
            raise InputError(
                f'both parts of a range must have units of one kind; got {quote(value)}; write it like "180 mm '
                '+- 0.5 mm"'
            )
        half *= factor / middle_factor
    return f"{float(middle - half)!r} {unit}".rstrip(), f"{float(middle + half)!r} {unit}".rstrip()


def is_number_with_any_unit(text: str) -> bool:
    """Return whether a text is a single number, alone or with any unit."""
    parts = number_and_unit(text)
    try:
        return parts is not None and (parts[1] in _SPOKEN or _parse_unit(parts[1]) is not None)
    except InputError:
        return False


def number_and_unit(text: str) -> tuple[str, str] | None:
    """Return digits and unit, known or not, from a text that is a single number; None for any other text."""
    match = _VALUE.fullmatch(text.translate(_TYPESET)) if len(text) <= _LONGEST else None
    return None if match is None else (match[1], _unit_of_match(match))


def _unit_of_match(match: re.Match[str]) -> str:
    """Return the unit of a value, "" if it has none; spaces are removed if it is in `_SPOKEN`."""
    unit = (match[2] or match[3] or "").strip()
    plain = "".join(unit.split())
    return plain if plain in _SPOKEN else unit


def quoted_if_unprintable(name: str) -> str:
    """Return a name for a message: unchanged, or quoted if part of it cannot be printed."""
    return name if name.isprintable() else quote(name)


def quote(value: object) -> str:
    """Return a value for a message: as in a job file, printable, of moderate length."""
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, str):
        text = value if len(value) <= _LONGEST else value[:_LONGEST] + "..."
        quoted = json.dumps(text, ensure_ascii=False)
        return "".join(sign if sign.isprintable() else json.dumps(sign)[1:-1] for sign in quoted)
    if isinstance(value, Mapping):
        return f"a table of {count_with_noun(len(value), 'key')}" if value else "an empty table"
    if isinstance(value, list | tuple):
        plain = len(value) <= 4 and not any(isinstance(x, list | tuple | Mapping) for x in value)
        inner = ", ".join(map(quote, value)) if plain else ""
        return f"[{inner}]" if plain else f"a list of {len(value)}"
    if isinstance(value, bytes):
        return f"{len(value)} bytes"
    if isinstance(value, int) and value.bit_length() > 200:
        return "a very long whole number"
    text = str(value) if isinstance(value, int | float | date | time) else reprlib.repr(value)
    return text if text.isprintable() else ascii(text)


def closest_word(word: str, words: Iterable[str]) -> str | None:
    """Return the word that a misspelt one probably means; None if none is close."""
    by_fold = {candidate.casefold(): candidate for candidate in words}
    typed = word.casefold()[:_LONGEST]
    near = difflib.get_close_matches(typed, by_fold, n=1, cutoff=0.6)
    near = near or sorted((folded for folded in by_fold if typed in folded.split("_")), key=len)
    near = near or [folded for folded in by_fold if len(typed) > 2 and folded.startswith(typed)]
    return by_fold[near[0]] if near else None


def letters_and_digits(unit: str) -> str:
    """Return the letters and digits of a unit: Nm for N_m, N m and N·m."""
    return re.sub(r"[^\w°]|_", "", unit.replace("²", "2").replace("³", "3"))


def without_word_in(text: str) -> str:
    """Return a unit without the word "in" from "force in N".

    The inch in lbf in and ozf in, the only torques with an inch, stays."""
    stated = _IN.match(text)
    return text if stated is None else text[stated.end() :]


def unit_in_heading(text: str, kind: Kind) -> str | None:
    """Return the unit in a heading, spelled as in jobs; None if the kind does not have it."""
    display_symbols = [unit.symbol for unit in (kind.metric, kind.inch) if unit is not None]
    listed = next(
        (
            symbol
            for symbol in (*kind.typed, *display_symbols)
            if letters_and_digits(symbol) == letters_and_digits(text)
        ),
        None,
    )
    try:
        return listed or (text.strip() if to_si(f"1 {text}", kind) else None)
    except InputError:
        return None


def _read_exact_value(text: str, kind: Kind, rule: str, write: str) -> Fraction:
    """Return the exact SI value of a string."""
    if len(text) > _LONGEST:
        raise InputError(f"{rule}; got a string of {len(text)} characters; {write}")
    if text.strip().casefold().lstrip("+-").split(" ")[0] in ("nan", "inf", "infinity"):
        raise InputError(f"must be a finite number; got {quote(text)}; {write}")
    if re.search(r"\d,\d", text):
        point, parted = text.replace(",", "."), text.replace(",", "")
        if text.count(",") > 1:
            raise InputError(f"must not contain commas; got {quote(text)}; write {quote(parted)}")
        if re.fullmatch(r"\s*[-+]?[1-9]\d{0,2},\d{3}(?!\d).*", text):
            raise InputError(
                f"must not contain a comma; got {quote(text)}; write {quote(parted)} if the comma separates thousands, "
                f"or {quote(point)} if it is a decimal comma"
            )
        parts = number_and_unit(point)
        if kind.unit and parts and not parts[1]:
            point = f"{parts[0]} {kind.metric.symbol}"
        raise InputError(f"use a decimal point, not a comma; got {quote(text)}; write {quote(point)}")
    match = _VALUE.fullmatch(text.translate(_TYPESET))
    if share := re.fullmatch(r"\s*([+-]?\d+)\s*/\s*([1-9]\d*)\s*(\D.*)", text, re.ASCII):
        point = f"{float(Fraction(f'{share[1]}/{share[2]}')):.10g} {share[3]}"
        try:
            _read_exact_value(point, kind, rule, write)
        except InputError as error:  # of another kind
            raise InputError(str(error).replace(quote(point), quote(text))) from None
        raise InputError(f"write a decimal number, not a fraction; got {quote(text)}; write {quote(point)}")
    if without_sign := re.fullmatch(r"\s*(?:±|\+/?-)\s*(\d.*)", text):
        raise InputError(f"{rule} without a sign; got {quote(text)}; write {quote(without_sign[1])}")
    if match is None:
        raise InputError(f"{rule}: one number and one unit; got {quote(text)}; {write}")
    if _SPREAD.fullmatch(text.translate(_TYPESET).strip()):
        raise InputError(f"{rule}, a single value; got {quote(text)}, which is a range; {write}")
    if kind.spoken and (two := re.fullmatch(r"\s*([+-]?\d+)1/\s*min\s*", text)):
        raise InputError(
            f'{rule}; got {quote(text)}, which can be read in two ways; write "{two[1]} rpm" or "{two[1]}1 rpm"'
        )
    number, unit = Fraction(match[1]), dict(kind.spoken).get(_unit_of_match(match), _unit_of_match(match))
    if not unit and kind.unit:
        bare = " (in a job file, without quotes)" if "plain number" in write else ""
        raise InputError(f"{rule} with its unit; got {quote(text)}; {write}{bare}")
    if kind.amount:
        if unit != kind.unit:
            raise InputError(f"{rule}; got {quote(text)}; {write}")
        return number
    try:
        factor, dimension = _parse_unit(unit)
    except InputError as error:
        raise InputError(f"{rule}; got {quote(text)}: {error}; {write}") from None
    if dimension != _parse_unit(kind.unit)[1]:
        note, remedy = _kind_of_other_unit(match[1], unit, kind)
        raise InputError(f"{rule}; got {quote(text)}{note}; {remedy or write}")
    for unit_of_kind, symbols, item in _AMBIGUOUS_SYMBOLS:
        if kind.unit == unit_of_kind and re.search(symbols, unit):
            raise InputError(f"{rule}; got {quote(text)}, which is {item}; {write}")
    return number * factor


def _kind_of_other_unit(number: str, unit: str, kind: Kind) -> tuple[str, str]:
    """Return the kind of a unit in words, and what to write instead; each empty if unknown."""
    dimension = _parse_unit(unit)[1]
    kinds = [item for item in (*KINDS, *_OTHERS) if _parse_unit(item.unit)[1] == dimension]
    energies = [item for item in kinds if ("J" in item.unit) == bool(re.search(r"J\b", unit))]
    note = f", which is {(energies or kinds)[0].name}" if kinds else ""
    force = _WEIGHT.sub(r"\1f", unit)
    if force != unit and _parse_unit(force)[1] == _parse_unit(kind.unit)[1]:
        newtons = f"{float(Fraction(number) * _parse_unit(force)[0]):.4g} {kind.unit}"
        return note, f'a weight must be stated as a force: write "{number} {force}" or "{newtons}"'
    return note, f"write the mass in {kind.unit}" if kinds and kind.name_without_article == "mass" and _parse_unit("N")[
        1
    ] == dimension else ""


@functools.lru_cache(maxsize=256)
def _parse_unit(text: str) -> tuple[Fraction, Dimension]:
    """Return the factor to SI and the dimension for a unit such as "kg m^2", "N s/m" or "m/s^2".

    Names are separated by spaces, hyphens or multiplication signs. One division sign is allowed, before the last name:
    a product after it ("N/m s") is ambiguous and is refused. The text before it may be empty or 1: "1/s".
    """
    rest, factor, dimension = _INVERSE.sub("/", text.rstrip()), Fraction(1), dict[str, int]()
    divided, first = False, True
    while rest:
        match = _FACTOR.match(rest)
        if match is None or (first and match[1] not in ("", "/")):
            hint = _HINTS.get(rest.strip())
            raise InputError(f"{quote(rest.strip())} is not a unit{f', {hint}' if hint else ''}")
        sign, name = match[1], match[2]
        if divided:
            raise InputError("a unit must end with the name after its division sign")
        divided = sign == "/"
        power = int(match[3] or 1) * (-1 if divided else 1)
        quantity = _factor_and_dimension_of_unit(name)
        factor *= quantity[0] ** power
        for base, exponent in quantity[1]:
            dimension[base] = dimension.get(base, 0) + exponent * power
        rest, first = rest[match.end() :], False
    return factor, frozenset((base, power) for base, power in dimension.items() if power)


def _factor_and_dimension_of_unit(name: str) -> tuple[Fraction, tuple[tuple[str, int], ...]]:
    """Return the factor to SI and the dimension for a single unit name, with its prefix."""
    name = "deg" if name == "°" else name
    if name in _USUAL:
        return _USUAL[name]
    registry = _unit_registry()
    if name == "Grad" or not registry.parse_unit_name(name):  # else a gigaradian
        hint = _HINTS.get(name)
        near = None if hint else closest_word(name, _COMMON)
        hint_text = f", {hint}" if hint else f", did you mean {near}?" if near else ""
        raise InputError(f"{quote(name)} is not a known unit{hint_text}")
    value = registry.Quantity(Fraction(1), name).to_root_units()
    powers = tuple((str(base), int(power)) for base, power in value.dimensionality.items())
    return Fraction(value.magnitude), powers


@functools.cache
def _unit_registry() -> Any:
    """Return the registry with the units above, built when first needed."""
    import pint

    registry: Any = pint.UnitRegistry(None, non_int_type=Fraction)
    for definition in _DEFINITIONS.strip().splitlines():
        registry.define(definition)
    return registry
