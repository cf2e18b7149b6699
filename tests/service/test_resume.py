"""`slidercrank optimise --resume`: a stopped run goes on in its folder and ends as if never stopped."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from slidercrank.model.errors import EngineError, InputError, MissingExtra
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import read_job
from slidercrank.optimise.search.checkpoints import Record, identity_of
from slidercrank.optimise.solve import solve
from slidercrank.service.jobs.submission import submit
from slidercrank.service.runs.result import csv_text
from slidercrank.service.runs.run_folder import MARK, RunFolder
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service import fronts
from tests.service.conftest import Command

METHOD = 'method = "nsga2"\nsamples = 16\nevaluations = 96\n'


class Killed(BaseException):
    """Stands for the end of the process."""


@pytest.fixture
def job(tmp_path: Path) -> Path:
    """Return a small job for an evolutionary method."""
    file = tmp_path / "short.toml"
    file.write_text(fronts.JOB.replace("samples = 512\n", METHOD), encoding="utf-8")
    return file


@pytest.fixture
def stop(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that ends the next search after some records: cancelled, or killed."""

    def after(count: int, *, killed: bool) -> None:
        def stopped(*given: Any, keep: Any, **options: Any) -> ParetoFront:
            seen: list[Record] = []

            def counted(record: Record) -> None:
                keep(record)
                seen.append(record)
                if killed and len(seen) == count:
                    raise Killed

            options["cancelled"] = lambda: len(seen) >= count
            return solve(*given, keep=counted, **options)

        monkeypatch.setattr("slidercrank.optimise.solve.solve", stopped)

    return after


def only_run(runs: Path) -> Path:
    (run,) = (path for path in runs.iterdir() if path.is_dir())
    return run


def count_stored_records(runs: Path, number: int = 1) -> int:
    """Return how many records of a job are in the store."""
    with Store(runs / "slidercrank.db") as store:
        return store.job(number).records


def designs(run: Path) -> str:
    return (run / "front.csv").read_text()


@pytest.fixture
def whole(job: Path, tmp_path: Path, command: Command) -> str:
    """Return the front of the job without a stop, as it is stored."""
    done = command("optimise", job, "--no-figures", "--seed", 4, "--designs", 6, "--runs", tmp_path / "whole")
    assert done.exit_code == 0, done.output
    assert count_stored_records(tmp_path / "whole") == 0
    return designs(only_run(tmp_path / "whole"))


