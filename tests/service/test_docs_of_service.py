"""docs/service.md word for word: its commands run, its examples for system administrators are valid."""

from __future__ import annotations

import configparser
import contextlib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cloudpickle  # type: ignore[import-untyped]
import pytest
import yaml  # type: ignore[import-untyped]
from distributed import Client
from sqlalchemy import create_engine
from typer.testing import CliRunner

from slidercrank.service.api.server import listening_socket
from slidercrank.service.cli import app
from slidercrank.service.store import Store
from tests.faults.dask_cluster import CALM
from tests.faults.dask_faults import ROBUST
from tests.service import fronts
from tests.service.conftest import Command
from tests.service.store import postgresql

pytestmark = pytest.mark.skipif(os.name == "nt", reason="a shell of Unix")
HEAVY = f"""{ROBUST.replace("[robust]", 'transmission_angle = "maximise"' + chr(10) + "[robust]")}samples = 65536
[optimiser]
method = "random"
evaluations = 6000
designs = 58
"""
"""A job whose Monte Carlo is worth the way to a cluster many times over: a second of work pays."""
OURS = ("SLIDERCRANK_RUNS", "SLIDERCRANK_STORE", "SLIDERCRANK_TOKEN")
STAYS = ("slidercrank serve", "slidercrank worker", "dask ")


@pytest.fixture(scope="module")
def docs(pytestconfig: pytest.Config) -> Path:
    """Return the folder of the documentation."""
    return pytestconfig.rootpath / "docs"


def commands(docs: Path, section: str = "") -> list[str]:
    """Return the shell commands of a section, or of the whole page."""
    page = (docs / "service.md").read_text(encoding="utf-8")
    if section:
        page = page.split(f"\n## {section}\n")[1].split("\n## ")[0]
    blocks = "".join(re.findall(r"^```sh\n(.*?)^```$", page, re.MULTILINE | re.DOTALL))
    lines = blocks.replace("\\\n", " ").splitlines()
    return [re.sub(r"\s+# .*", "", line) for line in lines if line]


