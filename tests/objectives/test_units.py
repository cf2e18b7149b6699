"""Values with units: what is read, exactly, and what is refused, with which words."""

import math
import re

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from slidercrank.model.errors import InputError
from slidercrank.objectives import kinds, units
from slidercrank.objectives.kinds import KINDS, Kind
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.units import closest_word, kind_of_symbol, quote, to_si

PLATES = [
    *("1/min", "/min", "min^-1", "U/min", "Upm", "r/min", "r.p.m.", "spm", "SPM", "stroke/min", "strokes/min"),
    *("Hz", "hz"),
]
GOOD = [
    ("80 mm", kinds.LENGTH, 0.08),
    ("80mm", kinds.LENGTH, 0.08),
    ("  35 mm ", kinds.LENGTH, 0.035),
    ("0.31 m", kinds.LENGTH, 0.31),
    ("-50 mm", kinds.LENGTH, -0.05),
    ("1.5e2 mm", kinds.LENGTH, 0.15),
    (".5 m", kinds.LENGTH, 0.5),
    ("20 µm", kinds.LENGTH, 2e-5),
    ("20 um", kinds.LENGTH, 2e-5),
    ("3.15 inch", kinds.LENGTH, 0.08001),
    ("3.15 in", kinds.LENGTH, 0.08001),
    ("1 foot", kinds.LENGTH, 0.3048),
    ("5 thou", kinds.LENGTH, 0.000127),
    (0.08, kinds.LENGTH, 0.08),
    (2, kinds.LENGTH, 2.0),
    ("300 rpm", kinds.ANGULAR_SPEED, 10.0 * math.pi),
    ("-2400 rpm", kinds.ANGULAR_SPEED, -80.0 * math.pi),
    ("5 rev/s", kinds.ANGULAR_SPEED, 10.0 * math.pi),
    ("31.5 rad/s", kinds.ANGULAR_SPEED, 31.5),
    ("180 deg/s", kinds.ANGULAR_SPEED, math.pi),
    ("5 rad s⁻²", kinds.ANGULAR_ACCELERATION, 5.0),
    ("80\u00a0mm", kinds.LENGTH, 0.08),
    ("5\u202fN\u2009m", kinds.TORQUE, 5.0),
    ("360 deg", kinds.ANGLE, 2.0 * math.pi),
    ("20°", kinds.ANGLE, math.pi / 9.0),
    ("60 arcmin", kinds.ANGLE, math.pi / 180.0),
    ("2 mrad", kinds.ANGLE, 0.002),
    ("9.81 m/s^2", kinds.ACCELERATION, 9.81),
    ("9.81 m/s**2", kinds.ACCELERATION, 9.81),
    ("9.81 m s^-2", kinds.ACCELERATION, 9.81),
    ("7800 kg/m^3", kinds.DENSITY, 7800.0),
    ("7800 kg/m3", kinds.DENSITY, 7800.0),
    ("7.8 g/cm³", kinds.DENSITY, 7800.0),
    ("1758.88 kg mm^2", kinds.INERTIA, 1.75888e-3),
    ("3 t", kinds.MASS, 3000.0),
    ("1 lb", kinds.MASS, 0.45359237),
    ("20 kN", kinds.FORCE, 20e3),
    ("1 lbf", kinds.FORCE, 4.4482216152605),
    ("1 kgf", kinds.FORCE, 9.80665),
    ("25 N m", kinds.TORQUE, 25.0),
    ("25 N*m", kinds.TORQUE, 25.0),
    ("25 N·m", kinds.TORQUE, 25.0),
    ("25 Nm", kinds.TORQUE, 25.0),
    ("2.5 kNm", kinds.TORQUE, 2500.0),
    ("1 lbf inch", kinds.TORQUE, 4.4482216152605 * 0.0254),
    *(
        (f"1 {text}", kinds.TORQUE, 4.4482216152605 * 0.3048)
        for text in ("lbf ft", "ft-lbf", "lbf-ft", "ft lbf", "ft*lbf")
    ),
    *((f"1 {text}", kinds.TORQUE, 4.4482216152605 * 0.0254) for text in ("lbf in", "in-lbf", "lbf-in", "inch lbf")),
    *((f"2 {text}", kinds.TORQUE, 19.6133) for text in ("kgf m", "kgf-m", "m kgf", "kp m", "m-kp")),
    *((f"50 {text}", kinds.TORQUE, 0.05) for text in ("N mm", "N-mm", "mm N", "Nmm")),
    ("5 Ncm", kinds.TORQUE, 0.05),
    ("16 ozf in", kinds.TORQUE, 4.4482216152605 * 0.0254),
    ("5 daN m", kinds.TORQUE, 50.0),
    ("1 hp", kinds.POWER, 550 * 0.3048 * 4.4482216152605),
    ("2 bar", kinds.PRESSURE, 2e5),
    ("1 psi", kinds.PRESSURE, 4.4482216152605 / 0.0254**2),
    ("1 ksi", kinds.PRESSURE, 1000 * 4.4482216152605 / 0.0254**2),
    ("1.2 MJ/m^3", kinds.HEAT_PER_VOLUME, 1.2e6),
    ("1.2 J/cm^3", kinds.HEAT_PER_VOLUME, 1.2e6),
    *((f"1.2 {text}", kinds.HEAT_PER_VOLUME, 1.2e6) for text in ("kJ/L", "kJ/l", "kJ/litre", "kJ/dm^3", "kN m/dm^3")),
    ("1 ft lbf/in^3", kinds.HEAT_PER_VOLUME, 12.0 * 4.4482216152605 / 0.0254**2),
    ("250 mL", kinds.VOLUME, 250e-6),
    ("20 L/min", kinds.VOLUME_FLOW, 0.02 / 60.0),
    ("1 gal/min", kinds.VOLUME_FLOW, 3.785411784e-3 / 60.0),
    ("1 kip", kinds.FORCE, 4448.2216152605),
    ("1 lbf/in", kinds.STIFFNESS, 4.4482216152605 / 0.0254),
    ("1 lbf-s/in", kinds.DAMPING, 4.4482216152605 / 0.0254),
    ("3 N s m-1", kinds.DAMPING, 3.0),
    ("1 slug-ft^2", kinds.INERTIA, 4.4482216152605 * 0.3048),
    ("2 kg-m^2", kinds.INERTIA, 2.0),
    ("16 oz", kinds.MASS, 0.45359237),
    ("300 RPM", kinds.ANGULAR_SPEED, 10.0 * math.pi),
    ("20 N/mm", kinds.STIFFNESS, 20e3),
    ("50 N s/m", kinds.DAMPING, 50.0),
    ("50 Ns/m", kinds.DAMPING, 50.0),
    ("7.2 km/h", kinds.SPEED, 2.0),
    ("2500 cm^2", kinds.AREA, 0.25),
    (3.2, kinds.RATIO, 3.2),
    ("3.2", kinds.RATIO, 3.2),
    *((f"300 {unit}", kinds.ANGULAR_SPEED, 10.0 * math.pi) for unit in PLATES[:-2]),
    ("-300 1 / min", kinds.ANGULAR_SPEED, -10.0 * math.pi),
    ("300 min⁻¹", kinds.ANGULAR_SPEED, 10.0 * math.pi),
    ("300/min", kinds.ANGULAR_SPEED, 10.0 * math.pi),
    *((f"5 {unit}", kinds.ANGULAR_SPEED, 10.0 * math.pi) for unit in PLATES[-2:]),
]


