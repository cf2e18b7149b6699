"""`slidercrank optimise`: from a job to a front on the screen and a run on the disk."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import pytest

from slidercrank.service.commands.optimise import Places
from slidercrank.service.runs.runs_on_disk import read_run
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.test_result import DESIGN_KEYS, KEYS


@pytest.fixture
def job(tmp_path: Path) -> Path:
    """Return a small job."""
    return fronts.job_file(tmp_path)


def only_run(runs: Path) -> Path:
    """Return the only run of a place."""
    (run,) = (path for path in runs.iterdir() if path.is_dir())
    return run


@pytest.mark.slow
def test_a_job_gives_a_front_and_a_run(job: Path, runs: Path, command: Command) -> None:
    done = command("optimise", job)
    assert done.exit_code == 0, done.stderr
    run = only_run(runs)
    assert run.name.endswith("-short-test-job")
    assert {file.name for file in run.iterdir()} == {
        *("job.toml", "front.csv", "front.json", "figures", "versions.json", "log.txt")
    }
    assert (run / "job.toml").read_bytes() == job.read_bytes()
    versions = json.loads((run / "versions.json").read_text())
    assert {"slidercrank", "python", "numpy", "numba", "matplotlib"} <= set(versions)
    assert "Short test [job]: " in done.stdout
    assert f"Files: {run}" in done.stdout
    assert "In every design: stroke 280 mm." in done.stdout
    assert {file.stem for file in (run / "figures").iterdir()} == {
        *("scatter_matrix", "parallel_coordinates", "best_time_ratio", "best_transmission_angle", "knee")
    }


def test_json_is_the_only_output_and_the_same_as_the_file(job: Path, runs: Path, command: Command) -> None:
    done = command("optimise", job, "--json", "--no-figures", "--designs", 5, "--seed", 3)
    assert done.exit_code == 0, done.stderr
    record = json.loads(done.stdout)
    assert set(KEYS) <= set(record)
    assert set(DESIGN_KEYS) <= set(record["designs"][0])
    assert (record["status"], record["seed"], record["run"]) == ("done", 3, str(only_run(runs)))
    assert len(record["designs"]) <= 5
    assert json.loads((only_run(runs) / "front.json").read_text()) == record
    assert not (only_run(runs) / "figures").exists()
    with (only_run(runs) / "front.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["crank_mm"]) for row in rows] == [design["crank_mm"] for design in record["designs"]]
    assert list(rows[0]) == list(record["designs"][0])


def test_the_same_job_and_seed_give_the_same_front(job: Path, runs: Path, command: Command) -> None:
    texts = set()
    for _ in range(2):
        run = json.loads(command("optimise", job, "--json", "--no-figures").stdout)["run"]
        texts.add((Path(run) / "front.csv").read_text())
    assert len(texts) == 1


def test_runs_go_where_the_option_says(job: Path, runs: Path, tmp_path: Path, command: Command) -> None:
    assert command("optimise", job, "--no-figures", "--runs", tmp_path / "mine").exit_code == 0
    assert read_run(only_run(tmp_path / "mine")).status == "done"
    assert not runs.exists()


def test_one_objective_gives_one_design_with_all_its_numbers(
    job: Path, runs: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    fronts.replace_solve(monkeypatch, fronts.front(("peak_torque",), designs=1))
    done = command("optimise", job)
    assert done.exit_code == 0, done.stderr
    assert "peak guide force" in done.stdout
    assert [file.name for file in (only_run(runs) / "figures").iterdir()] == ["best_peak_torque.png"]


def test_nothing_feasible_is_exit_code_3_and_keeps_the_message(
    job: Path, runs: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    message = "time ratio 1.5 caps the least transmission angle at 27.46 deg; 40 deg is asked"
    fronts.replace_solve(monkeypatch, fronts.empty_front("infeasible", message))
    done = command("optimise", job, "--json")
    assert done.exit_code == 3
    record = json.loads(done.stdout)
    assert (record["status"], record["message"], record["designs"]) == ("infeasible", message, [])
    assert message in done.stderr
    assert not (only_run(runs) / "figures").exists()
    shown = command("front", "latest")
    assert (shown.exit_code, shown.stdout) == (3, "")
    assert message in shown.stderr
    assert message in command("optimise", job).stdout


def test_a_contradiction_in_a_job_is_found_by_the_search(job: Path, runs: Path, command: Command) -> None:
    job.write_text(job.read_text().replace("[objectives]", "time_ratio = { min = 1.6 }\n[objectives]"))
    done = command("optimise", job)
    assert done.exit_code in (2, 3), done.output
    assert "time ratio" in done.output or "transmission angle" in done.output


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('speed = "300 rpm"', 'speed = "300 mm"', "speed"),
        ('"20 mm", "200 mm"', '"200 mm", "20 mm"', "crank"),
        ("[objectives]", "[objektives]", "objektives"),
        ('mass = "2 kg"', 'mass = "-2 kg"', "mass"),
    ],
)
def test_wrong_input_is_one_message_exit_code_2_and_no_run(
    before: str, after: str, words: str, job: Path, runs: Path, command: Command
) -> None:
    job.write_text(job.read_text().replace(before, after))
    done = command("optimise", job)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert done.stderr.startswith(f"slidercrank: {job}")
    assert "Traceback" not in done.stderr
    assert not runs.exists()


@pytest.mark.parametrize(
    "content",
    [b"", b"\x7fELF\x02\x01\x00", b"\xff\xfe[\x00", b"[mechanism", b"name = 1\n", b"# \n" * 700_000, None],
    ids=["empty", "binary", "UTF-16", "cut", "wrong type", "2 MB", "folder"],
)
def test_a_file_that_is_no_job_is_one_message_exit_code_2_and_no_run(
    content: bytes | None, tmp_path: Path, runs: Path, command: Command
) -> None:
    job = tmp_path / "job.toml"
    if content is None:
        job.mkdir()
    else:
        job.write_bytes(content)
    done = command("optimise", job, "--json")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith(f"slidercrank: {job}: ")
    assert "Traceback" not in done.stderr
    assert not runs.exists()


@pytest.mark.parametrize("arguments", [("--designs", "0"), ("--designs", "many"), ("--seed", "-1"), ("--sead", "1")])
def test_a_wrong_option_is_exit_code_2_and_no_run(
    arguments: tuple[str, str], job: Path, runs: Path, command: Command
) -> None:
    done = command("optimise", job, *arguments)
    assert done.exit_code == 2
    assert arguments[0] in done.stderr
    assert not runs.exists()


def test_a_place_that_cannot_be_written_is_said_before_anything_is_computed(
    job: Path, tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slidercrank.optimise.solve.solve", None)
    (tmp_path / "file").write_text("")
    done = command("optimise", job, "--runs", tmp_path / "file" / "runs")
    assert done.exit_code == 2
    assert "must be a writable folder" in done.stderr


def test_a_fault_is_one_message_with_the_place_of_the_log(
    job: Path, runs: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ArithmeticError("kernel lost")

    monkeypatch.setattr("slidercrank.optimise.solve.solve", broken)
    done = command("optimise", job, "--json")
    assert (done.exit_code, done.stdout) == (1, "")
    log = only_run(runs) / "log.txt"
    assert f"see {log}" in done.stderr
    assert "kernel lost" in done.stderr
    assert "Traceback" not in done.stderr
    assert "Traceback" in log.read_text()
    shown = command("front", "latest")
    assert shown.exit_code == 2
    assert "is unfinished" in shown.stderr


def test_a_fault_without_a_run_has_a_log_too(job: Path, command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_: object) -> None:
        raise ArithmeticError("parser lost")

    monkeypatch.setattr("slidercrank.optimise.job.load_job", broken)
    done = command("check", job)
    assert done.exit_code == 1
    log = Path(done.stderr.rsplit("see ", 1)[1].strip())
    assert "ArithmeticError: parser lost" in log.read_text()
    log.unlink()


def test_the_table_marks_the_extremes_and_the_knee(
    job: Path, runs: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    front = fronts.front(designs=60)
    fronts.replace_solve(monkeypatch, front)
    lines = command("optimise", job, "--no-figures").stdout.splitlines()
    at = lines.index("At the knee:")
    table = [line for line in lines[:at] if line.split() and line.split()[0].isdigit() and " of " not in line]
    rows = {int(line.split()[0]): line for line in table}
    assert 12 <= len(rows) <= 18
    assert set(front.extremes().values()) | {front.knee()} <= {number - 1 for number in rows}
    assert sum(line.count("*") for line in rows.values()) == len(front.objectives)
    assert [number - 1 for number, line in rows.items() if "knee" in line] == [front.knee()]
    assert max(map(len, table)) <= 80
    header = " ".join(lines[2:8])
    assert all(word in header for word in ("crank", "mm", "peak", "torque", "N m", "deg"))
    assert len(lines[at + 1 : lines.index("", at)]) == len(front.trade_offs(front.knee()))


def test_a_store_that_cannot_be_used_does_not_keep_a_job_from_running(
    job: Path, runs: Path, command: Command, tmp_path: Path
) -> None:
    foreign = tmp_path / "foreign.db"
    foreign.write_bytes(b"no database" * 1000)
    for store in (foreign, "postgresql://clerk:geheim@127.0.0.1:1/jobs"):
        done = command("optimise", job, "--no-figures", "--designs", 3, "--store", store)
        assert done.exit_code == 0, done.stderr
        assert "without a store, `jobs` does not list this run" in done.stderr
        (run,) = (path for path in runs.iterdir() if path.is_dir())
        assert (run / "front.csv").exists()
        assert "geheim" not in (run / "log.txt").read_text() + done.stderr
        assert run.stat().st_mode & 0o777 == 0o700
        shutil.rmtree(run)
    assert foreign.read_bytes() == b"no database" * 1000
    assert command("optimise", job, "--store", "mysql://clerk@host/x").exit_code == 2


def test_the_command_that_goes_on_names_the_places_that_were_named() -> None:
    assert Places().resume_command("a-run") == "slidercrank optimise --resume a-run"
    named = Places(Path("my runs"), "my store.db").resume_command("a-run")
    assert named == "slidercrank optimise --resume a-run --runs 'my runs' --store 'my store.db'"
    secret = Places(store="postgresql://clerk:geheim@host/jobs?sslmode=require&sslpassword=auch").resume_command(
        "a-run"
    )
    assert "geheim" not in secret
    assert "auch" not in secret
    assert "--store 'postgresql://clerk:***@host/jobs?" in secret
