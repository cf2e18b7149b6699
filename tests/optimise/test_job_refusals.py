"""Bad job files: each gives one message that names the key, the rule or value, and the remedy."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from slidercrank.model.errors import InfeasibleError, JobError
from slidercrank.optimise.job import load_job, parse_job

RUNS = Path(__file__).parents[2] / "runs"
SIEVE = (RUNS / "sieve.toml").read_text(encoding="utf-8")
FEEDER = (RUNS / "feeder.toml").read_text(encoding="utf-8")

SPEED = 'speed = "300 rpm"'
CRANK = 'crank = { width = "30 mm", depth = "20 mm", density = "7800 kg/m^3" }'
CRANK_RANGE = 'crank = ["80 mm", "160 mm"]'
ROD_RANGE = 'rod = ["200 mm", "600 mm"]'
OFFSET_RANGE = 'offset = ["0 mm", "200 mm"]'
STROKE = 'stroke = { equals = "280 mm" }'
ANGLE = 'transmission_angle = { min = "40 deg" }'
LOAD = 'viscous = "15 N s/m"'
RATIO = 'time_ratio = "maximise"'
ERRORS = 'crank = "0.05 mm"\nrod = "0.1 mm"\noffset = "0.1 mm"\ncrank_angle = "0.1 deg"'
DESIGNS = "designs = 100"
LINE = SIEVE[: SIEVE.index(SPEED)].count("\n") + 1

# What is replaced in the sieve's job, by what, and the words that the message must have.
BAD: list[tuple[str, str, list[str]]] = [
    # Keys
    (SPEED, 'spede = "300 rpm"', ["mechanism.spede: unknown key", "did you mean speed?"]),
    (SPEED, "", ["mechanism.speed: is missing", 'speed = "300 rpm"']),
    (SPEED, SPEED + "\nmotor = 3", ['mechanism.motor: unknown key "motor"; it belongs in [drive]; move it there']),
    (SPEED, SPEED + "\nxyz = 3", ["mechanism.xyz", "unknown key", "possible here: speed,"]),
    ("[objectives]", "[objective]", ["objective: unknown heading [objective]; did you mean [objectives]?"]),
    ("[variables]", "[[variables]]", ["variables: there must be only one [variables]", "write [variables]"]),
    ('name = "Vibrating sieve"', "", ["name: is missing", "for example, add name ="]),
    ('name = "Vibrating sieve"', "name = 3", ["name: must be text in quotes", "got 3"]),
    ('name = "Vibrating sieve"', 'name = " "', ["name: must be one line of text, not empty"]),
    ('name = "Vibrating sieve"', 'name = "a\\nb"', ["name: must be one line", '"a\\nb"']),
    ('name = "Vibrating sieve"', f'name = "{"x" * 90}"', ["name", "at most 80", "shorten"]),
    # Units and values
    (SPEED, 'speed = "300 mm"', ["mechanism.speed", '"300 mm", which is a length', '"300 rpm"']),
    (SPEED, 'speed = "5 s^-1"', ["mechanism.speed", "s^-1", "may count turns or radians", '"300 rpm"']),
    (SPEED, "speed = nan", ["mechanism.speed", "finite", "nan", '"300 rpm"']),
    (SPEED, "speed = inf", ["mechanism.speed", "finite", "inf"]),
    (SPEED, "speed = true", ["mechanism.speed", "angular speed", "true"]),
    (SPEED, "speed = 0", ["mechanism.speed", "must not be 0", '"0.1 rpm"']),
    (SPEED, "speed = 1979-05-27", ["mechanism.speed", "1979-05-27", '"300 rpm"']),
    (SPEED, 'speed = ""', ["mechanism.speed", 'got ""', '"300 rpm"']),
    ('"1.95 kg"', '"-1.95 kg"', ["mechanism.slider.mass", "zero or more", '"-1.95 kg"']),
    ('"1.95 kg"', '"1.95 kilo"', ["mechanism.slider.mass", '"kilo" is not a known unit', '"0.8 kg"']),
    ('gravity = "9.81 m/s^2"', 'gravity = "9.81 g"', ["mechanism.gravity", "is a mass", '"9.81 m/s^2"']),
    (
        'gravity = "9.81 m/s^2"',
        'gravity_direction = "270 deg"',
        ["mechanism", "gravity_direction needs gravity", 'add gravity = "9.81 m/s^2"'],
    ),
    (SPEED, SPEED + '\nbranch = "cross"', ["mechanism.branch", '"open" or "crossed"', '"cross"']),
    # Links
    (CRANK, 'crank = "140 mm"', ["mechanism.crank", "table", '"140 mm"', "belongs in [variables]"]),
    (CRANK, CRANK[:-2] + ', mass = "1 kg" }', ["mechanism.crank", "not by both", "leave out one"]),
    (CRANK, CRANK.replace('depth = "20 mm", ', ""), ["mechanism.crank.depth: is missing", '"20 mm"']),
    (CRANK, 'crank = { inertia = "1 kg m^2" }', ["mechanism.crank.mass: is missing"]),
    (CRANK, CRANK.replace('"30 mm"', '"0 mm"'), ["mechanism.crank.width", "positive", '"0 mm"']),
    # Loads
    (LOAD, 'viscos = "15 N s/m"', ["load #2", "got viscos", "did you mean viscous?"]),
    (LOAD, 'viscous = "15 N/m"', ["load #2.viscous", "is a stiffness", '"50 N s/m"']),
    (LOAD, 'force = "5 N"', ["load #2", "must also have opposes or helps or direction", "got force"]),
    (LOAD, 'force = "-5 N"\nopposes = "motion"', ["load #2.force", "positive", '"-5 N"']),
    (LOAD, 'force = "5 N"\nopposes = "outward"', ["load #2.opposes", 'did you mean "outward stroke"?']),
    (LOAD, LOAD + '\nstiffness = "5 N/m"', ["load #2", "of one kind", "its own [[load]]"]),
    (LOAD, 'stiffness = "5 N/m"', ["load #2.free_position: is missing", '"25 mm"']),
    (
        LOAD,
        'positions = ["2 mm", "1 mm"]\nforces = ["1 N", "2 N"]',
        ["load #2.positions", "must increase", '"1 mm" after "2 mm"', "sort the table"],
    ),
    (
        LOAD,
        'positions = ["1 mm", "2 mm", "2 mm", "2 mm"]\nforces = ["1 N", "2 N", "3 N", "4 N"]',
        [
            "load #2.positions",
            "except for two equal ones at a step",
            'got "2 mm" three times',
            "keep the values before and after",
        ],
    ),
    (LOAD, 'positions = ["1 mm", "2 mm"]\nforces = ["1 N"]', ["load #2.forces", "at least 2", "got 1"]),
    (
        LOAD,
        'positions = ["1 mm", "2 mm"]\nforces = ["1 N", "2 N", "3 N"]',
        ["load #2", "as many forces as positions", "3 forces"],
    ),
    (
        LOAD,
        'positions = ["1 mm", "2 N"]\nforces = ["1 N", "2 N"]',
        ["load #2.positions #2", "is a force", '"80 mm"'],
    ),
    (
        LOAD,
        'crank_angles = ["0 deg", "400 deg"]\nforces = ["1 N", "1 N"]',
        ["load #2", "at most 360 deg", "got 400 deg", 'set cycle = "720 deg"'],
    ),
    # Tolerances
    ('crank = "0.05 mm"', 'crank = "0,05 mm"', ["tolerances.crank", '"0,05 mm"', "point"]),
    ('crank = "0.05 mm"', 'crank = "120 %"', ["tolerances.crank", "below 100 %", '"0.1 %"']),
    ('crank = "0.05 mm"', 'crank = "-0.1 %"', ["tolerances.crank", "from 0 %", '"-0.1 %"']),
    ('crank = "0.05 mm"', 'crank = "-1 mm"', ["tolerances.crank", "zero or more"]),
    ('crank_angle = "0.1 deg"', 'crank_angle = "0.1 %"', ["tolerances.crank_angle", "angle", "0.1 deg"]),
    ("[tolerances]", "[tolerances]\npart_of_stroke = [0.5, 0.2]", ["part_of_stroke", "[0.5, 0.2]", "start < end"]),
    ("[tolerances]", "[tolerances]\npart_of_stroke = [0.5]", ["part_of_stroke", "missing"]),
    ("[tolerances]", '[tolerances]\nduring = "outward"', ["tolerances.during", '"outward stroke"']),
    (ERRORS, "", ["objectives.position_error", "needs tolerances", "got none", "[tolerances]"]),
    # Ranges
    (CRANK_RANGE, 'crank = ["160 mm", "80 mm"]', ["variables.crank", "empty range", "swap"]),
    (CRANK_RANGE, 'crank = ["80 mm"]', ["variables.crank", "[lower, upper]", '["80 mm"]']),
    (CRANK_RANGE, 'crank = ["0 mm", "160 mm"]', ["variables.crank", "positive", '"0 mm"']),
    (CRANK_RANGE, 'crank = ["80 Mm", "160 Mm"]', ["variables.crank", "at most 10000 m", "check the unit"]),
    (CRANK_RANGE, 'crank = ["80 mm", nan]', ["variables.crank", "finite", "nan"]),
    (CRANK_RANGE, "", ["variables.crank: is missing"]),
    (
        ROD_RANGE,
        'rod = ["50 mm", "80 mm"]',
        ["variables", "exceed crank + |offset|", "rod of at most 80 mm", "lengthen the rod"],
    ),
    (
        OFFSET_RANGE,
        'offset = ["-700 mm", "-600 mm"]',
        ["variables", "full rotation", "offset of at least 600 mm", "reduce the other two"],
    ),
    # Constraints
    (STROKE, 'height = { max = "280 mm" }', ["constraints.height", "did you mean envelope_height?"]),
    (STROKE, "seed = 3", ['constraints.seed: unknown key "seed"; it belongs in [optimiser]; move it there']),
    (
        STROKE,
        'description = "late"',
        [
            "constraints.description: unknown key",
            "description belongs above the first table of the file; move it there",
        ],
    ),
    (STROKE, 'strok = { min = "280 mm" }', ["constraints.strok", "did you mean stroke?"]),
    (STROKE, 'stroke = "280 mm"', ["constraints.stroke: must be a table with equals, min or max", '"280 mm"', "min ="]),
    (STROKE, "stroke = 280", ['write stroke = { equals = "280 mm" }, { min = "280 mm" } or { max = "280 mm" }']),
    (STROKE, "stroke = 0.28", ['write stroke = { equals = "0.28 m" }, {']),
    (STROKE, 'stroke = ">= 60 mm"', ['got ">= 60 mm"; write stroke = { min = "60 mm" }']),
    (STROKE, 'stroke = "at most 60"', ['got "at most 60"; write stroke = { max = "60 mm" }']),
    (STROKE, "time_ratio = 1.2", ["write time_ratio = { equals = 1.2 }, { min = 1.2 } or { max = 1.2 }"]),
    (STROKE, "stroke = {}", ["constraints.stroke", "min, max or equals", "empty"]),
    (STROKE, "stroke = { minimum = 1 }", ["constraints.stroke.minimum", "did you mean min?"]),
    (STROKE, STROKE[:-2] + ', min = "2 mm" }', ["constraints.stroke: equals cannot be combined", 'min "2 mm"; leave']),
    (
        STROKE,
        'stroke = { min = "290 mm", max = "280 mm" }',
        ["constraints.stroke", "min must not exceed max", '"290 mm"', "swap"],
    ),
    (STROKE, 'stroke = { equals = "280 deg" }', ["constraints.stroke.equals", "length", "is an angle"]),
    (STROKE, 'stroke = { max = "-1 mm" }', ["constraints.stroke", "never negative", "-1 mm"]),
    (
        STROKE,
        'stroke = { equals = "600 mm" }',
        ["constraints.stroke", "transmission_angle at least 40 deg", "at most 360.57 mm", "equals 600 mm", "allow"],
    ),
    (STROKE, 'stroke = { max = "150 mm" }', ["constraints.stroke", "at least 160 mm", "max 150 mm", "2 crank"]),
    (STROKE, "rod_to_offset = { equals = 0.9 }", ["constraints.rod_to_offset", "above 1", "0.9"]),
    (
        STROKE,
        "rod_to_offset = { equals = 1.2 }",
        ["constraints.rod_to_offset", "crank below rod - |offset|", "equals 1.2", "crank of at least 80 mm"],
    ),
    (STROKE, "rod_to_crank = { min = 8 }", ["constraints.rod_to_crank", "at most 7.5", "min 8", "rod"]),
    (STROKE, "time_ratio = { min = 0.8 }", ["constraints.time_ratio", "1 or more", "min 0.8", "inverse"]),
    (
        STROKE,
        "time_ratio = { min = 3.5 }",
        ["constraints.time_ratio", "transmission_angle at least 40 deg", "at most 1.2862", "min 3.5"],
    ),
    (
        STROKE,
        "time_ratio = { min = 1.5 }",
        ["constraints.time_ratio", "at most 1.2862;", "min 1.5", "transmission_angle to 27.4576 deg", "40 deg"],
    ),
    (STROKE, "force_transmission = { min = 1.4 }", ["constraints.force_transmission", "between 0 and 1", "min 1.4"]),
    (ANGLE, 'transmission_angle = { min = "95 deg" }', ["constraints.transmission_angle", "95 deg", "0 and 90 deg"]),
    (ANGLE, "transmission_angle = { min = 40 }", ["constraints.transmission_angle", "plain number is in rad"]),
    (
        ANGLE,
        'transmission_angle = { min = "88 deg" }',
        ["transmission_angle", "at most 76.5066 deg", "min 88 deg", "rod"],
    ),
    (ANGLE, 'transmission_angle = { max = "0 deg" }', ["transmission_angle", "0 deg", "ends excluded"]),
    # Objectives
    (RATIO, 'time_ration = "maximise"', ["objectives.time_ration", "did you mean time_ratio?"]),
    (RATIO, 'time_ratio = "maximum"', ["objectives.time_ratio", '"maximum"', 'did you mean "maximise"?']),
    (RATIO, "time_ratio = 3", ["objectives.time_ratio", "{ target = value }", "got 3"]),
    (RATIO, "time_ratio = { target = 0.9 }", ["objectives.time_ratio", "1 or more", "target 0.9"]),
    (RATIO, 'time_ratio = { target = "2 s" }', ["objectives.time_ratio.target", "ratio", "is a time"]),
    (RATIO, "time_ratio = {}", ["objectives.time_ratio.target: is missing", "target ="]),
    (RATIO, 'stroke = "minimise"', ["objectives.stroke", "with a fixed value", "leave out one"]),
    (OFFSET_RANGE, "offset = 0", ["objectives.time_ratio", "without offset", "variables.offset a range"]),
    # Optimiser
    (DESIGNS, "designs = 0", ["optimiser.designs", "at least 1", "got 0", "designs = 100"]),
    (DESIGNS, "designs = 10001", ["optimiser.designs", "at most 10000", "10001"]),
    (DESIGNS, "designs = 1.5", ["optimiser.designs", "whole number", "1.5"]),
    (DESIGNS, "designs = true", ["optimiser.designs", "whole number", "true"]),
    (DESIGNS, 'method = "slqp"', ["optimiser.method", '"auto"', '"slqp"', 'did you mean "slsqp"?']),
    (DESIGNS, 'method = "slsqp"', ["slsqp needs one objective", "got 4", "auto, epsilon_constraint"]),
    (DESIGNS, "evaluations = 100", ["auto has no budget", "100", "name a method"]),
    ("seed = 1", "seed = -1", ["optimiser.seed", "at least 0", "-1"]),
    # Syntax
    (SPEED, "speed = ", [f"line {LINE}, mechanism.speed: there must be = and a value", "; write"]),
    (
        SPEED,
        SPEED + "\n" + SPEED,
        [f"line {LINE + 1}, mechanism.speed: may be given only once; got mechanism.speed in line {LINE} already"],
    ),
    (SPEED, SPEED + "\nx = " + "[" * 20 + "]" * 20, ["nested at most 8 deep", "flatten"]),
    (SPEED, SPEED + "\nx = " + "[" * 5000 + "]" * 5000, ["nested at most 8 deep", "flatten"]),
]


@pytest.mark.parametrize(("old", "new", "words"), BAD)
def test_a_bad_job_is_refused_in_one_clear_message(old: str, new: str, words: list[str], tmp_path: Path) -> None:
    assert old in SIEVE
    file = tmp_path / "bad.toml"
    file.write_text(SIEVE.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(JobError) as caught:
        load_job(file)
    message = str(caught.value)
    assert message.startswith(f"{file}: ")
    assert all(word in message for word in words), message
    assert not re.search(r"pydantic|https?:|validation error|Value error|type=|Input should|None", message), message
    assert len(message.splitlines()) == 1


def test_a_rule_between_rod_and_offset_must_fit_the_ranges() -> None:
    data = tomllib.loads(FEEDER.replace('rod = ["50 mm", "250 mm"]', 'rod = ["300 mm", "400 mm"]'))
    said = r"rod_to_offset: .* at least 3.75 is possible; got equals 3.2; allow a shorter rod or"
    with pytest.raises(JobError, match=said):
        parse_job(data)


@pytest.mark.parametrize(
    ("words", "old", "new"),
    [
        ("allow a longer crank", '"160 mm"]', '"180 mm"]'),
        ("or a larger |offset|", '["-100 mm", "0 mm"]', '["-200 mm", "0 mm"]'),
        ("relax transmission_angle", '"40 deg"', '"35 deg"'),
    ],
)
def test_each_remedy_for_a_stroke_out_of_reach_raises_the_limit(words: str, old: str, new: str) -> None:
    changed = SIEVE.replace(STROKE, 'stroke = { equals = "600 mm" }').replace(
        OFFSET_RANGE, 'offset = ["-100 mm", "0 mm"]'
    )
    changed = changed.replace('slow_stroke = "outward"\n', "")
    limits = []
    for text in (changed, changed.replace(old, new)):
        with pytest.raises(InfeasibleError) as caught:
            parse_job(tomllib.loads(text))
        assert words in str(caught.value)
        limits.append(float(re.findall(r"at most ([\d.]+) mm is possible", str(caught.value))[0]))
    assert limits[1] > limits[0]


def test_a_rule_between_rod_and_offset_needs_an_offset() -> None:
    data = tomllib.loads(FEEDER.replace('offset = ["15 mm", "80 mm"]', "offset = 0"))
    del data["objectives"]["time_ratio"]
    with pytest.raises(JobError, match=r"rod_to_offset: needs an offset; the offset is fixed at 0; give"):
        parse_job(data)


@pytest.mark.parametrize("name", ["peak_torque", "rms_torque", "peak_torque_outward", "peak_pivot_force"])
def test_a_torque_or_force_needs_a_mass_or_a_load(name: str) -> None:
    data = tomllib.loads(SIEVE)
    data |= {"mechanism": {"speed": "300 rpm"}, "load": [], "objectives": {name: "minimise"}}
    with pytest.raises(JobError, match=rf"objectives\.{name}: .* masses .* loads.*; got none.* slider = "):
        parse_job(data)


def test_a_crank_alone_loads_its_pivot_but_needs_a_torque_only_under_gravity_or_acceleration() -> None:
    data = tomllib.loads(SIEVE) | {"load": []}
    crank = {"speed": "300 rpm", "crank": {"mass": "1 kg"}}
    parse_job(data | {"mechanism": crank, "objectives": {"peak_pivot_force": "minimise"}})
    wanted = {"objectives": {"peak_torque": "minimise"}}
    with pytest.raises(JobError, match=r"objectives\.peak_torque"):
        parse_job(data | {"mechanism": crank} | wanted)
    parse_job(data | {"mechanism": crank | {"gravity": "9.81 m/s^2"}} | wanted)
    parse_job(data | {"mechanism": crank | {"acceleration": "1 rad/s^2"}} | wanted)


def test_a_misspelt_key_explains_the_missing_one() -> None:
    with pytest.raises(JobError) as caught:
        parse_job(tomllib.loads(SIEVE.replace("speed =", "spede =")))
    assert "missing" not in str(caught.value)


def test_several_problems_are_listed_unknown_keys_first_missing_ones_last() -> None:
    data = tomllib.loads(SIEVE)
    del data["name"]
    data["mechanism"]["slider"]["mass"] = "2 mm"
    data["optimizer"] = {"seed": 2}
    with pytest.raises(JobError) as caught:
        parse_job(data)
    heading, *lines = str(caught.value).splitlines()
    assert heading == "3 problems"
    keys = [line.strip().split(":")[0] for line in lines]
    assert keys == ["optimizer", "mechanism.slider.mass", "name"]


def test_very_many_problems_are_cut_short() -> None:
    with pytest.raises(JobError) as caught:
        parse_job(tomllib.loads(SIEVE) | {f"key{n}": n for n in range(9_000)})
    lines = str(caught.value).splitlines()
    assert len(lines) == 10
    assert lines[0] == "very many problems"
    assert lines[-1].strip() == "... and more"


def test_of_many_problems_the_first_in_the_file_are_listed() -> None:
    tables = tomllib.loads(SIEVE) | {f"key{n}": n for n in range(9)}
    tables["mechanism"] = {"spead": 1, **tables["mechanism"], "speed": "300 mm"}
    with pytest.raises(JobError) as caught:
        parse_job(tables)
    keys = [line.strip().split(":")[0] for line in str(caught.value).splitlines()]
    assert keys == ["11 problems", "mechanism.spead", "mechanism.speed", *(f"key{n}" for n in range(6)), "... and more"]


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ([], "a job must be a table of keys; got []"),
        ("name", 'a job must be a table of keys; got "name"'),
        ({1: 2}, "a key must be text; got 1"),
        ({"name": None}, "name: must have a value; got null"),
        ({"load": [{"viscous": None}]}, "load #1.viscous: must have a value; got null"),
        ({"load": [None]}, "load #1: must be a table such as"),
        ({"robust": {"kind": "percentile", "share": "x"}}, 'robust.share: must be a number; got "x"'),
        ({"choice": [{"name": "a.b", "option": []}]}, "choice #1.name: must begin with a letter"),
        ({"name": [[[[[[[[[[]]]]]]]]]]}, "nested at most 8 deep"),
        ({"a\nb": 1}, '"a\\nb": unknown key'),
        ({"name": "\ud800"}, "name: must be"),
    ],
)
def test_data_that_is_no_job_is_refused(data: object, words: str) -> None:
    with pytest.raises(JobError) as caught:
        parse_job(data)  # type: ignore[arg-type]
    assert words in str(caught.value)


def test_small_messages_tell_the_value_in_the_words_of_the_job() -> None:
    base: dict[str, Any] = {
        "name": "small",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "1 kg"}},
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["150 mm", "300 mm"], "offset": "0 mm"},
        "objectives": {"stroke": "maximise"},
    }

    def said(**tables: Any) -> str:
        with pytest.raises(JobError) as error:
            parse_job(base | tables)
        return str(error.value)

    formula = {"formula": "rod / crank"}
    assert "must have at most 20 entries; got 31;" in said(quantity={f"q{n}": formula for n in range(31)})
    assert "must have 1 to 60 lower-case letters" in (told := said(quantity={"x" * 100: formula}))
    assert "of 100 characters" in told
    for table, value in (("objectives", "minimise"), ("constraints", {"min": 1.0})):
        told = said(**{table: {"zzz": value}})
        assert len(told) < 600
        assert " more, all in `slidercrank schema`" in told
    press = tomllib.loads((Path(__file__).parents[2] / "runs" / "press.toml").read_text(encoding="utf-8"))
    del press["choice"]
    for path in ("eye_concentration", "material.yield_strength"):
        variables: dict[str, Any] = dict(base["variables"])
        variables[f"sections.{path}"] = [2.0, 3.0] if path == "eye_concentration" else ["400 MPa", "500 MPa"]
        with pytest.raises(JobError, match=f"depends smoothly on sections.{path}, so it cannot vary") as error:
            parse_job({**press, "variables": variables, "constraints": {}})
        assert "strength.material" not in str(error.value).replace("sections.material", "")


@pytest.mark.parametrize(
    ("table", "given", "said"),
    [
        (
            "tolerances",
            {"crank": "50 mm"},
            "tolerances.crank: must be less than the crank itself, which may be 20 mm; got 50 mm",
        ),
        (
            "tolerances",
            {"rod": "60 mm"},
            "tolerances.rod: must be less than the rod itself, which may be 60 mm; got 60 mm",
        ),
        (
            "load",
            [{"crank_angles": ["0 deg", "90 deg"], "forces": ["1 N", "2 N"], "measured_from": "crank pivot"}],
            'measured_from: must be "zero crank angle", "inner dead centre" or "outer dead centre"; got "crank pivot"',
        ),
        (
            "load",
            [{"positions": ["0 mm", "9 mm"], "forces": ["1 N", "2 N"], "measured_from": "pivot"}],
            '"crank pivot", "inner dead centre" or "outer dead centre"; got "pivot"; did you mean "crank pivot"?',
        ),
        (
            "variables",
            {"crank": {"min": "20 mm", "max": "60 mm"}, "rod": "100 mm", "offset": "10 mm"},
            'step = "0.5 mm" }, or a range without steps like ["20 mm", "60 mm"]',
        ),
        (
            "quantity",
            {"links": {"function": "links"}},
            'like "mymodule:myfunction", or give the function itself in Python',
        ),
    ],
)
def test_the_remedy_is_that_of_the_place(table: str, given: object, said: str) -> None:
    tables = {
        "name": "x",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "1 kg"}},
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["60 mm", "250 mm"], "offset": "10 mm"},
        "objectives": {"time_ratio": "maximise"},
    }
    with pytest.raises(JobError, match=re.escape(said)):
        parse_job({**tables, table: given})
