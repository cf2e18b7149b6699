"""`slidercrank analyse --measured`: files as loggers and spreadsheets write them, and what is told of them."""

from __future__ import annotations

import io
import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.objectives.tables.curve_deviation import curve_deviations
from slidercrank.service.designs import measured_curves_file
from slidercrank.service.designs.measured_curves_file import parse_measured_curves, text_of_measured_file
from slidercrank.service.figures.panel_drawing import draw_panel_figure
from slidercrank.service.figures.panel_figure import panel_in_units
from slidercrank.service.questions.measured import MEASURED
from slidercrank.service.questions.measured import analysis as topic
from slidercrank.service.render.terminal import print_blocks
from slidercrank.service.runs.result import json_text
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.test_figures import overlaps

LINKAGE = Linkage(0.14, 0.31, 0.06)
SIEVE = ("--crank", "140 mm", "--rod", "310 mm", "--offset", "60 mm")
PLAIN = "crank_angle_deg,slider_position_mm\n0,430\n90,300.5\n180,160\n270,240\n"
LARGE = ("--crank", "1400 mm", "--rod", "3100 mm", "--offset", "600 mm", "--speed", "300 rpm")
COMMAS = "crank_angle_deg;slider_position_mm\n0,5;4430,25\n90;3000,5\n180;1600\n270;2400,75\n"
UNNAMED = COMMAS.partition("\n")[2]
DIALECTS: dict[str, str | bytes] = {
    "points that part thousands": re.sub(r"(\d)(\d{3}\b)", r"\1.\2", COMMAS),
    "narrow blanks that part thousands": re.sub(r"(\d)(\d{3}\b)", "\\1\u202f\\2", COMMAS).replace(";", "\t"),
    "a line sep=": "sep=;\n" + COMMAS,
    "comments": f"% logger 7\n{COMMAS}// end\n",
    "names in a comment": "# crank angle (deg);slider position (mm)\n" + UNNAMED,
    "blanks": COMMAS.replace(";", "   "),
    "bars": COMMAS.replace(";", "|"),
    "a line of units": "crank angle;slider position\ndeg;mm\n" + UNNAMED,
    "units after in": "crank angle in deg;slider_position_in_mm\n" + UNNAMED,
    "UTF-16": COMMAS.encode("utf-16"),
    "UTF-16 without a mark": COMMAS.encode("utf-16-be"),
    "Latin-1": ("crank angle (°);slider position (mm)\n" + UNNAMED).encode("latin-1"),
}
ROWS = 120_000
"""More than are kept as text at once."""


def read(text: str) -> list[list[float]]:
    found = parse_measured_curves(text, fronts.MACHINE, LINKAGE)
    return [found.crank_angle.tolist(), *(values.tolist() for values in found.values.values())]


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + PLAIN,
        PLAIN.replace("\n", "\r\n"),
        PLAIN.replace("\n", "\r"),
        PLAIN.replace("\n", "\n\n,\n  \n"),
        "# logger 7\n#\n" + PLAIN + "# end",
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", "\t"),
        PLAIN.replace(",", " , "),
        PLAIN.replace(",", ";").replace(".", ","),
        PLAIN.replace(",", '","').replace("\n", '"\n"')[:-1].replace("crank", '"crank', 1),
        PLAIN.replace(",", ',"').replace("\n", '"\n').replace(".", ","),
        PLAIN.replace("300.5", "3.005E+2"),
        PLAIN.replace("slider_position_mm", "Slider position [mm]"),
        PLAIN.replace("\n", ",20 C,\n").replace("20 C", "note", 1),
        PLAIN.replace("\n", ",1,2\n").replace("1,2", "a,a", 1),
        PLAIN.rstrip("\n"),
    ],
)
def test_a_file_is_read_however_it_was_written(text: str) -> None:
    angles, positions = read(text)
    assert angles == pytest.approx([0.0, 0.5 * math.pi, math.pi, 1.5 * math.pi], rel=1e-12)
    assert positions == pytest.approx([0.43, 0.3005, 0.16, 0.24], rel=1e-12)


