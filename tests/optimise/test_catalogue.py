"""Catalogues as tables: the front of all rows from few of them, and wrong files in a sentence."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import load_job, needed_files, parse_job, read_job
from slidercrank.optimise.job.catalogue import MOST_OPTIONS, read_catalogue
from slidercrank.optimise.job.job_notes import job_notes
from slidercrank.optimise.job.linear_contradictions import impossible_option_notes
from slidercrank.optimise.solve import solve
from tests.optimise.catalogues import distance

JOB = """
name = "geared"
[mechanism]
speed = "240 rpm"
slider = { mass = "2 kg" }
[[load]]
force = "150 N"
opposes = "motion"
[variables]
crank = { choices = ["40 mm", "50 mm", "60 mm"] }
rod = "150 mm"
offset = "20 mm"
[[choice]]
name = "gearmotor"
file = "gearmotors.csv"
[objectives]
peak_torque = "minimise"
stroke = "maximise"
"""
HEADER = "name,peak_torque max (N m),rms_torque max (N m),# price (EUR)"


def catalogue(seed: int, rows: int, *, masses: bool = False) -> str:
    """Return a catalogue of random limits, some equal; with masses, of a number that comes with a row too."""
    random = np.random.default_rng([16, seed])
    lines = [HEADER + (",mechanism.slider.mass (kg)" if masses else "")]
    for row in range(rows):
        torque = float(np.round(random.uniform(4.0, 14.0), 1))
        more = f",{random.choice([1.5, 2.0])}" if masses else ""
        lines.append(f"M {row},{torque},{torque * random.choice([0.5, 0.6]):.2f},{random.integers(10, 99)}{more}")
    return "\n".join(lines) + "\n"


def written(folder: Path, text: str) -> Path:
    (folder / "gearmotors.csv").write_text(text)
    (folder / "job.toml").write_text(JOB)
    return folder / "job.toml"


@pytest.mark.parametrize("masses", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_the_front_is_that_of_solving_every_row(seed: int, masses: bool, tmp_path: Path) -> None:
    text = catalogue(seed, 60, masses=masses)
    front = solve(load_job(written(tmp_path, text)))
    rows = [line.split(",") for line in text.splitlines()[1:]]
    every = [
        {
            "name": row[0],
            "constraints": {"peak_torque": {"max": f"{row[1]} N m"}, "rms_torque": {"max": f"{row[2]} N m"}},
        }
        | ({"values": {"mechanism.slider.mass": f"{row[4]} kg"}} if masses else {})
        for row in rows
    ]
    tables: dict[str, Any] = read_job(tmp_path / "job.toml")
    tables["choice"] = [{"name": "gearmotor", "option": every}]
    expected = solve(parse_job(tables))
    assert len(front)
    assert len(front) == len(expected)
    assert distance(front.values, expected.values) <= 1e-9


def test_no_row_that_is_left_is_beaten_and_every_other_one_is() -> None:
    text = catalogue(7, 5000, masses=True)
    found = read_catalogue(text, "file")
    assert found.rows == 5000
    options = [option for option in found.options if option.get("searched", True)]
    table = {line.split(",")[0]: [float(x) for x in line.split(",")[1:]] for line in text.splitlines()[1:]}
    left = [table[option["name"]] for option in options]

    def beats(one: list[float], other: list[float]) -> bool:
        return one[3] == other[3] and one[0] >= other[0] and one[1] >= other[1]

    for row in table.values():
        assert any(beats(one, row) for one in left)
    assert not any(beats(one, other) for one in left for other in left if one is not other)
    assert len(left) <= 20


def searched(text: str, tables: dict[str, Any] | None = None) -> list[str]:
    """Return the rows that are searched, the least first."""
    found = read_catalogue(text, "file", tables=tables)
    return [option["name"] for option in found.options if option.get("searched", True)]


def test_least_values_are_looser_the_smaller_and_floors_are_not_compared() -> None:
    assert searched("name,stroke min (mm)\na,90\nb,80\nc,80\n") == ["b"]
    # A greatest transmission angle moves the floor that is kept by default.
    assert searched("name,transmission_angle max (deg)\na,8\nb,50\n") == ["a", "b"]
    assert searched("name,stroke equals (mm)\na,80\nb,90\nc,90\n") == ["a", "b"]


@pytest.mark.parametrize("sign", [";", "\t"])
def test_other_signs_between_cells_and_brackets_are_read(sign: str) -> None:
    text = "\n".join(line.replace(",", sign) for line in catalogue(1, 9).splitlines())
    assert read_catalogue(text.replace("(N m)", "[N m]"), "file") == read_catalogue(catalogue(1, 9), "file")


def test_a_job_says_how_many_rows_are_solved_and_names_the_file(tmp_path: Path) -> None:
    job = written(tmp_path, catalogue(0, 60))
    (note,) = [note for note in job_notes(read_job(job)) if "rows" in note]
    assert re.fullmatch(r"gearmotor: of 60 rows \d (is|are) searched; the others lose in peak_torque max .*", note)
    assert needed_files(job) == [tmp_path / "gearmotors.csv"]
    one = load_job(written(tmp_path, f"{HEADER}\nA,10,5,1\n"))
    assert [variant.labels for variant in one.variants] == [("A",)] * 3


def test_a_file_has_no_place_in_tables_of_a_request() -> None:
    tables = {"name": "motor", "file": "gearmotors.csv"}
    with pytest.raises(JobError, match="a file must be in the folder of the job file"):
        parse_job({"name": "x", "mechanism": {"speed": "1 rpm"}, "choice": [tables]})
    with pytest.raises(JobError, match="must have two options or more, or a file; got 0"):
        parse_job({"name": "x", "mechanism": {"speed": "1 rpm"}, "choice": [{"name": "motor"}]})


ROW = "A,10,5,1"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "must begin with a line of column names; got an empty file; fill it"),
        (HEADER, "must have rows below the column names; got none; add them"),
        (
            "name,mechanism.slider.mass (kg)\nA,1\nB,",
            'row 3, column "mechanism.slider.mass (kg)": must be a number; got an empty cell',
        ),
        (f"{HEADER}\n{ROW}\nB,=2*B2,5,1", 'must be a number; got the formula "=2*B2"; save values instead of formulas'),
        (f"{HEADER}\n=A1,10,5,1", "row 2, column name: must be a name"),
        (
            f'{HEADER}\nA,"10,500",5,1',
            "must have an unambiguous decimal sign; got 10,500, which may mean a thousand times as much",
        ),
        (f"{HEADER}\nA,10 N m,5,1", "write 10, as the unit belongs in the heading"),
        (f"{HEADER}\nA,nan,5,1", 'got "nan"'),
        (f"{HEADER}\nA,1e999,5,1", 'got "1e999"'),
        (f"{HEADER}\n{ROW}\n\nA,11,5,1", 'row 4, column name: names must differ; got "A" of row 2 again; rename one'),
        (f"{HEADER}\nA,10,5", "row 2 must have 4 cells, like the first line; got 3"),
        (
            "name,peak_torque max (kg)\nA,1",
            'column "peak_torque max (kg)": must have a unit of a torque; got "kg"; write it like (N m)',
        ),
        ("name,peak_torque max\nA,1", 'the heading has no unit; write, for example, "peak_torque max (N m)"'),
        ("name,time_ratio max (mm)\nA,1", 'got "mm"; leave it out'),
        ("name,stroke (mm)\nA,1", "a quantity needs min, max or equals"),
        ("name,peak_torqe max (N m)\nA,1", 'is called "peak_torqe"; did you mean peak_torque or'),
        ("name,stroke max (mm),stroke max (m)\nA,1,1", "columns must differ"),
        ("name,(mm)\nA,1", "must be a quantity or formula with min, max or equals, or the path of a number"),
        ("name,# price\nA,1", "must have a column beside the name"),
        ("motor,stroke max (mm)\nA,1", 'the first column must be headed "name"; got "motor"; rename or move'),
        ('name,stroke max (mm)\n"A,1', "must be a table in CSV; got unexpected end of data in row 2"),
        ("name,stroke max (mm)\nA\0,1", "must be a CSV text file; got a spreadsheet or other binary file"),
        (
            "name,mechanism.slider.mas (kg)\nA,1",
            'column "mechanism.slider.mas (kg)": must name a number that the job gives; got mechanism.slider.mas; did ',
        ),
        ("name,sections.pins.crank_pin (mm)\nA,1", "got sections.pins.crank_pin; give it in [sections] first"),
        (f"{HEADER}\n=A1,10,5,1", "1 to 60 characters on one line that does not begin with =, + or @"),
    ],
)
def test_what_is_wrong_with_a_file_is_told_with_row_column_and_remedy(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(JobError, match=re.escape(words)) as told:
        load_job(written(tmp_path, text))
    assert 'choice #1.file: "gearmotors.csv"' in str(told.value)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "name,mechanism.slider.mass (kg)\nA,1\nB,-1",
            'choice "gearmotor", option "B": mechanism.slider.mass: must be zero or more; got "-1 kg"',
        ),
        ("name,crank (mm)\nA,30\nB,-20", 'choice "gearmotor", option "B": crank must be positive; got "-20 mm"'),
        (
            "name,crank max (mm),crank min (mm)\nA,20,30",
            'choice "gearmotor", option "A": crank: min must not exceed max; got min "30 mm" and max "20 mm"',
        ),
        (
            "name,stroke max (mm)\nA,70",
            "choice: at least one option must meet [constraints]; none does: A has stroke equals 80 mm and max "
            "70 mm, which exclude each other; relax",
        ),
    ],
)
def test_what_a_job_refuses_of_a_row_is_told_with_its_name(text: str, words: str, tmp_path: Path) -> None:
    job = written(tmp_path, text)
    ranges = JOB.replace('{ choices = ["40 mm", "50 mm", "60 mm"] }', '["30 mm", "60 mm"]')
    job.write_text(ranges + '[constraints]\nstroke = { equals = "80 mm" }\n')
    with pytest.raises(JobError, match=re.escape(words)):
        load_job(job)


def test_rows_that_the_constraints_exclude_are_left_out_and_told(tmp_path: Path) -> None:
    rows = ["short,70,20", "long,85,45", "longer,95,50"]
    fronts = []
    for some in (rows, rows[1:]):
        job = written(tmp_path, "\n".join(["name,stroke max (mm),transmission_angle min (deg)", *some]))
        ranges = JOB.replace('{ choices = ["40 mm", "50 mm", "60 mm"] }', '["30 mm", "60 mm"]')
        ranges = ranges.replace('stroke = "maximise"', 'time_ratio = "maximise"').replace(
            '"20 mm"', '["0 mm", "60 mm"]'
        )
        job.write_text(
            ranges + '[constraints]\nstroke = { equals = "80 mm" }\n[optimiser]\ndesigns = 5\nsamples = 256\n'
        )
        fronts.append(solve(load_job(job)))
    told, none = (impossible_option_notes(front.problem) for front in fronts)
    assert told[0].endswith("short: stroke equals 80 mm and max 70 mm, which exclude each other")
    assert none == []
    np.testing.assert_array_equal(fronts[0].values, fronts[1].values)
    assert set(fronts[0].columns["choice_gearmotor"]) <= {"long", "longer"}


def test_files_that_cannot_be_are_refused(tmp_path: Path) -> None:
    job = written(tmp_path, "")
    with (tmp_path / "gearmotors.csv").open("wb") as file:
        file.truncate(50_000_000)
    with pytest.raises(JobError, match="must be at most 10 MB in size; got more; keep only the rows"):
        load_job(job)
    (tmp_path / "gearmotors.csv").unlink()
    with pytest.raises(JobError, match="not found; check the name and the folder"):
        load_job(job)
    for elsewhere in ("/etc/passwd", "../gearmotors.csv"):
        job.write_text(JOB.replace("gearmotors.csv", elsewhere))
        with pytest.raises(JobError, match="must be in the folder of the job file"):
            load_job(job)
    many = "\n".join(f"M {k},{k + 1},{1000 - k}" for k in range(MOST_OPTIONS + 1))
    with pytest.raises(JobError, match="at most 200 non-dominated rows; got 201 of 201"):
        read_catalogue(f"name,peak_torque max (N m),rms_torque max (N m)\n{many}\n", "file")
