"""Mistakes in TOML syntax: key, rule, the line as typed, and a readable line in its place."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import load_job
from slidercrank.optimise.job.job_file import toml_tables
from tests.case_count import case_count

PARSER = re.compile(
    "TOML|Invalid|Expected|Unclosed|Illegal|Unescaped|Unterminated|Cannot|column [0-9]|statement|declar"
)
"""Words of the parser."""


def refusal(text: str) -> str:
    with pytest.raises(JobError) as refused:
        toml_tables(text)
    found = str(refused.value)
    assert not PARSER.search(found), found
    assert len(found.splitlines()) == 1
    return found


REFUSED = {
    "[[load]\n": (
        "line 1: a heading must be one name in matching brackets, its parts joined by dots; got [[load]; write [[load]]"
    ),
    "\n[variables  # of the search\n": (
        "line 2: a heading must be one name in matching brackets, its parts joined by dots; got "
        "[variables; write [variables]"
    ),
    "variables]\n": (
        "line 1: a heading must be one name in matching brackets, its parts joined by dots; got "
        "variables]; write [variables]"
    ),
    "[friction]\nguide = .5\n": (
        "line 2, friction.guide: a number must have digits before and after its point; got guide = .5; "
        "write guide = 0.5"
    ),
    "[friction]\nguide = 5.\n": (
        "line 2, friction.guide: a number must have digits before and after its point; got guide = 5.; "
        "write guide = 5.0"
    ),
    "[optimiser]\ndesigns = 02\n": (
        "line 2, optimiser.designs: a number must not begin with 0; got designs = 02; write designs = 2"
    ),
    "[tolerances]\ncrank = .05\n": (
        "line 2, tolerances.crank: a number must have digits before and after its point, and a unit (mm, "
        'if that is meant); got crank = .05; write crank = "0.05 mm"'
    ),
    "[mechanism]\nslider = { mass = 1,5 }\n": (
        "line 2, mechanism.slider: use a decimal point, and a unit (kg, if that is meant); got slider = "
        '{ mass = 1,5 }; write slider = { mass = "1.5 kg" }'
    ),
    '[mechanism]\nspeed = "60 rpm";\n': (
        'line 2, mechanism.speed: a line must not end with a comma or semicolon; got speed = "60 rpm";; '
        'write speed = "60 rpm"'
    ),
    '[mechanism]\nspeed = "60 rpm" ;  # fast\n': (
        'line 2, mechanism.speed: a line must not end with a comma or semicolon; got speed = "60 rpm" ;; '
        'write speed = "60 rpm"'
    ),
    '[mechanism]\nspeed = "60 rpm", gravity = 9.81 m/s^2\n': (
        "line 2, mechanism.speed: each key must have a line of its own; a value with a unit must be in "
        'quotes; got speed = "60 rpm", gravity = 9.81 m/s^2; write speed = "60 rpm" and below it gravity '
        '= "9.81 m/s^2"'
    ),
    '[mechanism]\nrod = { mass = "1 kg" inertia = "2 kg m^2" }\n': (
        'line 2, mechanism.rod: values must be separated by commas; got rod = { mass = "1 kg" inertia = '
        '"2 kg m^2" }; write rod = { mass = "1 kg", inertia = "2 kg m^2" }'
    ),
    "[variables]\ncrank = [20 mm; 80 mm]\n": (
        "line 2, variables.crank: a value with a unit must be in quotes; values must be separated by "
        'commas; got crank = [20 mm; 80 mm]; write crank = ["20 mm", "80 mm"]'
    ),
    "x = [0,5; 0,7]\n": (
        "line 1, x: use a decimal point; values must be separated by commas; got x = [0,5; 0,7]; write x = [0.5, 0.7]"
    ),
    "// the speed\n": ("line 1: a comment must begin with #; got // the speed; write # the speed"),
    '[mechanism]\nspeed: "60 rpm"\n': (
        'line 2, mechanism.speed: there must be = between a key and its value; got speed: "60 rpm"; '
        'write speed = "60 rpm"'
    ),
    "[mechanism]\nspeed = “60 rpm”\n": (
        'line 2, mechanism.speed: text must be in straight quotes; got speed = “60 rpm”; write speed = "60 rpm"'
    ),
    '[variables]\ncrank = ["20 mm, "60 mm"]\n': (
        'line 2, variables.crank: text must have quotes on both sides; got crank = ["20 mm, "60 mm"]; '
        'write crank = ["20 mm", "60 mm"]'
    ),
    '[variables]\ncrank = ["20 mm", "60 mm"\nrod = "1 m"\n': (
        'line 2, variables.crank: a list must end with ]; got crank = ["20 mm", "60 mm", open at line 3; '
        'write crank = ["20 mm", "60 mm"]'
    ),
    'x = [\n"a",\n"b"\n\n"c"]\n': ('line 3, x: a line of a list must end with a comma; got "b"; write "b",'),
    'x = [\n"a",\n5 mm,\n]\n': ('line 3, x: a value with a unit must be in quotes; got 5 mm,; write "5 mm",'),
    'x = """a\nb\n': (
        'line 1, x: text that begins with """ must end with """; on one line, use a single quote at each '
        'end; got x = """a, open at the end of the file; write x = "a"'
    ),
    'file = "C:\\data\\x.csv"\n': (
        'line 1, file: folders in a path must be separated by /; got file = "C:\\data\\x.csv"; write file '
        '= "C:/data/x.csv"'
    ),
    "[mechanism]\nspeed =\n": (
        'line 2, mechanism.speed: there must be = and a value after a key; got speed =; write speed = "300 rpm"'
    ),
    "[mechanism]\nspeed\n": (
        'line 2, mechanism.speed: there must be = and a value after a key; got speed; write speed = "300 rpm"'
    ),
    '[mechanism]\nspeed = "3 rpm"\nspeed = "4 rpm"\n': (
        "line 3, mechanism.speed: may be given only once; got mechanism.speed in line 2 already; remove one"
    ),
    '[mechanism]\nslider = { mass = "2 kg" }\nslider.mass = "3 kg"\n': (
        "line 3, mechanism.slider.mass: may be given only once; got mechanism.slider in line 2 already; "
        "put both in one place, or remove one"
    ),
    '[mechanism]\nslider = { mass = "1 kg", mass = "2 kg" }\n': (
        "line 2, mechanism.slider.mass: may be given only once; got it twice; remove one"
    ),
    "[friction]\n[mechanism]\n[friction]\n": (
        "line 3, friction: may be given only once; got friction in line 1 already; move the lines below it there"
    ),
    '[load]\nforce = "1 N"\n[mechanism]\nspeed = "1 rpm"\n[[load]]\nforce = "2 N"\n': (
        "line 1, load: each load must begin with [[load]], in double brackets; got [load]; write [[load]]"
    ),
    '[[load]]\nforce = "1 N"\n[mechanism]\nspeed = "1 rpm"\n[load]\nforce = "2 N"\n': (
        "line 5, load: each load must begin with [[load]], in double brackets; got [load]; write [[load]]"
    ),
    "[mechanism]\n[[mechanism]]\n": (
        "line 2, mechanism: there must be only one [mechanism], in single brackets; got [[mechanism]]; "
        "write [mechanism]"
    ),
    '[[load]]\nforce = "1 N"\n[[load]]\nforce = 2 N\n': (
        'line 4, load #2.force: a value with a unit must be in quotes; got force = 2 N; write force = "2 N"'
    ),
    "[sections,material]\n": (
        "line 1: a heading must be one name in matching brackets, its parts joined by dots; got "
        "[sections,material]; write [sections.material]"
    ),
    "[ objec tives ]\n": (
        "line 1: a heading must be one name in matching brackets, its parts joined by dots; got [ "
        "objec tives ]; write [objectives]"
    ),
    "objectives:\n": (
        "line 1: a heading must be one name in matching brackets, its parts joined by dots; got "
        "objectives:; write [objectives]"
    ),
    "{objectives}\n": (
        "line 1: a heading must be one name in matching brackets, its parts joined by dots; got "
        "{objectives}; write [objectives]"
    ),
    "(load)\n": (
        "line 1: a heading must be one name in matching brackets, its parts joined by dots; got (load); write [[load]]"
    ),
    "[mechanism]\nspeed = ''60 rpm''\n": (
        "line 2, mechanism.speed: text must be in straight quotes; got speed = ''60 rpm''; write speed = \"60 rpm\""
    ),
    '[mechanism]\nspeed = "60 rpm""\n': (
        'line 2, mechanism.speed: one " too many; got speed = "60 rpm""; write speed = "60 rpm"'
    ),
    '[mechanism]\nspeed "=60 rpm"\n': (
        'line 2, mechanism.speed: there must be = between a key and its value; got speed "=60 rpm"; '
        'write speed = "60 rpm"'
    ),
    '[mechanism]\n"speed = 60 rpm"\n': (
        'line 2, mechanism.speed: only a value may be in quotes; got "speed = 60 rpm"; write speed = "60 rpm"'
    ),
    '[mechanism]\nspeed = "60 rpm" as drawn\n': (
        'line 2, mechanism.speed: a comment must begin with #; got speed = "60 rpm" as drawn; write '
        'speed = "60 rpm"  # as drawn'
    ),
    '[mechanism]\nspeed\xa0= "60 rpm"\n': (
        "line 2, mechanism.speed: a space must be an ordinary space, not a non-breaking one (␣) from Word or "
        'a web page; got speed␣= "60 rpm"; write speed = "60 rpm"'
    ),
    "[mechanism]\nspeed = −60 rpm\n": (
        'line 2, mechanism.speed: a value with a unit must be in quotes; got speed = −60 rpm; write speed = "−60 rpm"'
    ),
    '[mechanism]\nslider = mass = "1 kg" }\n': (
        'line 2, mechanism.slider: keys within a value must be in braces; got slider = mass = "1 kg" }; '
        'write slider = { mass = "1 kg" }'
    ),
    '[mechanism]\nslider = { mass = "1 kg"  # steel\n': (
        'line 2, mechanism.slider: keys within a value must be in braces; got slider = { mass = "1 kg"; '
        'write slider = { mass = "1 kg" }'
    ),
    '[mechanism]\nslider = { mass = "1 kg",\ninertia = "1 kg m^2" }\n': (
        "line 2, mechanism.slider: a text, or keys in braces, must be on one line; got lines 2 to 3; join them"
    ),
    '[variables]\ncrank = ["20 mm",, "60 mm"]\n': (
        'line 2, variables.crank: there must be one comma between values; got crank = ["20 mm",, "60 '
        'mm"]; write crank = ["20 mm", "60 mm"]'
    ),
    '[variables]\ncrank = ["20 mm", "60 mm"]]\n': (
        'line 2, variables.crank: one ] too many; got crank = ["20 mm", "60 mm"]]; write crank = ["20 mm", "60 mm"]'
    ),
    '[variables]\ncrank = "20 mm", "60 mm"]\n': (
        'line 2, variables.crank: a list must be in square brackets; got crank = "20 mm", "60 mm"]; '
        'write crank = ["20 mm", "60 mm"]'
    ),
    '[variables]\ncrank = {"20 mm", "60 mm"}\n': (
        'line 2, variables.crank: a list must be in square brackets; got crank = {"20 mm", "60 mm"}; '
        'write crank = ["20 mm", "60 mm"]'
    ),
    "[variables]\ncrank = [20, 60] mm\n": (
        "line 2, variables.crank: each value must have its unit; got crank = [20, 60] mm; write crank = "
        '["20 mm", "60 mm"]'
    ),
    "[variables]\ncrank = [20 .. 60 mm]\n": (
        'line 2, variables.crank: each end of a range must be a separate string; got ["20 .. 60 mm"]; '
        'write ["20 mm", "60 mm"]'
    ),
    "[variables]\ncrank = [0,02; 0,06]\n": (
        "line 2, variables.crank: use a decimal point, and a unit (mm, if that is meant); values must be "
        'separated by commas; got crank = [0,02; 0,06]; write crank = ["0.02 mm", "0.06 mm"]'
    ),
    '[constraints]\ntransmission_angle = { min "40 deg" }\n': (
        "line 2, constraints.transmission_angle: there must be = between a key and its value; got "
        'transmission_angle = { min "40 deg" }; write transmission_angle = { min = "40 deg" }'
    ),
    '[constraints]\ntransmission_angle = { >= "40 deg" }\n': (
        "line 2, constraints.transmission_angle: a lower limit is written with min; got "
        'transmission_angle = { >= "40 deg" }; write transmission_angle = { min = "40 deg" }'
    ),
    '[constraints]\ntransmission_angle <= "40 deg"\n': (
        "line 2, constraints.transmission_angle: an upper limit is written with max; got "
        'transmission_angle <= "40 deg"; write transmission_angle = { max = "40 deg" }'
    ),
    '[objectives]\npeak torque = "minimise"\n': (
        'line 2, objectives.peak_torque: a key must not contain spaces; got peak torque = "minimise"; '
        'write peak_torque = "minimise"'
    ),
    "größe = 1\n": (
        'line 1, "größe": a key outside quotes must consist of the letters a to z, digits, _ and -; got '
        'größe = 1; write "größe" = 1'
    ),
    "of both strokes at full speed\n": (
        "line 1: a comment must begin with #; got of both strokes at full speed; write # of both strokes at full speed"
    ),
    "/* Links */ by section\n": (
        "line 1: a comment must begin with #; got /* Links */ by section; write # Links by section"
    ),
    'description = "a "sieve" tray"\n': (
        'line 1, description: text in double quotes must not contain "; got description = "a "sieve" '
        'tray"; write description = "a \'sieve\' tray"'
    ),
    'description = "a\nb"\n': (
        "line 1, description: a text, or keys in braces, must be on one line; got lines 1 to 2; join them"
    ),
    'description = """a"\nseed = "1"\n': (
        'line 1, description: text that begins with """ must end with """; on one line, use a single '
        'quote at each end; got description = """a", open at the end of the file; write description = '
        '"a"'
    ),
    "[optimiser]\nseed = 1%\n": (
        'line 2, optimiser.seed: must be a whole number; got "1%"; for example, write seed = 1'
    ),
    "[tolerances]\nrod = 1/10 mm\n": (
        'line 2, tolerances.rod: write a decimal number, not a fraction; got "1/10 mm"; write "0.1 mm"'
    ),
    '[constraints]\nstroke = { max = "1 m" }\npeak_torque = { max = "9 N m" }\npeak_torque = "minimise"\n': (
        "line 4, constraints.peak_torque: this value belongs below the heading [objectives]; got it "
        "below [constraints]; write [objectives] above line 4"
    ),
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=[repr(text)[1:40] for text in REFUSED])
def test_a_mistake_is_told_with_key_rule_line_and_remedy(text: str, message: str) -> None:
    assert refusal(text) == message