class Terminal:
    """Runs commands of the documentation in a folder that has its job file, with the programs of this environment."""

    def __init__(self, folder: Path, programs: Path | None = None, job: str = fronts.JOB) -> None:
        self.folder = folder
        places = [str(Path(sys.executable).parent), *([str(programs)] if programs else []), os.environ["PATH"]]
        self.changed = {"PATH": os.pathsep.join(places), **CALM, **dict.fromkeys(OURS)}
        (folder / "runs").mkdir()
        (folder / "runs" / "feeder.toml").write_text(job)

    def environment(self) -> dict[str, str]:
        """Return the variables of its processes."""
        return {name: value for name, value in {**os.environ, **self.changed}.items() if value is not None}

    def run(self, line: str) -> str:
        """Run a command to its end and return its output; one of slidercrank in this process, where it is imported."""
        words = shlex.split(line)
        if words[0] == "slidercrank":
            with contextlib.chdir(self.folder):
                own = CliRunner().invoke(app, words[1:], env=self.changed)
            assert own.exit_code == 0, f"{line}: {own.output}"
            return own.stdout
        done = subprocess.run(
            ["sh", "-c", line], cwd=self.folder, env=self.environment(), capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{line}: {done.stdout}{done.stderr}"
        return done.stdout

    @contextlib.contextmanager
    def stays(self, line: str) -> Iterator[subprocess.Popen[str]]:
        """Run a command that stays, until the end; SIGTERM then lets it end in an orderly way."""
        with (
            (self.folder / "log.txt").open("a") as log,
            subprocess.Popen(
                ["sh", "-c", f"exec {line}"],
                cwd=self.folder,
                env=self.environment(),
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
            ) as process,
        ):
            try:
                yield process
                process.send_signal(signal.SIGTERM)
                assert process.wait(60.0) == 0, (self.folder / "log.txt").read_text()
            finally:
                process.kill()


@pytest.fixture
def free_port() -> int:
    """Return a port that is free now."""
    with listening_socket("127.0.0.1", 0) as one:
        return int(one.getsockname()[1])


def api_response(url: str, token: str, *, job: str | None = None) -> object:
    """Return the API's answer; with a job, to its submission."""
    headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/toml"}
    request = urllib.request.Request(url, None if job is None else job.encode(), headers)
    with urllib.request.urlopen(request, timeout=60.0) as response:
        return json.load(response)


@pytest.mark.slow
def test_the_service_in_five_lines_with_backup_and_restore(docs: Path, tmp_path: Path) -> None:
    terminal = Terminal(tmp_path)
    serve, *others = commands(docs, "")[:5]
    assert serve == "slidercrank serve"
    with terminal.stays(f"{serve} --port 0 --workers 1 --log-format json") as service:
        assert service.stdout is not None
        assert service.stdout.readline() == "slidercrank serves the jobs of sqlite:///runs/slidercrank.db at\n"
        address, token = service.stdout.readline().strip().split("?token=")
        over_http = api_response(f"{address}api/v1/jobs", token, job=fronts.JOB)
        assert isinstance(over_http, dict)
        terminal.run(f"slidercrank watch {over_http['id']}")
        printed = [terminal.run(line) for line in others]
        assert printed[0] == "job 2: Short test [job], queued\n"
        assert "8 designs" in printed[-1]
        listed = api_response(f"{address}api/v1/jobs", token)
        assert isinstance(listed, dict)
        assert [job["state"] for job in listed["jobs"]] == ["done", "done"]
        backup, *restore = [line for line in commands(docs, "Backup and restore") if "pg_" not in line]
        terminal.run(backup)
    log = [json.loads(line) for line in (tmp_path / "log.txt").read_text().splitlines() if line.startswith("{")]
    assert [one["job"] for one in log if one["message"].startswith("done:")] == [1, 2]
    terminal.run("slidercrank delete 1")
    for line in restore:
        terminal.run(line)
    with Store(tmp_path / "runs" / "slidercrank.db") as store:
        assert [job.state for job in store.jobs()] == ["done", "done"]
        assert len(store.result(1).designs) == 8


@pytest.fixture(scope="module")
def server() -> Iterator[tuple[str, Path]]:
    """Return the address of a database on a PostgreSQL server, and the folder of its programs."""
    reason = postgresql.why_not()
    if reason:
        pytest.skip(reason)
    programs = postgresql.programs()
    assert programs is not None
    if not shutil.which("pg_dump", path=f"{programs}{os.pathsep}{os.environ['PATH']}"):
        pytest.skip("pg_dump is not installed (Debian: postgresql-client)")
    with postgresql.cluster(programs) as started:
        engine = create_engine(f"postgresql+psycopg://tests@/postgres?host={started.folder}")
        with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.exec_driver_sql("CREATE DATABASE jobs")
        engine.dispose()
        yield f"postgresql://tests@/jobs?host={started.folder}", programs


def done_on_cluster(port: int) -> int:
    """Return how many kinds of tasks of the engine a scheduler saw done."""
    cloudpickle.register_pickle_by_value(sys.modules[__name__])
    with Client(f"tcp://127.0.0.1:{port}", set_as_default=False) as client:  # type: ignore[no-untyped-call]
        return int(client.run_on_scheduler(count_finished_tasks))


def count_finished_tasks(dask_scheduler: Any) -> int:
    """Return how many kinds of tasks of the engine a scheduler has seen done; runs in its process."""
    groups = dask_scheduler.task_prefixes.values()
    return sum(sum(group.all_durations.values()) > 0 for group in groups if group.name.startswith("slidercrank"))


@pytest.mark.slow
def test_postgresql_with_two_workers_and_a_dask_cluster(
    docs: Path, server: tuple[str, Path], tmp_path: Path, free_port: int
) -> None:
    address, programs = server
    terminal = Terminal(tmp_path, programs, HEAVY)
    lines = commands(docs, "PostgreSQL and Dask")
    assert lines[:4] == [  # of the server's administrator; the tests have their own server and packages
        "sudo -u postgres createuser slidercrank --pwprompt",
        "sudo -u postgres createdb jobs --owner slidercrank",
        'pip install ".[service,postgres,dask]"',
        "export SLIDERCRANK_STORE=postgresql://slidercrank@127.0.0.1/jobs",
    ]
    terminal.changed["SLIDERCRANK_STORE"] = address
    assert lines[4] == "slidercrank doctor"
    assert "PostgreSQL" in terminal.run(lines[4])
    with contextlib.ExitStack() as running:
        for line in (line.replace("8786", str(free_port)) for line in lines[5:]):
            if line.startswith("slidercrank serve"):
                service = running.enter_context(terminal.stays(f"{line} --port 0"))
                assert service.stdout is not None
                assert "postgresql" in service.stdout.readline()
            elif line.startswith(STAYS):
                running.enter_context(terminal.stays(line))
            else:
                assert "8 designs" in terminal.run(line)
        assert done_on_cluster(free_port) > 0
    assert (tmp_path / "log.txt").read_text().count(" of 2 started as process ") == 2
    with Store(address) as store:
        assert store.workers() == []
        dump, restore = [line for line in commands(docs, "Backup and restore") if "pg_" in line]
        found = store.result(1).designs
        terminal.run(dump)
        store.delete(1)
        terminal.run(restore)
        assert store.result(1).designs == found


def test_every_command_of_the_page_is_one_of_the_command_line(docs: Path, command: Command) -> None:
    found = 0
    for line in commands(docs):
        words = [word for word in shlex.split(line) if "=" not in word or word.startswith("-")]
        if words and words[0] == "slidercrank":
            done = command(*words[1:], "--help")
            assert done.exit_code == 0, f"{line}: {done.stderr}"
            found += 1
    assert found > 10


def test_every_option_that_the_page_names_exists(docs: Path, command: Command) -> None:
    page = re.sub(r"^```.*?^```$", "", (docs / "service.md").read_text(), flags=re.MULTILINE | re.DOTALL)
    named = set(re.findall(r"`[^`]*?(--[a-z][a-z-]+)", page))
    assert "--most-memory" in named
    help_texts = "".join(command(name, "--help").stdout for name in ("serve", "worker", "submit", "watch", "doctor"))
    assert {option for option in named if f"{option} " not in f"{help_texts} "} == set()


def test_the_systemd_unit_is_valid_and_starts_the_service(docs: Path, tmp_path: Path, command: Command) -> None:
    text = (docs / "slidercrank.service").read_text()
    unit = configparser.ConfigParser(strict=False, interpolation=None)
    unit.optionxform = str  # type: ignore[assignment,method-assign]
    unit.read_string(text)
    program, *arguments = shlex.split(unit["Service"]["ExecStart"])
    assert program == "/opt/slidercrank/bin/slidercrank"
    assert command(*arguments, "--help").exit_code == 0
    analyse = shutil.which("systemd-analyze")
    if analyse is not None:
        installed = tmp_path / "slidercrank.service"
        installed.write_text(text.replace(program, sys.executable))
        done = subprocess.run([analyse, "verify", installed], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")


def test_the_container_file_copies_what_there_is_and_starts_the_service(docs: Path, command: Command) -> None:
    lines = (docs / "Containerfile").read_text().replace("\\\n", " ").splitlines()
    steps = [line.split(maxsplit=1) for line in lines if line and not line.startswith("#")]
    copied = [word for step, rest in steps if step == "COPY" for word in rest.split()[:-1]]
    assert {name for name in copied if not (docs.parent / name).exists()} == set()
    assert {"pyproject.toml", ".package", "model", "objectives", "optimise", "service"} <= set(copied)
    (start,) = [json.loads(rest) for step, rest in steps if step == "CMD"]
    assert start[0] == "slidercrank"
    assert command(*start[1:], "--help").exit_code == 0


@pytest.fixture
def compose(docs: Path) -> dict[str, Any]:
    """Return the services of docs/compose.yaml."""
    services: dict[str, Any] = yaml.safe_load((docs / "compose.yaml").read_text(encoding="utf-8"))["services"]
    return services


def test_the_compose_file_names_what_there_is(docs: Path, compose: dict[str, Any], command: Command) -> None:
    assert set(compose) == {"database", "service", "worker"}
    for name, service in compose.items():
        assert service["healthcheck"]["test"][0] == "CMD"
        if name == "database":
            assert service["environment"].keys() == {"POSTGRES_USER", "POSTGRES_DB", "POSTGRES_PASSWORD"}
            continue
        assert (docs / service["build"]["context"] / service["build"]["dockerfile"]).is_file()
        assert service["depends_on"] == {"database": {"condition": "service_healthy"}}
        program, *arguments = service["command"]
        assert program == "slidercrank"
        assert command(*arguments, "--help").exit_code == 0
    user, database = (compose["database"]["environment"][f"POSTGRES_{key}"] for key in ("USER", "DB"))
    assert compose["worker"]["environment"]["SLIDERCRANK_STORE"] == f"postgresql://{user}@database/{database}"
    assert compose["service"]["ports"] == ["127.0.0.1:8765:8765"]


@pytest.mark.slow
def test_the_commands_of_the_compose_file_run_and_find_each_other(
    compose: dict[str, Any], server: tuple[str, Path], tmp_path: Path, free_port: int
) -> None:
    address, programs = server
    terminal = Terminal(tmp_path, programs)
    terminal.changed |= {"SLIDERCRANK_STORE": address, "SLIDERCRANK_TOKEN": "a-token-of-enough-characters-for-all"}
    host = address.partition("?host=")[2]
    ready = [*compose["database"]["healthcheck"]["test"][1:], "--host", host]
    terminal.run(shlex.join(word.replace("slidercrank", "tests") for word in ready))
    port = str(free_port)
    with contextlib.ExitStack() as running:
        for name in ("service", "worker"):
            line = shlex.join(compose[name]["command"]).replace("8765", port).replace("0.0.0.0", "127.0.0.1")
            process = running.enter_context(terminal.stays(line))
            if name == "service":
                assert process.stdout is not None
                process.stdout.readline()
        check = shlex.join(compose["service"]["healthcheck"]["test"][1:]).replace("8765", port)
        for attempt in range(10):  # as often as containers do while a service starts
            with contextlib.suppress(AssertionError):
                terminal.run(check)
                break
            time.sleep(1.0 + attempt)
        else:
            terminal.run(check)
        _, program, *arguments = compose["worker"]["healthcheck"]["test"]
        assert program == "slidercrank"
        done = CliRunner().invoke(app, arguments, env=terminal.changed)
        problems = [line for line in done.output.splitlines() if "problem " in line and not line.startswith(" ")]
        assert [line for line in problems if "fsync is off" not in line] == [], (
            done.output
        )  # as the tests' server has it
        assert "8 designs" in terminal.run("slidercrank submit runs/feeder.toml --watch")
