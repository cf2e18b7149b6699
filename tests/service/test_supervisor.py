"""Worker processes under a supervisor: what ends them, what starts them again, and that none is left."""

from __future__ import annotations

import logging
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest

from slidercrank.service.store import Job, Limits, Store
from slidercrank.service.workers.engines import EngineOptions
from slidercrank.service.workers.heartbeat import EXHAUSTED
from slidercrank.service.workers.supervisor import WORKER, Supervisor, exit_reason
from slidercrank.service.workers.worker import Terms
from slidercrank.service.workers.worker_process import REFUSED, WorkerSettings
from tests.service import made_up_process
from tests.service.made_up_process import ROUNDS

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
ROOT = Path(made_up_process.__file__).parents[2]
MADE_UP = (sys.executable, "-m", "tests.service.made_up_process")


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Store]:
    """Return an empty store, in the folder from which the made-up process can be run."""
    monkeypatch.chdir(ROOT)
    with Store(tmp_path / "store.db") as opened:
        yield opened


def settings(store: Store, *, lease: float = 2.0, grace: float = 0.5, drain: bool = False) -> WorkerSettings:
    """Return settings of workers with a short lease."""
    return WorkerSettings(address=store.name, lease=lease, drain=drain, terms=Terms(grace=grace))


def submit_made_up_job(store: Store, name: str, limits: Limits | None = None) -> Job:
    """Return a job that does what its name says."""
    return store.submit({}, name=name, limits=limits or Limits())


def until(condition: Callable[[], object], what: str) -> None:
    """Wait until something is so."""
    end = time.monotonic() + 120.0
    while not condition():
        assert time.monotonic() < end, f"within 2 minutes there was no {what}"
        time.sleep(0.05)


def has_ended(process: int) -> bool:
    """Whether a process has ended; one that nobody has waited for counts."""
    try:
        return psutil.Process(process).status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True


def test_a_worker_that_is_killed_is_replaced_and_its_job_goes_on(
    store: Store, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO)
    job = submit_made_up_job(store, "rounds")
    with Supervisor(settings(store), 1, program=MADE_UP) as supervisor:
        until(lambda: store.job(job.id).records >= 3, "third round")
        (killed,) = supervisor.processes()
        os.kill(killed, signal.SIGKILL)
        until(lambda: store.job(job.id).state == "done", "end of the job")
        (other,) = supervisor.processes()
        assert other != killed
    assert has_ended(other)
    rounds = [event.data["round"] for event in store.events(job.id) if event.kind == "progress"]
    assert rounds == list(range(1, ROUNDS + 1))
    assert "worker 1 ended: killed by SIGKILL; another one starts in 0.5 s" in caplog.messages


def test_workers_that_are_told_to_stop_hand_their_job_back_between_rounds(store: Store) -> None:
    job = submit_made_up_job(store, "rounds")
    with Supervisor(settings(store, lease=60.0), 1, program=MADE_UP):
        until(lambda: store.job(job.id).records >= 2, "second round")
    after = store.job(job.id)
    assert (after.state, after.reason) == ("queued", "its worker stopped; another one continues")
    assert after.records >= 2
    assert after.attempts == 0
    assert store.workers() == []


def test_a_worker_in_an_endless_round_hands_its_job_back_when_its_grace_is_over(store: Store) -> None:
    job = submit_made_up_job(store, "stuck")
    with Supervisor(settings(store, lease=60.0), 1, program=MADE_UP) as supervisor:
        until(lambda: store.job(job.id).records == 1, "first round")
        (process,) = supervisor.processes()
    assert has_ended(process)
    after = store.job(job.id)
    assert (after.state, after.records) == ("queued", 1)
    assert after.reason == "its worker stopped in the middle of a round; another one continues"


