"""Recording: every script in a folder and a process of its own, each case as one text file."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any
from unittest.mock import patch

import httpx

from slidercrank.service.store import Store
from tests.doors.contents import kind_of_file, text_of
from tests.doors.masks import masked
from tests.doors.scripts import JOBS, Case, all_scripts
from tests.service.api.serving import client_of

_PROCESSES = (["serve"], ["worker"], ["mcp"])
"""Commands that start processes, or serve until a signal or the end of their input: run as programs."""
_UNCOUNTED = (".db", ".db-wal", ".db-shm", ".db-journal", ".lock")
_DROPPED = ("date", "server", "content-length", "etag", "connection", "transfer-encoding")
_PATIENCE = 300.0  # s
_ENVIRONMENT = {"COLUMNS": "100", "TZ": "UTC", "PYTHONHASHSEED": "0", "MPLBACKEND": "agg"}
_UNSET = ("SLIDERCRANK_RUNS", "SLIDERCRANK_STORE", "SLIDERCRANK_UNITS", "SLIDERCRANK_TOKEN", "SLIDERCRANK_DEBUG")


class Recorder:
    """A script that is being recorded, in the working folder of this process."""

    def __init__(self, place: Path) -> None:
        self.place = place
        self._stack = contextlib.ExitStack()
        self._client: httpx.Client | None = None

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def recorded(self, case: Case) -> tuple[int, str]:
        """Run a case; return its exit code or status, and its record."""
        code, parts = self._run(case) if case.is_command else self._ask(case)
        said = "exit code" if case.is_command else "status"
        text = "".join(f"--- {title}\n{lines.rstrip()}\n" for title, lines in parts if lines.strip())
        return code, masked(f"{case.typed}\n{said} {code}\n{text}", [str(self.place)])

    def _run(self, case: Case) -> tuple[int, list[tuple[str, str]]]:
        before = self._files()
        run = _as_a_program if case.words[:1] in _PROCESSES and "--help" not in case.words else _run_in_process
        code, out, errors = run(case.words)
        written = [name for name, state in self._files().items() if before.get(name) != state]
        files = [(name, text_of((self.place / name).read_bytes(), kind_of_file(name))) for name in sorted(written)]
        return code, [("standard output", out), ("standard error", errors), *files]

    def _files(self) -> dict[str, tuple[int, int]]:
        """Return time and size of every file that a command may have written, by its name."""
        found = {}
        for file in self.place.rglob("*"):
            if file.is_file() and not file.name.endswith(_UNCOUNTED):
                state = file.stat()
                found[str(file.relative_to(self.place))] = (state.st_mtime_ns, state.st_size)
        return found

    def _ask(self, case: Case) -> tuple[int, list[tuple[str, str]]]:
        if self._client is None:
            store = self._stack.enter_context(Store(self.place / "runs" / "slidercrank.db"))
            self._client = self._stack.enter_context(client_of(store, **_SETTINGS))
        headers, sent = case.rest[0], case.body()
        asked: dict[str, Any] = {} if sent is None else {"content": sent[1]}
        if sent is not None:
            headers = {"Content-Type": sent[0], **headers}
        answer = self._client.request(case.method, case.target, headers=headers, timeout=_PATIENCE, **asked)
        fields = [f"{name}: {value}" for name, value in sorted(answer.headers.items()) if name not in _DROPPED]
        body = text_of(answer.content, answer.headers.get("content-type", ""))
        return answer.status_code, [("header", "\n".join(fields)), ("body", body)]


_SETTINGS: dict[str, Any] = {"submissions_per_minute": 0}


def _run_in_process(words: list[str]) -> tuple[int, str, str]:
    from typer.testing import CliRunner

    from slidercrank.service.cli import app

    with patch.object(sys, "argv", ["slidercrank", *words]):
        done = CliRunner().invoke(app, words, prog_name="slidercrank")
    return done.exit_code, done.stdout, done.stderr


def _as_a_program(words: list[str]) -> tuple[int, str, str]:
    """Run a command as a process; one that serves is interrupted as soon as it says where."""
    process = subprocess.Popen(
        [sys.executable, "-m", "slidercrank", *words],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    first = ""
    if words[0] == "serve" and process.stdout is not None:
        first = process.stdout.readline()
        if first:
            first += process.stdout.readline()
            process.send_signal(signal.SIGTERM)
    try:
        out, errors = process.communicate(timeout=_PATIENCE)
    except subprocess.TimeoutExpired:
        process.terminate()
        out, errors = process.communicate()
    return process.returncode, first + out, errors


_strftime = time.strftime


def _format_fixed_time(form: str, _: object = None) -> str:
    """Format the same time each time: names of runs have it, and figures show these names."""
    return _strftime(form, time.gmtime(1767268800))


def _record_script(name: str, cases: dict[str, Case], target: Path) -> tuple[str, float, list[str]]:
    """Record a script in this process; return its name, how long it took, and what ended otherwise than it says."""
    start, wrong = time.monotonic(), []
    os.environ.update(_ENVIRONMENT)
    time.tzset()
    for variable in _UNSET:
        os.environ.pop(variable, None)
    target.mkdir(parents=True)
    with tempfile.TemporaryDirectory(prefix="doors-") as folder:
        place = Path(shutil.copytree(JOBS, Path(folder).resolve() / name))
        (place / "runs").mkdir()
        os.chdir(place)
        with Recorder(place) as recorder, patch.object(time, "strftime", _format_fixed_time):
            for title, case in cases.items():
                code, text = recorder.recorded(case)
                (target / f"{title}.txt").write_text(text, encoding="utf-8")
                if code != case.code:
                    wrong.append(f"{name}: {case.typed}: ends with {case.code}; got {code}")
        os.chdir(folder)
    return name, time.monotonic() - start, wrong


def record(target: Path, names: Iterable[str] = ()) -> list[str]:
    """Record scripts, all unless some are named, into a new folder; return what ended otherwise than it says."""
    scripts = all_scripts()
    chosen = {name: scripts[name] for name in names or scripts}
    target.mkdir(parents=True)
    wrong: list[str] = []
    workers = min(len(chosen), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        longest_first = sorted(chosen.items(), key=lambda item: -len(item[1]))
        tasks = [pool.submit(_record_script, name, cases, target.resolve() / name) for name, cases in longest_first]
        for task in as_completed(tasks):
            name, seconds, found = task.result()
            sys.stderr.write(f"{name}: {len(chosen[name])} cases in {seconds:.0f} s\n")
            wrong += found
    return wrong
