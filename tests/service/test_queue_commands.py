"""The commands of the queue: submit, jobs, watch, cancel, resume, delete. All searches are made up."""

from __future__ import annotations

import json
import re
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from slidercrank.optimise.front.progress import Progress
from slidercrank.service.commands.submit import events_until_end
from slidercrank.service.store import Limits, Store
from slidercrank.service.workers.worker import work
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.store.contents import result


@pytest.fixture
def job(tmp_path: Path) -> Path:
    """Return a job file."""
    return fronts.job_file(tmp_path)


@pytest.fixture
def store(runs: Path) -> Iterator[Store]:
    """Return the store that the commands use."""
    runs.mkdir()
    with Store(runs / "slidercrank.db") as opened:
        yield opened


def solve_waiting_jobs(store: Store, monkeypatch: pytest.MonkeyPatch, status: str = "done") -> None:
    """Let a worker solve what waits, with a made-up search."""
    front = fronts.front(designs=4) if status == "done" else fronts.empty_front(status, "none")
    fronts.replace_solve(monkeypatch, front)
    work(store, drain=True)


def test_a_job_is_queued_as_it_is_given(store: Store, job: Path, command: Command) -> None:
    options = ("--priority", 3, "--key", "one", "--attempts", 5, "--seconds", 60, "--evaluations", 999)
    done = command("submit", job, *options, "--memory", "2 GB")
    assert (done.exit_code, done.stdout) == (0, "job 1: Short test [job], queued\n")
    queued = store.job(1)
    assert (queued.priority, queued.key, queued.most_attempts) == (3, "one", 5)
    assert queued.limits == Limits(seconds=60.0, evaluations=999, memory=2 * 10**9)
    kept = store.artefact(1, "job.toml")
    assert (kept.media_type, kept.content) == ("application/toml", job.read_bytes())


def test_submitting_again_with_a_key_gives_the_same_job(store: Store, job: Path, command: Command) -> None:
    first = json.loads(command("submit", job, "--key", "one", "--json").stdout)
    again = json.loads(command("submit", job, "--key", "one", "--json").stdout)
    assert first == again == store.job(1).record()
    assert len(store.jobs()) == 1


def test_a_job_that_needs_a_file_beside_it_is_kept_whole(
    store: Store, job: Path, tmp_path: Path, command: Command
) -> None:
    (tmp_path / "points.csv").write_text("crank_angle_deg,position_mm\n0,400\n90,350\n180,200\n270,300\n")
    job.write_text(f'{fronts.JOB}\n[target_motion]\nfile = "points.csv"\n')
    assert command("submit", job).exit_code == 0
    assert store.artefact_names(1) == ["job.json"]
    assert len(json.loads(store.artefact(1, "job.json").content)["target_motion"]["positions"]) == 4


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("none.toml",), "none.toml: no such file"),
        (("JOB", "--priority", "5000"), "a job must have a priority from -1000 to 1000"),
        (("JOB", "--seconds", "0"), "a limit on seconds must be a positive number of s; got 0.0"),
        (("JOB", "--memory", "much"), "--memory must be an amount of memory with its unit; got 'much'"),
        (("JOB", "--store", "mysql://here/jobs"), "a store must be postgresql://user@host/database"),
        pytest.param(
            ("JOB", "--store", "/proc/none/store.db"),
            "/proc/none must be a writable folder",
            marks=pytest.mark.skipif(sys.platform != "linux", reason="/proc is a folder of Linux"),
        ),
    ],
)
def test_what_cannot_be_submitted_is_one_sentence(
    arguments: tuple[str, ...], message: str, job: Path, command: Command
) -> None:
    done = command("submit", *(str(job) if argument == "JOB" else argument for argument in arguments))
    assert (done.exit_code, done.stdout) == (2, "")
    assert message in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.slow