@pytest.mark.parametrize("line", ["word " * 200 + "!", "[" + "word " * 200 + "=!", "word" * 300 + "!"])
def test_a_line_of_many_words_is_answered(line: str) -> None:
    """An expression that may split a word anywhere would take years for one of twenty words."""
    assert refusal(f'name = "x"\n{line}\n').startswith("line 2")


def odd(line: str) -> str:
    return re.sub(r'"([^"]*)"', r"“\1”", line)


SLIPS: dict[str, Callable[[str], str]] = {
    "semicolon at the end": lambda line: f"{line};",
    "another sign of comments": lambda line: f"{line} // as drawn",
    "no sign of comments": lambda line: f"{line} as drawn" if line.endswith('"') else line,
    "curly quotes": odd,
    "pairs of single quotes": lambda line: line.replace('"', "''"),
    "colon": lambda line: line.replace(" = ", ": "),
    "no equals sign": lambda line: line.replace(" = ", " ", 1),
    "no equals sign in braces": lambda line: re.sub(r"\{ (\w+) = ", r"{ \1 ", line),
    "equals sign in quotes": lambda line: re.sub(r'^(\w+) = "', r'\1 "= ', line),
    "quotes around all": lambda line: re.sub(r'^(\w+) = "(.*)"$', r'"\1 = \2"', line),
    "hard spaces": lambda line: line.replace(" = ", "\u00a0=\u00a0"),
    "space in a key": lambda line: re.sub(r"^(\w+)_", r"\1 ", line),
    "sign of a limit": lambda line: re.sub(r'= \{ min = ("[^"]*") \}', r">= \1", line),
    "sign of a limit in braces": lambda line: line.replace("{ min =", "{ >="),
    "semicolons in a list": lambda line: line.replace('", "', '"; "'),
    "doubled comma": lambda line: line.replace('", "', '",, "', 1),
    "values without quotes": lambda line: re.sub(r'"([+-]?\d[^",]*)"', r"\1", line),
    "unit of a list": lambda line: re.sub(r'\["(\d+) (\w+)", "(\d+) \2"\]', r"[\1, \3] \2", line),
    "first quote missing": lambda line: line.replace('"', "", 1),
    "last quote missing": lambda line: "".join(line.rsplit('"', 1)),
    "quote too many": lambda line: re.sub(r'"$', '""', line),
    "bracket missing": lambda line: line[:-1] if line.startswith("[") else line,
    "bracket too many": lambda line: re.sub(r"(= \[.*\])$", r"\1]", line),
    "first bracket missing": lambda line: line.replace("= [", "= "),
    "last bracket missing": lambda line: re.sub(r"(= \[.*)\]$", r"\1", line),
    "round brackets": lambda line: re.sub(r"= \[(.*)\]$", r"= (\1)", line),
    "first brace missing": lambda line: line.replace("= { ", "= ", 1),
    "last brace missing": lambda line: re.sub(r"( = \{[^{}]*) \}$", r"\1", line),
    "braces around a list": lambda line: re.sub(r"= \[(.*)\]$", r"= {\1}", line),
    "heading with a space": lambda line: re.sub(r"^(\[+\w\w\w)(\w+\])", r"\1 \2", line),
    "heading with a colon": lambda line: re.sub(r"^\[+(\w+)\]+$", r"\1:", line),
    "heading in braces": lambda line: re.sub(r"^\[+(\w+)\]+$", r"{\1}", line),
    "text in two lines": lambda line: re.sub(r'("[^" ]+) ', r"\1\n", line, count=1),
    "braces in two lines": lambda line: re.sub(r"(\{[^}]*?,) ", r"\1\n", line, count=1),
    "three quotes": lambda line: re.sub(r'= "(?=[^"]*"$)', '= """', line),
    "curly quotes and a semicolon": lambda line: f"{odd(line)};" if odd(line) != line else line,
}
SAID = re.compile(r"line (\d+)[^:]*: .*?; got (.+?)(?:, open at .*)?; write (.+)")