@pytest.mark.parametrize(
    ("name", "curve", "factor"),
    [
        ("torque_N_m", "torque", 1.0),
        ("Drive torque (N·mm)", "torque", 1e-3),
        ("TORQUE_Nmm", "torque", 1e-3),
        ("slider_position_cm", "slider_position", 0.01),
        ("Slider  Position, [µm]", "slider_position", 1e-6),
        ("slider acceleration [m/s²]", "slider_acceleration", 1.0),
        ("slider_velocity_mm_s", "slider_velocity", 1e-3),
        ("slider_velocity_mm/s", "slider_velocity", 1e-3),
        ("rod_angle_°", "rod_angle", math.pi / 180.0),
        ("guide_force_kN", "guide", 1e3),
        ("crank_pin_kN", "crank_pin", 1e3),
        ("crank_pin_x_N", "crank_pin_x", 1.0),
        ("power_hp", "power", 745.69987158227),
        ("slider position in mm", "slider_position", 1e-3),
        ("slider_position_in", "slider_position", 0.0254),
        ("slider_velocity_in_s", "slider_velocity", 0.0254),
        ("Torque in N m", "torque", 1.0),
        ("torque in lbf", "torque", 4.4482216152605 * 0.0254),
    ],
)
def test_a_column_may_have_any_unit_of_its_kind(name: str, curve: str, factor: float) -> None:
    found = parse_measured_curves(f'crank_angle_deg\t"{name}"\n0\t2\n', fronts.MACHINE, LINKAGE)
    assert {given: float(values[0]) for given, values in found.values.items()} == {
        curve: pytest.approx(2.0 * factor, rel=1e-12)
    }