@pytest.mark.parametrize("who", ["nobody", "a worker", "this command"])
def test_a_function_of_a_job_is_called_where_whoever_runs_it_allows_it(
    who: str, tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = fronts.JOB.replace("[objectives]", '[objectives]\nmine = "minimise"')
    (tmp_path / "own.toml").write_text(f'{text}\n[quantity]\nmine = {{ function = "lengths:rod", unit = "mm" }}\n')
    (tmp_path / "lengths.py").write_text("def rod(designs):\n    return designs.rod[:, 0]\n")
    monkeypatch.chdir(tmp_path)
    if who == "this command":
        assert command("optimise", "own.toml", "--no-figures").exit_code == 0
        return
    done = command("submit", "own.toml")
    assert (done.exit_code, done.stdout.splitlines()) == (0, ["job 1: Short test [job], queued"])
    told = done.stderr.splitlines()[0]
    assert told.endswith(
        "slidercrank serve --allow-quantity lengths:rod; or solve the job here: slidercrank optimise own.toml"
    )
    options = re.findall(r"--allow-quantity \S+(?=;)", told)[0].split() if who == "a worker" else []
    assert command("worker", "--drain", "--cores", "1", *options).exit_code == 0
    job = json.loads(command("jobs", "--json").stdout)[0]
    if who == "a worker":
        assert (job["state"], job["summary"]["designs"] > 0) == ("done", True), job
    else:
        assert job["state"] == "failed"
        assert (
            'only functions that the operator allows may run here; got "lengths:rod"; have it allowed' in job["reason"]
        )


def test_jobs_are_listed_with_what_they_found(
    store: Store, job: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    command("submit", job)
    solve_waiting_jobs(store, monkeypatch)
    command("submit", job)
    solve_waiting_jobs(store, monkeypatch, "infeasible")
    command("submit", job)
    lines = [line.split() for line in command("jobs").stdout.splitlines()]
    rows = {line[0]: " ".join(line[3:]) for line in lines if line and line[0].isdecimal()}
    assert rows["3"] == "Short test [job] queued no worker is running"
    assert rows["2"] == "Short test [job] infeasible none"
    assert rows["1"].startswith("Short test [job] done 4 designs; best time ratio 1.")
    assert list(rows) == ["3", "2", "1"]


def test_jobs_as_json_are_those_of_the_api(store: Store, job: Path, command: Command) -> None:
    for _ in range(3):
        command("submit", job)
    command("cancel", 2)
    listed = json.loads(command("jobs", "--json", "--limit", 2).stdout)
    assert listed == [store.job(3).record(), store.job(2).record()]
    assert [one["id"] for one in json.loads(command("jobs", "--state", "cancelled", "--json").stdout)] == [2]
    assert json.loads(command("jobs", "--name", "nothing", "--json").stdout) == []


def test_without_a_store_there_are_no_jobs_and_none_is_made(runs: Path, command: Command) -> None:
    done = command("jobs")
    assert (done.exit_code, done.stdout) == (0, "")
    assert "no job in" in done.stderr
    assert command("jobs", "--json").stdout == "[]\n"
    for name in ("watch", "cancel", "resume", "delete"):
        done = command(name, "latest")
        assert done.exit_code == 2
        assert "there is no store at" in done.stderr
    assert not (runs / "slidercrank.db").exists()


def test_a_state_that_no_job_has_is_refused(command: Command) -> None:
    done = command("jobs", "--state", "lost")
    assert done.exit_code == 2
    assert "--state must be queued, running, done, infeasible, cancelled or failed; got 'lost'" in done.stderr


@pytest.mark.parametrize("name", ["watch", "cancel", "resume", "delete"])
@pytest.mark.parametrize(
    ("job", "message"),
    [
        ("9", "there is no job 9; list the jobs"),
        ("99999999999999999999", "a job must be given by its number"),
        ("first", "a job must be given by its number, or \"latest\"; got 'first'; list the jobs"),
        ("latest", "there is no job in"),
    ],
)
def test_a_job_that_is_not_there_is_one_sentence(
    name: str, job: str, message: str, store: Store, command: Command
) -> None:
    done = command(name, job)
    assert (done.exit_code, done.stdout) == (2, "")
    assert message in done.stderr


@pytest.mark.parametrize("name", ["jobs", "watch", "cancel"])
def test_a_file_that_is_no_database_is_one_sentence(name: str, tmp_path: Path, command: Command) -> None:
    (tmp_path / "no.db").write_text("no database")
    done = command(name, *([] if name == "jobs" else ["1"]), "--store", tmp_path / "no.db")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "file is not a database" in done.stderr


def test_a_job_is_cancelled_resumed_and_deleted(store: Store, job: Path, command: Command) -> None:
    command("submit", job)
    assert command("cancel", "latest").stdout == "job 1: Short test [job], cancelled: cancelled before it was done\n"
    refused = command("submit", job).exit_code, command("delete", 2).stderr
    assert refused == (0, "slidercrank: only a job that has ended can be deleted; job 2 is queued; cancel it first\n")
    assert json.loads(command("resume", 1, "--json").stdout) == store.job(1).record()
    assert store.job(1).state == "queued"
    assert json.loads(command("cancel", 1, "--json").stdout)["state"] == "cancelled"
    assert json.loads(command("delete", 1, "--json").stdout) == {"deleted": 1}
    assert [one.id for one in store.jobs()] == [2]


def test_a_running_job_is_asked_to_stop(store: Store, job: Path, command: Command) -> None:
    command("submit", job)
    store.claim("first")
    assert command("cancel", 1).stdout == "job 1: Short test [job], asked to stop\n"
    assert "stopping" in command("jobs").stdout


@pytest.mark.parametrize(("status", "code"), [("done", 0), ("infeasible", 3), ("cancelled", 130)])
def test_watching_ends_with_the_exit_code_of_the_job(
    status: str, code: int, store: Store, job: Path, command: Command
) -> None:
    command("submit", job)
    claim = store.claim("first")
    assert claim is not None
    claim.report(Progress("evolving", 2, 9, 1600, 12, 0.25, 1.0))
    claim.finish(result(status, rows=[]))
    done = command("watch", "latest")
    assert done.exit_code == code
    said = [line[10:] for line in done.stdout.splitlines()[:4]]
    assert said == [
        "queued",
        "running: claimed by first",
        "evolving 2/9: 1,600 evaluated, 12 feasible, hypervolume 0.2500",
        f"{status}: 0 designs",
    ]


def test_long_stages_are_watched_now_and_then_and_listed(store: Store, job: Path, command: Command) -> None:
    command("submit", job)
    claim = store.claim("first")
    assert claim is not None
    for step in (0, 700, 1400):
        claim.report(Progress("selecting designs", 9, 9, 1600, 12, 0.25, 1.0, step, 3000))
    assert "selecting designs 1,400/3,000, 12 feasible" in command("jobs").stdout
    claim.finish(result("done", rows=[]))
    assert command("watch", "latest").stdout.count("selecting designs") == 1
    assert command("watch", "latest", "--json").stdout.count("selecting designs") == 3


def test_progress_of_an_early_store_without_steps_is_read(
    store: Store, job: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    command("submit", job)
    claim = store.claim("first")
    assert claim is not None
    early = asdict(Progress("evolving", 2, 9, 1600, 12, 0.25, 1.0))
    del early["step"], early["steps"]
    monkeypatch.setattr("slidercrank.service.store.claim.asdict", lambda _: early)
    claim.report(Progress("evolving", 2, 9, 1600, 12, 0.25, 1.0))
    assert "evolving 2/9, 12 feasible" in command("jobs").stdout
    listed = json.loads(command("jobs", "--json").stdout)[0]["progress"]
    assert (listed["step"], listed["steps"], listed["round"]) == (0, 0, 2)
    claim.finish(result("done", rows=[]))
    assert "evolving 2/9: 1,600 evaluated" in command("watch", "latest").stdout
    (told,) = (event for event in store.events(1) if event.kind == "progress")
    assert Progress(**told.data).steps == 0


def test_watching_a_resumed_job_ends_with_its_last_end(store: Store, job: Path, command: Command) -> None:
    command("submit", job)
    command("cancel", 1)
    command("resume", 1)
    claim = store.claim("first")
    assert claim is not None
    watched = events_until_end(store, 1)
    assert [next(watched).data.get("state") for _ in range(4)] == ["queued", "cancelled", "queued", "running"]
    claim.finish(result("done", rows=[]))
    assert [event.data["state"] for event in watched] == ["done"]


def test_watching_a_failed_job_ends_with_2(store: Store, job: Path, command: Command) -> None:
    command("submit", job)
    claim = store.claim("first")
    assert claim is not None
    claim.fail("two problems\n  here and there", again=False)
    done = command("watch", 1)
    assert done.exit_code == 2
    assert done.stdout.splitlines()[-1][10:] == "failed: two problems here and there"


def test_watching_as_json_gives_an_event_a_line(store: Store, job: Path, command: Command) -> None:
    command("submit", job)
    command("cancel", 1)
    events = [json.loads(line) for line in command("watch", 1, "--json").stdout.splitlines()]
    assert [(event["number"], event["kind"], event["data"]["state"]) for event in events] == [
        (1, "state", "queued"),
        (2, "state", "cancelled"),
    ]
    assert set(events[0]) == {"number", "at", "kind", "data"}


def test_submitting_can_watch_to_the_end(
    store: Store, job: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def work_soon() -> None:
        while not store.jobs():
            time.sleep(0.01)
        work(store, drain=True)

    fronts.replace_solve(monkeypatch, fronts.front(designs=4))
    thread = threading.Thread(target=work_soon)
    thread.start()
    done = command("submit", job, "--watch")
    thread.join()
    assert done.exit_code == 0
    assert done.stdout.startswith("job 1: Short test [job], queued\n")
    assert "Short test [job]: " not in done.stderr
    assert "* best in an objective" in done.stdout


def test_ctrl_c_leaves_watching_and_not_the_job(
    store: Store, job: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(_: float) -> None:
        raise KeyboardInterrupt

    command("submit", job)
    monkeypatch.setattr("slidercrank.service.commands.submit.time.sleep", interrupt)
    done = command("watch", "latest")
    assert done.exit_code == 130
    assert "job 1 continues; stop it with: slidercrank cancel 1\n" in done.stderr
    assert store.job(1).state == "queued"


def test_watching_waits_for_a_database_that_is_away(
    store: Store, job: Path, command: Command, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from slidercrank.service.store.database import Unavailable

    command("submit", job)
    command("cancel", 1)
    there, asked = store.events, []

    def away(*given: Any, **more: Any) -> Any:
        asked.append(True)
        if len(asked) < 3:
            raise Unavailable("the server restarts")
        return there(*given, **more)

    monkeypatch.setattr(store, "events", away)
    monkeypatch.setattr("slidercrank.service.commands.submit._AWAY", 0.0)
    assert [event.number for event in events_until_end(store, 1)] == [1, 2]
    assert capsys.readouterr().err == "slidercrank: the server restarts; trying again\n"


def test_jobs_that_wait_for_a_worker_are_told_of(
    store: Store, job: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    idle = "no worker is running, so jobs wait; start one with: slidercrank serve"
    assert idle in command("submit", job).stderr
    assert idle in command("jobs").stderr
    assert json.loads(command("jobs", "--json").stdout)[0]["state"] == "queued"
    threading.Timer(0.5, lambda: store.cancel(1)).start()
    assert idle in command("watch", "latest").stderr
    assert idle not in command("jobs").stderr, "nothing waits"
    store.register("one")
    assert idle not in command("submit", job).stderr
    assert idle not in command("jobs").stderr
