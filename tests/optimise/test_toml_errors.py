"""Mistakes in the syntax of TOML: key, rule, the line as typed, and a line that can be read in its place."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job.file import toml_tables

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
    "[[load]\n": "a table name must have the same brackets on both sides; got [[load] in line 1; write [[load]]",
    "\n[variables  # of the search\n": (
        "a table name must have the same brackets on both sides; got [variables  # of the search in line 2; "
        "write [variables] # of the search"
    ),
    "variables]\n": (
        "a table name must have the same brackets on both sides; got variables] in line 1; write [variables]"
    ),
    "[friction]\nguide = .5\n": (
        "friction.guide: numbers are written like 2 or 0.5; got guide = .5 in line 2; write guide = 0.5"
    ),
    "[friction]\nguide = 5.\n": (
        "friction.guide: numbers are written like 2 or 0.5; got guide = 5. in line 2; write guide = 5.0"
    ),
    "[optimiser]\ndesigns = 02\n": (
        "optimiser.designs: numbers are written like 2 or 0.5; got designs = 02 in line 2; write designs = 2"
    ),
    "[tolerances]\ncrank = .05\n": (
        "tolerances.crank: numbers are written like 2 or 0.5 and give the unit, such as mm; got crank = .05 in line 2; "
        'write crank = "0.05 mm"'
    ),
    "[mechanism]\nslider = { mass = 1,5 }\n": (
        "mechanism.slider: use a decimal point and give the unit, such as kg; got slider = { mass = 1,5 } in line 2; "
        'write slider = { mass = "1.5 kg" }'
    ),
    '[mechanism]\nspeed = "60 rpm";\n': (
        'mechanism.speed: a line must end after its value; got speed = "60 rpm"; in line 2; write speed = "60 rpm"'
    ),
    '[mechanism]\nspeed = "60 rpm" ;  # fast\n': (
        'mechanism.speed: a line must end after its value; got speed = "60 rpm" ;  # fast in line 2; '
        'write speed = "60 rpm"  # fast'
    ),
    '[mechanism]\nspeed = "60 rpm", gravity = 9.81 m/s^2\n': (
        "mechanism.speed: each key must have a line of its own; a value with a unit must be in quotes; got "
        'speed = "60 rpm", gravity = 9.81 m/s^2 in line 2; write speed = "60 rpm" and below it gravity = "9.81 m/s^2"'
    ),
    '[mechanism]\nrod = { mass = "1 kg" inertia = "2 kg m^2" }\n': (
        "mechanism.rod: values must be separated by commas; got "
        'rod = { mass = "1 kg" inertia = "2 kg m^2" } in line 2; write rod = { mass = "1 kg", inertia = "2 kg m^2" }'
    ),
    "[variables]\ncrank = [20 mm; 80 mm]\n": (
        "variables.crank: a value with a unit must be in quotes; values must be separated by commas; got "
        'crank = [20 mm; 80 mm] in line 2; write crank = ["20 mm", "80 mm"]'
    ),
    "x = [0,5; 0,7]\n": (
        "x: values must be separated by commas, and decimals by a point; got x = [0,5; 0,7] in line 1; "
        "write x = [0.5, 0.7]"
    ),
    "// the speed\n": "a comment must begin with #; got // the speed in line 1; write # the speed",
    '[mechanism]\nspeed: "60 rpm"\n': (
        'mechanism.speed: there must be = between a key and its value; got speed: "60 rpm" in line 2; '
        'write speed = "60 rpm"'
    ),
    "[mechanism]\nspeed = “60 rpm”\n": (
        'mechanism.speed: text must be in straight quotes; got speed = “60 rpm” in line 2; write speed = "60 rpm"'
    ),
    '[variables]\ncrank = ["20 mm, "60 mm"]\n': (
        'variables.crank: text must have quotes on both sides; got crank = ["20 mm, "60 mm"] in line 2; '
        'write crank = ["20 mm", "60 mm"]'
    ),
    '[variables]\ncrank = ["20 mm", "60 mm"\nrod = "1 m"\n': (
        'variables.crank: a list must end with ]; got crank = ["20 mm", "60 mm" in line 2 without ] '
        "before line 3; add it"
    ),
    'x = [\n"a",\n"b"\n\n"c"]\n': 'x: values must be separated by commas; got "b" in line 3; write "b",',
    'x = [\n"a",\n5 mm,\n]\n': 'x: a value with a unit must be in quotes; got 5 mm, in line 3; write "5 mm",',
    'x = """a\nb\n': (
        'x: text after """ must end with """; got x = """a in line 1 without """ before the end of the file; add it'
    ),
    'file = "C:\\data\\x.csv"\n': (
        'file: folders in a path must be separated by /; got file = "C:\\data\\x.csv" in line 1; '
        'write file = "C:/data/x.csv"'
    ),
    "[mechanism]\nspeed =\n": (
        'mechanism.speed: must be a line like speed = "300 rpm"; got speed = in line 2; write keys in plain letters, '
        "and texts and values with units in quotes"
    ),
    "[mechanism]\nspeed\n": (
        "must be a line like key = value, [table], or # and a comment; got speed in line 2; write keys "
        "in plain letters, "
        "and texts and values with units in quotes"
    ),
    '[mechanism]\nspeed = "3 rpm"\nspeed = "4 rpm"\n': (
        "mechanism.speed: may be given only once; got it in lines 2 and 3; remove one"
    ),
    '[mechanism]\nslider = { mass = "2 kg" }\nslider.mass = "3 kg"\n': (
        "mechanism.slider: may be given only once; got it in lines 2 and 3; put its keys in one place"
    ),
    '[mechanism]\nslider = { mass = "1 kg", mass = "2 kg" }\n': (
        "mechanism.slider.mass: may be given only once; got it twice in line 2; remove one"
    ),
    "[friction]\n[mechanism]\n[friction]\n": (
        "friction: may be given only once; got it in lines 1 and 3; put its keys in one place"
    ),
    '[load]\nforce = "1 N"\n[mechanism]\nspeed = "1 rpm"\n[[load]]\nforce = "2 N"\n': (
        "load: must be a list of tables, in double brackets; got [load] in line 1; write [[load]]"
    ),
    '[[load]]\nforce = "1 N"\n[mechanism]\nspeed = "1 rpm"\n[load]\nforce = "2 N"\n': (
        "load: must be a list of tables, in double brackets; got [load] in line 5; write [[load]]"
    ),
    "[mechanism]\n[[mechanism]]\n": (
        "mechanism: must be a single table, in single brackets; got [[mechanism]] in line 2; write [mechanism]"
    ),
    '[[load]]\nforce = "1 N"\n[[load]]\nforce = 2 N\n': (
        'load #2.force: a value with a unit must be in quotes; got force = 2 N in line 4; write force = "2 N"'
    ),
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=[repr(text)[1:40] for text in REFUSED])
def test_a_mistake_is_told_with_key_rule_line_and_remedy(text: str, message: str) -> None:
    assert refusal(text) == message