@pytest.mark.parametrize("cell", ["", " ", "NaN", "nan", "n/a", "NA", "-", "null"])
def test_what_was_not_measured_is_missing(cell: str) -> None:
    angles, positions = read(PLAIN.replace("300.5", cell).replace("180,", f"{cell},"))
    assert len(angles) == 3
    assert math.isnan(positions[1])
    short = read("crank_angle_deg,slider_position_mm,torque_Nm\n0,430\n90,300,1\n")
    assert math.isnan(short[2][0])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "must begin with a line of column names; got an empty file"),
        ("\n\n# only this\n", "must begin with a line of column names; got an empty file"),
        ("crank_angle_deg,slider_position_mm\n", "must have rows below the column names; got none"),
        (
            "0,430\n90,300\n",
            "must begin with a line of column names with units; got '0, 430'; add one such as crank_angle_deg",
        ),
        (PLAIN.replace("300.5", "abc"), 'row 3, column "slider_position_mm": must be a number; got "abc"'),
        (PLAIN.replace("300.5", "inf"), 'row 3, column "slider_position_mm": must be a number; got "inf"'),
        (PLAIN.replace("300.5", "1e999"), 'row 3, column "slider_position_mm": must be a number; got "1e999"'),
        (PLAIN.replace("300.5", "3_00"), 'row 3, column "slider_position_mm": must be a number; got "3_00"'),
        (PLAIN.replace("300.5", "0x1F"), 'row 3, column "slider_position_mm": must be a number; got "0x1F"'),
        (PLAIN.replace("300.5", "1e90"), "'slider_position_mm' must be at most 10000 m in size; got 1e+90 in row 2"),
        (PLAIN.replace("\n0,", "\ndeg,"), 'row 2, column "crank_angle_deg": must be a number; got "deg"'),
        (
            PLAIN.replace("300.5", "300,5"),
            "row 3 must have 2 cells, like the first line; got 3; correct it, or delete lines above the column names",
        ),
        (
            PLAIN.replace("300.5", '"300,5"').replace("240", "240.5"),
            "must use one decimal sign; got 300,5 and 240.5; write all numbers the same way",
        ),
        (
            PLAIN.replace("300.5", '"1,300"'),
            "must have an unambiguous decimal sign; got 1,300, which may mean a thousand times",
        ),
        (PLAIN.replace("300.5", '"300"x'), "must be a table in CSV; got ',' expected after '\"' in row 3; correct it"),
        (
            PLAIN.replace("slider_position_mm", "crank_angle_deg"),
            "may only be measured once; got the columns 'crank_angle_deg'",
        ),
        (PLAIN.replace("slider_position_mm", "slider_position"), "a column must have its unit in its name"),
        (PLAIN.replace("slider_position_mm", "slider_position_kg"), "got 'slider_position_kg', a mass"),
        (PLAIN.replace("slider_position_mm", "pressure_bar"), "a column must be a curve with its unit"),
        (PLAIN.replace("crank_angle_deg", "angle"), "must have the column crank_angle_deg, or time_s"),
        (PLAIN + "\0", "must be a CSV text file; got a spreadsheet or other binary file"),
        ("a," * 2000 + "\n", "must have at most 1000 columns; got 2001"),
        ("%PDF-1.4 binary", "must be a CSV text file"),
        ('{"crank_angle_deg": [1]}', "must have rows below"),
    ],
)
def test_a_file_that_cannot_be_is_refused_in_a_sentence(text: str, words: str) -> None:
    with pytest.raises(InputError) as refused:
        read(text)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_damaged_files_are_read_or_refused_in_one_line() -> None:
    random = np.random.default_rng(52)
    pieces = [*",;\t\n\r\"'.-+eE09 \0#_[]()°²\x1b", "nan", "inf", "1e308", "1e-320", "_N", "slider_position_mm", '""']
    ends = {"read": 0, "refused": 0}
    for _ in range(400):
        text = PLAIN
        for _ in range(random.integers(1, 5)):
            start = int(random.integers(0, len(text) + 1))
            text = text[:start] + str(random.choice(pieces)) + text[start + int(random.choice([0, 0, 1, 8])) :]
        said = ""
        try:
            measured = parse_measured_curves(text, fronts.MACHINE, LINKAGE)
            numbers: Any = MEASURED.bind_to_design(fronts.MACHINE, LINKAGE, {"measured": measured}).numbers(
                lambda: False
            )
            assert json.loads(json_text(numbers)) == numbers
        except InputError as error:
            said = str(error)
        assert said.isprintable(), text
        ends["refused" if said else "read"] += 1
    assert min(ends.values()) > 20


def test_files_that_are_none_are_refused(tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measured_curves_file, "_LARGEST", 1000)
    large, sheet = tmp_path / "large.csv", tmp_path / "sheet.xlsx"
    large.write_text(PLAIN + "\n" * 1000)
    sheet.write_bytes(b"PK\x03\x04\x14\0")
    for file, words in (
        (tmp_path, "must be a file; got a folder"),
        (large, "must be at most 0.001 MB in size; got more"),
        (tmp_path / "none.csv", "not found; check the name"),
        (sheet, "must be a CSV text file; got a spreadsheet or other binary file; save"),
    ):
        done = command("analyse", *SIEVE, "--measured", file)
        assert (done.exit_code, done.stdout) == (2, "")
        assert words in done.stderr.replace("\n", " ")


@pytest.mark.parametrize("sign", [".", ","])
def test_many_rows_are_read(sign: str) -> None:
    angles = np.arange(ROWS) % 3600
    lines = [f"{angle / 10};{angle}" for angle in range(3600)]
    text = "crank_angle_deg;slider_position_mm\n" + "\n".join(lines[angle] for angle in angles)
    found = parse_measured_curves(text.replace(".", sign), fronts.MACHINE, LINKAGE)
    assert np.array_equal(np.round(1e3 * found.values["slider_position"]), angles)
    np.testing.assert_allclose(found.crank_angle, np.radians(angles / 10.0), rtol=1e-12)