def mended(text: str, message: str) -> str:
    """Return a text with the remedy of a message."""
    lines = text.split("\n")
    if joined := re.search("got lines ([0-9]+) to ([0-9]+); join them", message):
        first, last = int(joined[1]), int(joined[2])
        return "\n".join([*lines[: first - 1], " ".join(lines[first - 1 : last]), *lines[last:]])
    said = SAID.fullmatch(message)
    assert said is not None, message
    at, got = int(said[1]) - 1, said[2]
    lines[at] = lines[at].replace("\u00a0", "␣")
    assert got in lines[at], message
    lines[at] = lines[at].replace(got, said[3].replace(" and below it ", "\n"))
    return "\n".join(lines)


@pytest.mark.parametrize("slip", SLIPS.values(), ids=SLIPS)
def test_the_remedy_for_a_slip_in_any_line_of_a_shipped_job_restores_the_job(
    slip: Callable[[str], str], pytestconfig: pytest.Config
) -> None:
    random, tried = np.random.default_rng(35), 0
    for file in sorted(Path(pytestconfig.rootpath, "runs").glob("*.toml")):
        text = file.read_text(encoding="utf-8")
        lines, tables = text.split("\n"), tomllib.loads(text)
        plain = [n for n, line in enumerate(lines) if re.match(r"\[|[a-z_.]+ = ", line)]
        changed = [n for n in plain if slip(lines[n]) != lines[n]]
        for n in random.permutation(changed)[: case_count(2, 6)]:
            wrong = "\n".join([*lines[:n], slip(lines[n]), *lines[n + 1 :]])
            if is_read(wrong):
                continue
            tried += 1
            message = refusal(wrong)
            assert message.startswith(f"line {n + 1}"), message
            assert tomllib.loads(mended(wrong, message)) == tables, message
    assert tried >= 3