def odd(line: str) -> str:
    return re.sub(r'"([^"]*)"', r"“\1”", line)


SLIPS: dict[str, Callable[[str], str]] = {
    "semicolon at the end": lambda line: f"{line};",
    "another sign of comments": lambda line: f"{line} // as drawn",
    "curly quotes": odd,
    "colon": lambda line: line.replace(" = ", ": "),
    "no equals sign": lambda line: line.replace(" = ", " ", 1),
    "semicolons in a list": lambda line: line.replace('", "', '"; "'),
    "values without quotes": lambda line: re.sub(r'"([+-]?\d[^",]*)"', r"\1", line),
    "first quote missing": lambda line: line.replace('"', "", 1),
    "last quote missing": lambda line: "".join(line.rsplit('"', 1)),
    "bracket missing": lambda line: line[:-1] if line.startswith("[") else line,
    "round brackets": lambda line: re.sub(r"= \[(.*)\]$", r"= (\1)", line),
    "curly quotes and a semicolon": lambda line: f"{odd(line)};" if odd(line) != line else line,
}


@pytest.mark.parametrize("slip", SLIPS.values(), ids=SLIPS)
def test_the_remedy_for_a_slip_in_any_line_of_a_shipped_job_restores_the_job(
    slip: Callable[[str], str], pytestconfig: pytest.Config
) -> None:
    random, tried = np.random.default_rng(35), 0
    for file in sorted(Path(pytestconfig.rootpath, "runs").glob("*.toml")):
        text = file.read_text(encoding="utf-8")
        lines, tables = text.split("\n"), tomllib.loads(text)
        plain = [
            n
            for n, line in enumerate(lines)
            if re.match(r"\[|[a-z_.]+ = ", line) and "#" not in line and len(line) < 78
        ]
        for n in random.permutation(plain)[:8]:
            wrong = [*lines[:n], slip(lines[n]), *lines[n + 1 :]]
            if wrong == lines or is_read(wrong):
                continue
            tried += 1
            message = refusal("\n".join(wrong))
            said = re.search(r"; got (?P<got>.+) in line (?P<line>\d+); write (?P<write>.+)$", message)
            assert said is not None, message
            assert int(said["line"]) == n + 1
            wrong[n] = wrong[n].replace(said["got"], said["write"])
            assert tomllib.loads("\n".join(wrong)) == tables, message
    assert tried >= 4


def is_read(lines: list[str]) -> dict[str, Any] | None:
    try:
        return tomllib.loads("\n".join(lines))
    except ValueError:
        return None