def test_the_cycle_that_is_written_is_read_back_without_a_deviation(tmp_path: Path, command: Command) -> None:
    job, file = fronts.job_file(tmp_path), tmp_path / "cycle.csv"
    for units in ("metric", "inch"):
        assert command("analyse", job, *SIEVE, "--cycle", file, "--units", units).exit_code == 0
        file.write_text(file.read_text().replace("load_", "no_load_"))  # it has zeros, and this job no load
        done = command("analyse", job, *SIEVE, "--measured", file, "--json")
        assert done.exit_code == 0, done.stderr
        record = json.loads(done.stdout)["measured"]
        assert record["rows"] == 360
        lost = [re.sub("_(mm|in|N|lbf)$", "", name) for name in record["left_out"]]
        assert lost == ["no_load", "position_error", "position_error_rss"]
        for name, entry in record["curves"].items():
            (rms,) = (value for key, value in entry.items() if key.startswith("rms_"))
            assert rms < 1e-7, name


def test_a_file_of_any_dialect_gives_the_command_the_numbers_of_a_plain_one(tmp_path: Path, command: Command) -> None:
    file = tmp_path / "run.csv"

    def curves(content: str | bytes) -> Any:
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        done = command("analyse", *LARGE, "--measured", file, "--json")
        assert done.exit_code == 0, (content, done.stderr)
        return json.loads(done.stdout)["measured"]["curves"]

    plain = curves(COMMAS.replace(",", ".").replace(";", ","))
    assert plain["slider_position"]["samples"] == 4
    for name, content in DIALECTS.items():
        assert curves(content) == plain, name


def test_the_command_says_what_it_read_and_which_sign_is_decimal(tmp_path: Path, command: Command) -> None:
    file = tmp_path / "run.csv"
    file.write_text("crank_angle_deg;slider_position_m;room\n0;;20\n90;1.300;20\n180;2.500;20\n")
    arguments = ("analyse", *LARGE, "--measured", file)
    expected = (
        "3 rows of crank_angle_deg, slider_position_m; first 0, empty; last 180, 2.5; separated by semicolons; the "
        "point is read as a decimal point, so 1.300 is 1.3; if it separates thousands, write 1300"
    )
    assert json.loads(command(*arguments, "--json").stdout)["measured"]["understood"] == expected
    assert f"Interpretation of the file: {expected}" in " ".join(command(*arguments).stdout.split())


def test_known_shifts_are_told_in_text_json_and_figure(tmp_path: Path, command: Command) -> None:
    random = np.random.default_rng(51)
    angles = random.uniform(0.0, 720.0, 200)
    at = LINKAGE.at(np.radians(angles - 8.0), speed=10.0 * math.pi)
    rows = [
        f"{angle!r};{1e3 * x + 2.5!r};{v!r};20 °C"
        for angle, x, v in zip(angles.tolist(), at.slider_position.tolist(), at.slider_velocity.tolist(), strict=True)
    ]
    file = tmp_path / "run.csv"
    file.write_text(
        "crank_angle_deg;slider_position_mm;slider_velocity_m_s;room\n" + "\n".join(rows).replace(".", ","),
        encoding="utf-8-sig",
    )
    arguments = ("analyse", *SIEVE, "--speed", "300 rpm", "--measured", file)
    record = json.loads(command(*arguments, "--json").stdout)["measured"]
    position, velocity = record["curves"].values()
    assert record["left_out"] == ["room"]
    assert position["best_crank_angle_shift_deg"] == pytest.approx(-8.0, abs=1e-5)
    assert position["best_shift_mm"] == pytest.approx(-2.5, abs=1e-5)
    assert velocity["best_shift_m_s"] == pytest.approx(0.0, abs=1e-6)
    assert position["left_rms_mm"] < 1e-4 < position["rms_mm"]
    inch = json.loads(command(*arguments, "--json", "--units", "inch").stdout)["measured"]["curves"]
    assert inch["slider_position"]["rms_in"] == pytest.approx(position["rms_mm"] / 25.4, rel=1e-12)
    text = command(*arguments, "--units", "inch").stdout
    assert re.search(rf"slider position +200 +{position['rms_mm'] / 25.4:.6g} .* in\b", text)
    place = tmp_path / "figures"
    told = command(*arguments, "--figures", place)
    assert told.exit_code == 0, told.stderr
    for words in ("Measured minus computed, 200 rows", f"{position['rms_mm']:.6g}", "-8 ", "omitted: room"):
        assert words in told.stdout
    assert (place / "measured.png").read_bytes().startswith(b"\x89PNG")
    sheet = topic.figure(
        fronts.MACHINE, LINKAGE, measured=parse_measured_curves(text_of_measured_file(file), fronts.MACHINE, LINKAGE)
    )
    assert [len(panel.lines) for panel in sheet.panels] == [4, 4]
    assert overlaps(draw_panel_figure(sheet)) == []
    for panel, entry in zip(sheet.panels, record["curves"].values(), strict=True):
        _, fitted, measured, ring = panel_in_units(panel, "metric").lines
        assert np.interp(measured.x, fitted.x, fitted.y) == pytest.approx(measured.y, abs=1e-2)
        assert ring.x == pytest.approx([entry["largest_at_crank_angle_deg"]], rel=1e-9)