def is_read(text: str) -> dict[str, Any] | None:
    try:
        return tomllib.loads(text)
    except ValueError:
        return None


def test_a_heading_that_is_missing_is_named_with_its_place(pytestconfig: pytest.Config, tmp_path: Path) -> None:
    tried = 0
    for file in sorted(Path(pytestconfig.rootpath, "runs").glob("*.toml")):
        lines = file.read_text(encoding="utf-8").split("\n")
        for other in file.parent.glob("*.csv"):
            (tmp_path / other.name).write_bytes(other.read_bytes())
        for n in [n for n, line in enumerate(lines) if re.match(r"\[(tol|var|con|obj|opt)", line)]:
            (tmp_path / "job.toml").write_text("\n".join([*lines[:n], "", *lines[n + 1 :]]), encoding="utf-8")
            with pytest.raises(JobError) as refused:
                load_job(tmp_path / "job.toml")
            message = str(refused.value)
            found = re.search(r"job\.toml: line (\d+), .*; write (\[.*\]) above (?:line (\d+))?", message)
            if found is None:  # of a table of one key
                assert f"it belongs in {lines[n]}" in message
                continue
            place = int(found[3] or found[1]) - 1
            assert all(not line or line.startswith("#") for line in lines[n + 1 : place]), message
            assert lines[n].startswith(found[2]), message
            tried += 1
    assert tried >= 20