def test_a_job_whose_search_has_not_begun_is_handed_back_before_the_grace_is_over(store: Store) -> None:
    job = submit_made_up_job(store, "loads")
    with Supervisor(settings(store, lease=60.0, grace=60.0), 1, program=MADE_UP):
        until(lambda: store.job(job.id).state == "running", "claim of the job")
        begin = time.monotonic()
    assert time.monotonic() - begin < 10.0
    after = store.job(job.id)
    assert (after.state, after.attempts) == ("queued", 0)
    assert after.reason == "its worker stopped before its search began; another one continues"


def test_a_worker_that_cannot_stop_is_killed(
    store: Store, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    deaf = (sys.executable, "-c", "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(60)")
    monkeypatch.setattr("slidercrank.service.workers.supervisor.MARGIN", 0.5)
    with Supervisor(settings(store, grace=0.0), 1, program=deaf) as supervisor:
        until(supervisor.processes, "process")
        (process,) = supervisor.processes()
    assert has_ended(process)
    assert f"worker process {process} did not stop in time and is killed" in caplog.messages


@pytest.mark.slow
def test_a_job_that_takes_too_much_memory_fails_and_its_worker_is_replaced_at_once(
    store: Store, caplog: pytest.LogCaptureFixture
) -> None:
    greedy = submit_made_up_job(store, "greedy", Limits(memory=300_000_000))
    after = submit_made_up_job(store, "rounds")
    with Supervisor(settings(store), 1, program=MADE_UP):
        until(lambda: store.job(after.id).state == "done", "end of the next job")
    failed = store.job(greedy.id)
    assert failed.state == "failed"
    assert re.fullmatch(
        r"it may use 300 MB of memory; its worker used \d{3} MB; give it a higher limit, or ask for less",
        failed.reason,
    )
    assert "worker 1 ended: its job used more memory than allowed; another one starts in 0 s" in caplog.messages


@pytest.mark.slow
def test_what_earlier_jobs_left_does_not_count_against_a_job(store: Store) -> None:
    leaves = submit_made_up_job(store, "leaves")
    fits = submit_made_up_job(store, "rounds", Limits(memory=350_000_000))
    greedy = submit_made_up_job(store, "greedy", Limits(memory=350_000_000))
    with Supervisor(settings(store), 1, program=MADE_UP):
        until(lambda: store.job(greedy.id).state == "failed", "end of the jobs")
    assert (store.job(leaves.id).state, store.job(fits.id).state) == ("done", "done")
    told = [event.data.get("reason") for event in store.events(fits.id)]
    assert "a new worker continues it: earlier jobs left too little memory in this one" in told
    assert re.search(r"it may use 350 MB of memory; its worker used \d{3} MB", store.job(greedy.id).reason)


@pytest.mark.slow
@pytest.mark.parametrize("ends", ["cancelled", "out of time"])
def test_a_job_that_hears_nothing_does_not_keep_its_worker(ends: str, store: Store) -> None:
    loops = submit_made_up_job(store, "loops", Limits(seconds=0.3) if ends == "out of time" else None)
    after = submit_made_up_job(store, "rounds")
    with Supervisor(settings(store), 1, program=MADE_UP):
        until(lambda: store.job(loops.id).records == 1, "first round")
        if ends == "cancelled":
            store.cancel(loops.id)
        until(lambda: store.job(after.id).state == "done", "end of the next job")
    ended = store.job(loops.id)
    assert (ended.state, ended.records) == ("cancelled", 1)
    assert ended.reason.endswith("; its search did not stop when asked to")
    assert ended.reason.startswith("its search reached" if ends == "out of time" else "cancelled before")


def test_workers_leave_when_their_supervisor_is_killed(store: Store) -> None:
    job = submit_made_up_job(store, "stuck")
    script = (
        "import sys, time\n"
        "from slidercrank.service.workers.supervisor import Supervisor\n"
        "from slidercrank.service.workers.worker import Terms\n"
        "from slidercrank.service.workers.worker_process import WorkerSettings\n"
        f"settings = WorkerSettings(address={store.name!r}, lease=60.0, terms=Terms(grace=0.5))\n"
        f"with Supervisor(settings, 1, program={MADE_UP!r}) as supervisor:\n"
        "    while not supervisor.processes(): time.sleep(0.02)\n"
        "    print(*supervisor.processes(), flush=True)\n"
        "    time.sleep(60)\n"
    )
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as supervisor:
        assert supervisor.stdout is not None
        worker = int(supervisor.stdout.readline())
        until(lambda: store.job(job.id).records == 1, "first round")
        supervisor.kill()
    until(lambda: has_ended(worker), "end of the worker")
    assert store.job(job.id).state == "queued"


def test_a_worker_that_ends_at_once_is_started_again_ever_later(
    store: Store, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("slidercrank.service.workers.supervisor._FIRST", 0.1)
    monkeypatch.setattr("slidercrank.service.workers.supervisor._LONGEST", 0.3)
    broken = (sys.executable, "-c", "raise SystemExit(7)")
    with Supervisor(settings(store), 1, program=broken):
        until(lambda: sum("ended" in message for message in caplog.messages) >= 4, "fourth end")
    ends = [message for message in caplog.messages if "ended" in message][:4]
    assert ends == [f"worker 1 ended: exit code 7; another one starts in {pause} s" for pause in (0.1, 0.2, 0.3, 0.3)]


def test_a_program_that_cannot_be_started_is_told(store: Store, caplog: pytest.LogCaptureFixture) -> None:
    with Supervisor(settings(store), 1, program=("/no/such/program",)) as supervisor:
        until(lambda: caplog.messages, "message")
        assert supervisor.processes() == []
    assert caplog.messages[0] == (
        "worker 1 could not be started: No such file or directory; another one starts in 0.5 s"
    )


@pytest.mark.slow
def test_draining_workers_are_not_replaced(store: Store) -> None:
    jobs = [submit_made_up_job(store, "rounds") for _ in range(3)]
    with Supervisor(settings(store, drain=True), 2, program=MADE_UP) as supervisor:
        until(supervisor.is_finished, "end of the queue")
        assert supervisor.processes() == []
    assert [store.job(job.id).state for job in jobs] == ["done"] * 3


def test_a_worker_refuses_a_store_that_is_none(tmp_path: Path) -> None:
    (tmp_path / "no.db").write_text("no database")
    line = WorkerSettings(address=str(tmp_path / "no.db")).to_line()
    # Its standard input stays open: the end of it asks a worker to stop, perhaps before it looks at the store.
    with subprocess.Popen(WORKER, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        process.stdin.write(line)
        process.stdin.flush()
        assert b"file is not a database" in process.stderr.read()
        assert process.wait(60.0) == REFUSED


def test_a_worker_waits_for_a_store_that_is_away_until_it_is_told_to_stop(tmp_path: Path) -> None:
    settings = WorkerSettings(address="postgresql://nobody@/none?host=/no/such/place")
    with subprocess.Popen(WORKER, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        process.stdin.write(settings.to_line())
        process.stdin.flush()
        assert b"the store must be a database that can be reached" in process.stderr.readline()
        process.stdin.close()
        assert process.wait(60.0) == 0


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        (0, "it left"),
        (1, "exit code 1"),
        (REFUSED, "it could not start; see above"),
        (EXHAUSTED, "its job used more memory than allowed"),
        (-11, "killed by SIGSEGV"),
        (-200, "killed by signal 200"),
    ],
)
def test_exit_codes_are_told_in_words(code: int, reason: str) -> None:
    assert exit_reason(code) == reason


def test_settings_come_as_they_were_sent() -> None:
    sent = WorkerSettings(
        address="postgresql://me:secret@there/jobs",
        terms=Terms(
            limits=Limits(seconds=3.0, memory=10**9),
            allowed_quantities=("mine:cost",),
            engine=EngineOptions(scheduler="tls://here:8786", tls_ca=Path("ca.pem")),
        ),
        most_running=2,
    )
    assert WorkerSettings.from_line(sent.to_line()) == sent