@pytest.mark.parametrize("killed", [False, True])
def test_a_stopped_run_goes_on_and_ends_as_if_it_had_not_been(
    killed: bool, job: Path, runs: Path, whole: str, stop: Any, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop(3, killed=killed)
    arguments = ("optimise", job, "--no-figures", "--seed", 4, "--designs", 6)
    if killed:
        with pytest.raises(Killed):
            command(*arguments)
        run = only_run(runs)
        assert (run / MARK).exists()
        assert f"continue it with `slidercrank optimise --resume {run.name}`" in command("front", run.name).stderr
    else:
        stopped = command(*arguments)
        run = only_run(runs)
        assert stopped.exit_code == 130
        assert f"continue with: slidercrank optimise --resume {run.name}" in stopped.stderr
    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    assert count_stored_records(runs) == 3
    again = command("optimise", "--resume", run.name, "--json", "--no-figures")
    assert again.exit_code == 0, again.output
    assert only_run(runs) == run
    assert designs(run) == whole
    record = json.loads(again.stdout)
    assert (record["status"], record["seed"], record["run"]) == ("done", 4, str(run))
    assert {file.name for file in run.iterdir()} == {
        *("job.toml", "front.csv", "front.json", "versions.json", "log.txt")
    }
    assert " continues" in (run / "log.txt").read_text()


def contents(place: Path) -> dict[Path, bytes]:
    """Return the files of a place of runs, without those of the store."""
    return {file: file.read_bytes() for file in place.rglob("*") if file.is_file() and ".db" not in file.name}


def test_a_refused_resume_changes_nothing_in_a_run_that_is_done(job: Path, runs: Path, command: Command) -> None:
    assert command("optimise", job, "--no-figures").exit_code == 0
    run = only_run(runs)
    before = contents(runs)
    for name in (run.name, run, 1):
        refused = command("optimise", "--resume", name, "--no-figures")
        assert refused.exit_code == 2
        assert f"only an interrupted or cancelled run can continue; {run.name} is done" in refused.stderr
        assert contents(runs) == before
    assert command("front", run.name).exit_code == 0
    elsewhere = runs.parent / "elsewhere"  # where the run has no folder yet
    store = runs / "slidercrank.db"
    assert command("optimise", "--resume", 1, "--runs", elsewhere, "--store", store).exit_code == 2
    assert not elsewhere.exists()


@pytest.mark.parametrize("killed", [False, True])
@pytest.mark.parametrize("reason", ["queued", "running elsewhere", "other versions", "other job"])
def test_a_refused_resume_changes_nothing_in_a_stopped_run(
    reason: str,
    killed: bool,
    job: Path,
    runs: Path,
    stop: Any,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stop(2, killed=killed)
    if killed:
        with pytest.raises(Killed):
            command("optimise", job, "--no-figures")
    else:
        command("optimise", job, "--no-figures")
    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    run = only_run(runs)
    with Store(runs / "slidercrank.db") as store:
        if reason in ("queued", "running elsewhere"):
            store.resume(1)
        if reason == "running elsewhere":
            assert store.claim("another", lease=60.0) is not None
        stood = (store.job(1).state, store.job(1).events)
    if reason in ("other versions", "other job"):
        other = {"versions": "others"} if reason == "other versions" else {"problem": "another"}
        monkeypatch.setattr(
            "slidercrank.optimise.solve.identity_of", lambda problem: replace(identity_of(problem), **other)
        )
    before = contents(runs)
    refused = command("optimise", "--resume", run.name, "--no-figures")
    assert refused.exit_code == 2, refused.output
    assert contents(runs) == before
    with Store(runs / "slidercrank.db") as store:
        assert (store.job(1).state, store.job(1).events) == stood


def test_a_cancelled_run_can_still_be_read_after_an_error_of_the_search(
    job: Path, runs: Path, stop: Any, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop(2, killed=False)
    command("optimise", job, "--no-figures")
    run = only_run(runs)
    before = designs(run)

    def fail(*given: object, **options: object) -> None:
        raise EngineError("the cluster does not answer")

    monkeypatch.setattr("slidercrank.optimise.solve.solve", fail)
    assert command("optimise", "--resume", "latest").exit_code == 2
    assert "EngineError: the cluster does not answer" in (run / "log.txt").read_text(encoding="utf-8")
    assert designs(run) == before
    assert command("front", run.name).exit_code == 0
    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    assert command("optimise", "--resume", run.name, "--no-figures").exit_code == 0


def test_a_missing_extra_leaves_no_run(
    job: Path, runs: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*given: object, **options: object) -> None:
        raise MissingExtra("the method needs the extra")

    monkeypatch.setattr("slidercrank.optimise.solve.solve", fail)
    assert command("optimise", job).exit_code == 2
    assert [path for path in runs.iterdir() if path.is_dir()] == []


def test_what_cannot_go_on_is_refused_and_left_as_it_is(
    job: Path, runs: Path, stop: Any, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop(2, killed=False)
    command("optimise", job, "--no-figures")
    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    run = only_run(runs)
    before = designs(run)
    for arguments, words in (
        ((), "needs a job file, or a run to continue"),
        ((job, "--resume", "latest"), "got both"),
        (("--resume", "latest", "--seed", 5), "its original number of designs and seed"),
        (("--resume", "nothing"), "there is no run 'nothing'"),
    ):
        done = command("optimise", *arguments)
        assert (done.exit_code, done.stdout) == (2, "")
        assert words in done.stderr
    assert designs(run) == before
    assert not (run / MARK).exists()
    assert count_stored_records(runs) == 2
    (runs / "slidercrank.db").unlink()
    assert "is not in" in command("optimise", "--resume", "latest").stderr


@pytest.mark.skipif(os.name == "nt", reason="locks of Unix")
def test_a_run_that_still_goes_on_is_not_taken_up(tmp_path: Path) -> None:
    with (
        RunFolder(tmp_path, "x") as run,
        pytest.raises(InputError, match="only one process may use a run at a time; another one is using"),
    ):
        RunFolder.reopen(run.path)
    with RunFolder.reopen(run.path) as again:
        assert not (again.path / MARK).exists()
        again.resume()
        assert (again.path / MARK).exists()
    assert not (again.path / MARK).exists()


def test_a_run_of_the_command_line_is_a_job_of_the_store(job: Path, runs: Path, command: Command) -> None:
    done = command("optimise", job, "--no-figures", "--json", "--seed", 4, "--designs", 6)
    assert done.exit_code == 0, done.output
    run = only_run(runs)
    with Store(runs / "slidercrank.db") as store:
        (known,) = store.jobs()
        assert (known.state, known.run, known.name, known.worker) == ("done", run.name, "Short test [job]", None)
        assert (
            store.job_tables(known.id)["optimiser"] | {"seed": 4, "designs": 6}
            == store.job_tables(known.id)["optimiser"]
        )
        assert csv_text(store.result(known.id).designs) == designs(run)
        assert store.artefact(known.id, "job.toml").content == job.read_bytes()
        assert [event.data["state"] for event in store.events(known.id) if event.kind == "state"] == [
            *("queued", "running", "done")
        ]


def test_a_job_of_a_worker_is_a_run_of_the_command_line(job: Path, runs: Path, whole: str, command: Command) -> None:
    runs.mkdir()
    tables = read_job(job)
    tables = {**tables, "optimiser": {**tables["optimiser"], "seed": 4, "designs": 6}}
    with Store(runs / "slidercrank.db") as store:
        number = submit(store, tables).id
        assert "job 1 has no result: it is queued" in command("front", number).stderr
        work(store, drain=True)
        name = store.job(number).run
    assert [path for path in runs.iterdir() if path.is_dir()] == []
    shown = command("front", "latest", "--json")
    assert shown.exit_code == 0, shown.output
    assert json.loads(shown.stdout)["run"] == str(runs / name)
    assert designs(only_run(runs)) == whole
    assert only_run(runs).name == name
    again = command("front", number, "--json")
    assert again.stdout == shown.stdout


def test_a_cancelled_job_of_a_worker_goes_on_at_the_command_line(
    job: Path, runs: Path, whole: str, stop: Any, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs.mkdir()
    tables = read_job(job)
    tables = {**tables, "optimiser": {**tables["optimiser"], "seed": 4, "designs": 6}}
    stop(3, killed=False)
    with Store(runs / "slidercrank.db") as store:
        number = submit(store, tables).id
        work(store, drain=True)
        assert (store.job(number).state, store.job(number).records) == ("cancelled", 3)
    monkeypatch.setattr("slidercrank.optimise.solve.solve", solve)
    again = command("optimise", "--resume", number, "--no-figures")
    assert again.exit_code == 0, again.output
    assert designs(only_run(runs)) == whole


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_a_command_that_was_killed_can_be_resumed_at_once(job: Path, runs: Path, whole: str, command: Command) -> None:
    script = (
        "import os, sys\n"
        "from slidercrank.service import cli\n"
        "from slidercrank.service.store import Claim\n"
        "report, told = Claim.report, []\n"
        "def die(self, at):\n"
        "    report(self, at)\n"
        "    told.append(at)\n"
        "    if len(told) == 3: os.kill(os.getpid(), 9)\n"
        "Claim.report = die\n"
        "cli.main()\n"
    )
    arguments = ["optimise", str(job), "--no-figures", "--seed", "4", "--designs", "6"]
    killed = subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, check=False)
    assert killed.returncode == -9, killed.stderr
    run = only_run(runs)
    assert (run / MARK).exists()
    assert count_stored_records(runs) == 3
    again = command("optimise", "--resume", "latest", "--no-figures")
    assert again.exit_code == 0, again.output
    assert designs(run) == whole