@pytest.mark.parametrize(("value", "kind", "expected"), GOOD)
def test_a_value_is_read_in_si_and_rounded_once(value: object, kind: Kind, expected: float) -> None:
    assert to_si(value, kind) == pytest.approx(expected, rel=2e-16, abs=0.0)


@pytest.mark.parametrize("value", [value for value, kind, _ in GOOD if isinstance(value, str) and kind.unit])
def test_what_is_read_matches_the_pattern_of_the_schema(value: str) -> None:
    assert re.match(units.PATTERN, value)


BAD = [
    ("300 mm", kinds.ANGULAR_SPEED, ["angular speed", '"300 mm"', "is a length", '"300 rpm"']),
    *((f"5 {unit}", kind, [f'"5 {unit}"']) for unit in PLATES for kind in (kinds.LENGTH, kinds.TIME, kinds.JERK)),
    ("5 s^-1", kinds.ANGULAR_SPEED, ["frequency", "turns", "radians"]),
    ("300 1/h", kinds.ANGULAR_SPEED, ["which is a frequency that may count turns or radians", "300 rpm"]),
    ("3001/min", kinds.ANGULAR_SPEED, ["in two ways", '"300 rpm" or "3001 rpm"']),
    ("2 kHz", kinds.ANGULAR_SPEED, ["kHz", "300 rpm"]),
    ("5 /s", kinds.ANGULAR_SPEED, ["which is a frequency that may count turns or radians", "300 rpm"]),
    ("3 mN", kinds.TORQUE, ["torque", "is a force", "25 N m"]),
    ("3 J", kinds.TORQUE, ["torque", "is an energy", "25 N m"]),
    ("3 J/s", kinds.TORQUE, ["torque", "is a power", "25 N m"]),
    *(
        (f"20 {text}", kinds.HEAT_PER_VOLUME, ["heat per volume", "is a pressure", '"1.2 MJ/m^3"'])
        for text in ("MPa", "bar", "psi", "N/mm^2", "lbf/in^2")
    ),
    ("20 MJ/m^3", kinds.PRESSURE, ["pressure", "is a heat per volume", '"20 MPa"']),
    ("20 J", kinds.PRESSURE, ["pressure", "is an energy", '"20 MPa"']),
    ("20 MJ", kinds.HEAT_PER_VOLUME, ["heat per volume", "is an energy", "1.2 MJ/m^3"]),
    ("3 N/m", kinds.TORQUE, ["torque", "is a stiffness"]),
    ("3 ft-lb", kinds.TORQUE, ["torque", 'write "3 ft-lbf"']),
    ("3 kg m", kinds.TORQUE, ["torque", 'write "3 kgf m"']),
    ("50 lbs", kinds.FORCE, ["force", "is a mass", 'write "50 lbf"']),
    ("20 lb/in", kinds.STIFFNESS, ["stiffness", 'write "20 lbf/in"']),
    ("3 kg", kinds.TORQUE, ["torque", "is a mass", "25 N m"]),
    ("3 -mm", kinds.LENGTH, ["80 mm"]),
    ("3 N--m", kinds.TORQUE, ["not a unit"]),
    ("3 J", kinds.TORQUE, ["J", "N m"]),
    ("20 degC", kinds.ANGLE, ["degC", "temperatures"]),
    ("20 °C", kinds.ANGLE, ["°C", "temperatures"]),
    ("20 mm/m", kinds.ANGLE, ["angle", "0.1 deg"]),
    ("0.1", kinds.ANGLE, ["with its unit", "0.1 deg"]),
    ("80", kinds.LENGTH, ["with its unit", "80 mm", "plain number in m (in a job file, without quotes)"]),
    ("80 MM", kinds.LENGTH, ["MM", "did you mean mm?"]),
    ("80 milimeter", kinds.LENGTH, ["milimeter"]),
    ("80 Mm", kinds.LENGTH, ["at most 10000 m", "check the unit"]),
    ("1e999 m", kinds.LENGTH, ["at most", "1e999 m"]),
    ("1e9999 m", kinds.LENGTH, ["1e9999 m", "80 mm"]),
    ("2*40 mm", kinds.LENGTH, ['"2*40 mm"', "80 mm"]),
    ("40 mm + 40 mm", kinds.LENGTH, ["80 mm"]),
    ("40 mm 2", kinds.LENGTH, ["80 mm"]),
    ("80 (mm)", kinds.LENGTH, ["not a unit"]),
    ("80 mm^99", kinds.LENGTH, ["not a unit"]),
    ('3.15"', kinds.LENGTH, ["write inch"]),
    ("0,05 mm", kinds.LENGTH, ["use a decimal point, not a comma"]),
    ("0.1 %", kinds.LENGTH, ["%", "tolerance"]),
    ("", kinds.LENGTH, ['""', "80 mm"]),
    ("mm", kinds.LENGTH, ["one number and one unit"]),
    ("1" * 100 + " mm", kinds.LENGTH, ["103 characters"]),
    ("nan mm", kinds.LENGTH, ["finite", "nan"]),
    ("-inf m", kinds.LENGTH, ["finite"]),
    (math.nan, kinds.LENGTH, ["finite", "nan"]),
    (math.inf, kinds.RATIO, ["finite", "inf"]),
    (True, kinds.LENGTH, ["length", "true", "80 mm"]),
    (None, kinds.LENGTH, ["length", "null"]),
    (["80 mm"], kinds.LENGTH, ['["80 mm"]']),
    ({"mm": 80}, kinds.LENGTH, ["a table of 1 key;"]),
    (10**400, kinds.LENGTH, ["a very long whole number", "check the unit"]),
    ("3 N s/m kg", kinds.DAMPING, ["must end with the name after its division sign"]),
    ("3.2 mm", kinds.RATIO, ["ratio", "is a length", "3.2"]),
    ("9.81 g", kinds.ACCELERATION, ["acceleration", "is a mass", "9.81 m/s^2"]),
    ("80 \ud800", kinds.LENGTH, ["\\ud800"]),
    ("80 mm\0", kinds.LENGTH, ["\\u0000"]),
]