VALUES = [
    ("variables", "crank", 'crank = ["30 .. 60 mm"]'),
    ("variables", "crank", 'crank = "30 - 60 mm"'),
    ("variables", "crank", 'crank = "30 mm to 60 mm"'),
    ("variables", "crank", 'crank = ["30 mm, 60 mm"]'),
    ("variables", "crank", "crank = [30 .. 60 mm]"),
    ("tolerances", "rod", 'rod = "1/20 mm"'),
    ("tolerances", "rod", "rod = 3/64 inch"),
    ("tolerances", "rod", 'rod = "0,05"'),
    ("optimiser", "seed", "seed = 1%"),
    ("optimiser", "seed", "seed = yes"),
]


@pytest.mark.parametrize(("table", "key", "line"), VALUES)
def test_the_remedy_for_a_value_is_accepted(
    table: str, key: str, line: str, tmp_path: Path, pytestconfig: pytest.Config
) -> None:
    text = Path(pytestconfig.rootpath, "runs", "feeder.toml").read_text(encoding="utf-8")
    job = tmp_path / "job.toml"
    whole = re.compile(rf"(?m)^(\[{table}\].*\n(?:.+\n)*?){key} = .*$")
    job.write_text(whole.sub(lambda found: found[1] + line, text), encoding="utf-8")
    with pytest.raises(JobError) as refused:
        load_job(job)
    write = re.split(r"; (?:for example, )?write ", str(refused.value))[-1]
    remedy = write if " = " in write else f"{key} = {write}"
    job.write_text(whole.sub(lambda found: found[1] + remedy, text), encoding="utf-8")
    load_job(job)
