"""`slidercrank front` and `slidercrank export`."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from slidercrank.optimise.front.choose_design import Priority
from slidercrank.service.designs.selection import numbered_rows
from slidercrank.service.runs.result import Result, json_ready, result_of, rows_from_csv
from slidercrank.service.runs.run_folder import RunFolder
from tests.service import fronts
from tests.service.conftest import Command


@pytest.fixture
def stored(runs: Path) -> Result:
    """Return a run that is kept."""
    with RunFolder(runs, "Sieve") as run:
        result = result_of(fronts.front(designs=30), str(run.path))
        run.keep_result(result, {})
    return result


def numbers(output: str) -> list[int]:
    """Return the numbers of the designs in a table."""
    lines = [line.split() for line in output.splitlines() if " of " not in line]
    return [int(words[0]) for words in lines if words and words[0].isdigit()]


def test_front_shows_the_run_again(stored: Result, command: Command) -> None:
    done = command("front", "latest")
    assert done.exit_code == 0
    assert stored.message in done.stdout
    assert "At the knee:" in done.stdout
    assert done.stderr == ""


def test_front_json_is_the_file(stored: Result, command: Command) -> None:
    assert json.loads(command("front", "latest", "--json").stdout) == stored.record()


def test_front_shows_the_designs_that_meet_conditions(stored: Result, command: Command) -> None:
    limits = sorted(row["least_transmission_angle_deg"] for row in stored.designs)  # type: ignore[type-var]
    done = command("front", "latest", "--where", f"transmission_angle >= {limits[10]} deg", "--rows", 0)
    assert done.exit_code == 0
    expected = [
        number
        for number, row in enumerate(stored.designs, 1)
        if row["least_transmission_angle_deg"] >= limits[10]  # type: ignore[operator]
    ]
    assert numbers(done.stdout) == expected
    assert f"{len(expected)} of {len(stored.designs)} designs" in done.stdout


def test_conditions_add_up_and_json_has_only_their_designs(stored: Result, command: Command) -> None:
    torque = sorted(row["peak_torque_Nm"] for row in stored.designs)[15]  # type: ignore[type-var]
    done = command(
        *("front", "latest", "--json", "--where", f"peak_torque <= {torque} N m", "--where", "slow_stroke = inward"),
        *("--columns", "crank,peak_torque"),
    )
    record = json.loads(done.stdout)
    assert all(list(row) == ["crank_mm", "peak_torque_Nm"] for row in record["designs"])
    assert len(record["designs"]) == 16
    for name, row in record["extremes"].items():
        column = next(wanted["column"] for wanted in record["objectives"] if wanted["quantity"] == name)
        best = stored.designs[stored.extremes[name]]
        assert record["designs"][row]["crank_mm"] == best["crank_mm"], column


def test_no_design_that_meets_the_conditions_is_exit_code_3(stored: Result, command: Command) -> None:
    done = command("front", "latest", "--where", "peak_torque < 1 N m", "--json")
    assert done.exit_code == 3
    assert json.loads(done.stdout)["designs"] == []
    assert f"none of the {len(stored.designs)} designs meets peak_torque < 1 N m" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "key", "turned"),
    [
        (("--sort", "peak_torque"), "peak_torque_Nm", False),
        (("--sort", "transmission_angle"), "least_transmission_angle_deg", True),
        (("--sort", "crank"), "crank_mm", False),
        (("--sort", "rod_mm", "--reverse"), "rod_mm", True),
    ],
)
def test_designs_are_sorted_best_or_smallest_first(
    arguments: tuple[str, ...], key: str, turned: bool, stored: Result, command: Command
) -> None:
    shown = numbers(command("front", "latest", *arguments, "--rows", 0).stdout)
    values = [stored.designs[number - 1][key] for number in shown]
    assert len(values) == len(stored.designs)
    assert values == sorted(values, reverse=turned)  # type: ignore[type-var]


def test_columns_are_those_asked_for(stored: Result, command: Command) -> None:
    output = command("front", "latest", "--columns", "rod, peak_guide_force_N,status", "--rows", 3).stdout
    assert "guide" in output
    assert "stationary" in output
    assert "crank" not in output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--where", "transmission_angle"), "a condition must have"),
        (("--where", "transmission_angle >= 40"), "with its unit"),
        (("--sort", "torque_peak"), "there is no quantity or column 'torque_peak'"),
        (("--columns", "crank,nothing"), "there is no quantity or column 'nothing'"),
        (("--columns", ","), "there is no quantity or column ''"),
        (("--rows", "-1"), "--rows"),
    ],
)
def test_wrong_arguments_are_exit_code_2(
    arguments: tuple[str, ...], words: str, stored: Result, command: Command
) -> None:
    done = command("front", "latest", *arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr


def test_an_unknown_run_is_exit_code_2(stored: Result, command: Command) -> None:
    done = command("front", "1999")
    assert done.exit_code == 2
    assert "there is no run '1999'" in done.stderr


def test_a_damaged_run_is_exit_code_2(stored: Result, command: Command) -> None:
    (Path(stored.run) / "front.csv").write_text("crank_mm\n1\n")
    done = command("front", stored.run)
    assert done.exit_code == 2
    assert "is damaged" in done.stderr


def test_export_writes_the_files_of_the_run(stored: Result, tmp_path: Path, command: Command) -> None:
    done = command("export", "latest", "--csv", tmp_path / "a.csv", "--json", tmp_path / "a.json")
    assert (done.exit_code, done.stdout) == (0, "")
    assert json_ready(rows_from_csv((tmp_path / "a.csv").read_text())) == json_ready(numbered_rows(stored.designs))
    assert (tmp_path / "a.json").read_bytes() == (Path(stored.run) / "front.json").read_bytes()


def test_export_writes_to_standard_output(stored: Result, command: Command) -> None:
    assert json_ready(rows_from_csv(command("export", "latest", "--csv", "-").stdout)) == json_ready(
        numbered_rows(stored.designs)
    )
    assert json.loads(command("export", "latest", "--json", "-").stdout) == stored.record()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "nothing to export; give --csv FILE"),
        (("--csv", "-", "--json", "-"), "only one of"),
        (
            ("--csv", "none/there/a.csv"),
            "No such file or directory; create the folder, or choose another folder",
        ),
    ],
)
def test_an_export_to_nowhere_is_refused(
    arguments: tuple[str, ...], words: str, stored: Result, command: Command
) -> None:
    done = command("export", "latest", *arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr


def test_front_chooses_one_design(stored: Result, command: Command) -> None:
    front = fronts.front(designs=30)
    chosen = {
        ("--knee",): front.knee(),
        ("--topsis", "peak_torque=2, transmission_angle=1"): front.topsis(
            {"peak_torque": 2.0, "transmission_angle": 1.0}
        ),
        ("--lexicographic", "peak_torque: 20 %, transmission_angle"): front.lexicographic(
            Priority(quantity="peak_torque", share=0.2), "transmission_angle"
        ),
        ("--lexicographic", "transmission_angle: 2 deg, time_ratio: 0.01, peak_torque"): front.lexicographic(
            Priority(quantity="transmission_angle", absolute=math.radians(2.0)),
            Priority(quantity="time_ratio", absolute=0.01),
            "peak_torque",
        ),
    }
    assert len(set(chosen.values())) >= 3
    for arguments, row in chosen.items():
        record = json.loads(command("front", "latest", *arguments, "--json").stdout)
        assert record["designs"] == [stored.record()["designs"][row]]
        assert record["number"] == row + 1
        shown = command("front", "latest", *arguments).stdout
        assert f"design {row + 1} of {len(stored.designs)}" in shown
        assert f"{stored.designs[row]['peak_torque_Nm']:.6g}" in shown


def test_a_design_is_chosen_among_those_that_meet_the_conditions(stored: Result, command: Command) -> None:
    free = json.loads(command("front", "latest", "--json", "--topsis", "peak_torque=1").stdout)["designs"][0]
    limit = float(free["least_transmission_angle_deg"]) + 0.5
    done = command(
        *("front", "latest", "--json", "--topsis", "peak_torque=1"),
        *("--where", f"transmission_angle >= {limit} deg"),
    )
    allowed = [row for row in stored.designs if row["least_transmission_angle_deg"] >= limit]  # type: ignore[operator]
    assert json.loads(done.stdout)["designs"][0]["peak_torque_Nm"] == min(row["peak_torque_Nm"] for row in allowed)  # type: ignore[type-var]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--knee", "--topsis", "peak_torque=1"), "got knee and topsis; keep one"),
        (("--topsis", "stroke=1"), "time_ratio, peak_torque, transmission_angle, position_error; got 'stroke'"),
        (("--topsis", "peak_torque"), "must be OBJECTIVE=NUMBER,"),
        (("--topsis", "peak_torque=1, peak_torque=2"), "each objective once"),
        (("--topsis", "peak_torque=0"), "at least one above zero"),
        (("--topsis", ""), "separated by single commas"),
        (("--lexicographic", "peak_torque:2"), "a torque with its unit, or a percentage of the range; got 2"),
        (("--lexicographic", "peak_torque:2 mm"), "the tolerance in 'peak_torque:2 mm'"),
        (("--lexicographic", "peak_torque:-5 %"), "the tolerance in 'peak_torque:-5 %'"),
        (("--lexicographic", "peak_torque, peak_torque"), "each once"),
    ],
)
def test_a_wrong_choice_is_exit_code_2(
    arguments: tuple[str, ...], message: str, stored: Result, command: Command
) -> None:
    done = command("front", "latest", *arguments)
    assert done.exit_code == 2
    assert message in done.stderr


def test_an_export_takes_part_of_the_front_in_an_order(stored: Result, tmp_path: Path, command: Command) -> None:
    torque = sorted(row["peak_torque_Nm"] for row in stored.designs)[15]  # type: ignore[type-var]
    files = ("--csv", tmp_path / "a.csv", "--json", tmp_path / "a.json")
    options = ("--where", f"peak_torque <= {torque} N m", "--sort", "crank", "--reverse")
    done = command("export", "latest", *files, *options)
    assert (done.exit_code, done.stdout) == (0, ""), done.stderr
    expected = [row for row in numbered_rows(stored.designs) if row["peak_torque_Nm"] <= torque]  # type: ignore[operator]
    expected.sort(key=lambda row: row["crank_mm"], reverse=True)  # type: ignore[arg-type, return-value]
    assert 0 < len(expected) < len(stored.designs)
    assert json_ready(rows_from_csv((tmp_path / "a.csv").read_text())) == json_ready(expected)
    written = json.loads((tmp_path / "a.json").read_text())
    assert written["numbers"] == [row["number"] for row in expected]
    assert [row["crank_mm"] for row in written["designs"]] == [row["crank_mm"] for row in expected]


def test_an_export_of_no_design_is_exit_code_3_and_writes_nothing(
    stored: Result, tmp_path: Path, command: Command
) -> None:
    done = command("export", "latest", "--csv", tmp_path / "a.csv", "--where", "peak_torque < 0 N m")
    assert (done.exit_code, done.stdout) == (3, "")
    assert f"none of the {len(stored.designs)} designs meets" in done.stderr
    assert not (tmp_path / "a.csv").exists()


def test_front_shows_the_design_of_a_number(stored: Result, command: Command) -> None:
    record = json.loads(command("front", "latest", "--design", 4, "--json").stdout)
    assert (record["number"], record["designs"]) == (4, [json_ready(stored.designs[3])])
    assert "design 4 of 30" in command("front", "latest", "--design", 4).stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--design", 31), "the run has designs 1 to 30; got 31"),
        (("--design", 0), "the run has designs 1 to 30; got 0"),
        (("--design", 1, "--knee"), "a design must be chosen in one way"),
        (("--design", 1, "--where", "stroke > 1 mm"), "a design must be chosen in one way"),
    ],
)
def test_a_wrong_number_of_a_design_is_refused(
    arguments: tuple[object, ...], words: str, stored: Result, command: Command
) -> None:
    done = command("front", "latest", *arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