@pytest.mark.parametrize(("value", "kind", "words"), BAD)
def test_what_is_no_value_of_the_kind_is_refused_with_the_reason(value: object, kind: Kind, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        to_si(value, kind)
    message = str(caught.value)
    assert all(word in message for word in words), message
    assert message.isprintable()


@pytest.mark.parametrize(("value", "sign"), [("-1 mm", "zero or more"), ("0 mm", "positive"), (-1e-9, "positive")])
def test_a_sign_is_required_where_the_value_needs_one(value: object, sign: units.Sign) -> None:
    with pytest.raises(InputError, match=f"must be {sign}; got"):
        to_si(value, kinds.LENGTH, sign=sign)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_the_example_of_each_kind_is_read_and_its_si_unit_is_one(kind: Kind) -> None:
    assert to_si(kind.example, kind) > 0.0
    assert to_si(f"1 {kind.unit}".rstrip(), kind) == 1.0


@pytest.mark.parametrize("name", QUANTITIES)
def test_every_quantity_has_a_kind_whose_unit_agrees_with_its_factor(name: str) -> None:
    unit = QUANTITIES[name].unit
    one = to_si(f"1 {unit.symbol}".rstrip(), kind_of_symbol(unit.symbol))
    assert one * unit.factor == pytest.approx(1.0, rel=1e-15)


def test_usual_units_are_those_of_the_definitions(monkeypatch: pytest.MonkeyPatch) -> None:
    usual = dict(units._USUAL)
    assert len(usual) > 8
    monkeypatch.setattr(units, "_USUAL", {})
    for name, (factor, powers) in usual.items():
        defined, dimension = units._factor_and_dimension_of_unit(name)
        assert (defined, dict(dimension)) == (factor, dict(powers))


def test_a_kind_is_found_for_another_unit_of_its_dimension() -> None:
    assert kind_of_symbol("kN m") is kinds.TORQUE
    with pytest.raises(InputError, match="no kind of value"):
        kind_of_symbol("kg s")


def assert_answered(value: object, kind: Kind) -> None:
    try:
        number, message = to_si(value, kind), "read"
    except InputError as error:
        number, message = 0.0, str(error)
    assert math.isfinite(number)
    assert message.isprintable()


@given(st.one_of(st.text(max_size=80), st.floats(), st.integers(), st.none(), st.binary()))
@example("1e-999 mm")
@example("+.5e+3 mm")
@example("1 m^-9 m^9 m")
def test_anything_is_either_read_as_a_finite_number_or_refused(value: object) -> None:
    for kind in (kinds.LENGTH, kinds.RATIO):
        assert_answered(value, kind)


@given(st.from_regex(r"[0-9.+-]{1,6} ?[a-zA-Zµ°/*^ 0-9()%-]{0,12}", fullmatch=True))
def test_text_that_looks_like_a_value_is_either_read_or_refused(value: str) -> None:
    for kind in (kinds.LENGTH, kinds.ANGULAR_SPEED):
        assert_answered(value, kind)


def test_values_are_shown_as_in_a_job_file() -> None:
    assert [quote(v) for v in (True, "a", [1, "b"], 0.5, [])] == ["true", '"a"', '[1, "b"]', "0.5", "[]"]
    assert quote([[1], [2]]) == "a list of 2"
    assert quote({"a": 1, "b": 2}) == "a table of 2 keys"
    assert len(quote("x" * 1000)) < 80
    assert quote('5 Ω\n"\u200b') == '"5 Ω\\n\\"\\u200b"'  # escaped only where it cannot be printed


def test_the_nearest_word_is_found_whatever_its_case() -> None:
    assert closest_word("Spede", ["speed", "crank"]) == "speed"
    assert closest_word("something else", ["speed", "crank"]) is None


def test_a_plain_number_is_offered_without_quotes_only_where_it_is_taken() -> None:
    with pytest.raises(InputError, match=r'got "45"; write it like "0\.1 deg"$'):
        to_si("45", kinds.ANGLE, plain=False)