def test_a_design_of_a_run_is_compared(tmp_path: Path, kept: Path, command: Command) -> None:
    file = tmp_path / "few.csv"
    file.write_text("time_s,slider_position_mm\n0,300\n")
    done = command("analyse", "latest", "--runs", kept, "--design", 1, "--measured", file, "--json")
    assert done.exit_code == 0, done.stderr
    record = json.loads(done.stdout)
    assert record["measured"]["crank_angle_from_time"] is True
    entry = record["measured"]["curves"]["slider_position"]
    linkage = Linkage(*(1e-3 * record[f"{name}_mm"] for name in ("crank", "rod", "offset")))
    assert entry["largest_mm"] == pytest.approx(300.0 - 1e3 * float(linkage.at(0.0).slider_position), rel=1e-9)
    assert (entry["samples"], entry["best_shift_mm"]) == (1, None)
    assert "none" in command("analyse", "latest", "--runs", kept, "--design", 1, "--measured", file).stdout


def test_what_friction_leaves_undetermined_is_told() -> None:
    locked = replace(fronts.MACHINE, friction=Friction(guide=1.5))
    text = "crank_angle_deg,torque_Nm\n,3\n" + "\n".join(f"{angle},1" for angle in range(0, 360, 5))
    measured = parse_measured_curves(text, locked, LINKAGE)
    numbers: Any = MEASURED.bind_to_design(locked, LINKAGE, {"measured": measured}).numbers(lambda: False)
    assert numbers["rows_without_crank_angle"] == 1
    assert numbers["curves"]["torque"]["rms_Nm"] is None
    stream = io.StringIO()
    print_blocks(Console(file=stream, width=140), topic.blocks(numbers))
    assert "undefined" in stream.getvalue()
    assert "nan" not in stream.getvalue()
    (panel,) = topic.figure(locked, LINKAGE, measured=measured).panels
    assert panel.note == "undefined where friction locks"
    draw_panel_figure(topic.figure(locked, LINKAGE, measured=measured))


def test_at_most_some_thousand_samples_are_drawn() -> None:
    angles = np.linspace(0.0, 3600.0, 40_000)
    text = "crank_angle_deg,slider_position_mm\n" + "\n".join(f"{angle},300" for angle in angles)
    measured = parse_measured_curves(text, fronts.MACHINE, LINKAGE)
    (panel,) = topic.figure(fronts.MACHINE, LINKAGE, measured=measured).panels
    assert len(panel.lines[-2].x) == 3000
    (found,) = curve_deviations(fronts.MACHINE, LINKAGE, measured.crank_angle, measured.values)
    assert panel.lines[-1].x == pytest.approx([math.degrees(found.crank_angle)], abs=1e-9)
