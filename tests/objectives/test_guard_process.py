"""Guards of custom function processes: they end all that a function starts, and bound what it prints."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
import unicodedata
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import psutil
import pytest

from slidercrank.model.kernel.batches import interrupted_by
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.own import function_process_client as own_worker
from slidercrank.objectives.own import guard_process
from slidercrank.objectives.own.function_process import Refused
from slidercrank.objectives.own.function_process_client import Worker

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere, only a group is ended")
DESIGNS = np.array([[0.03, 0.1, 0.01]])
SOON = 2.0  # s, within which nothing of a function is left
MODULE = """
import os, pathlib, random, signal, subprocess, sys, time

folder = pathlib.Path(__file__).parent
over = time.monotonic() + 60.0  # what is not ended ends by itself

def detach(seed):
    "Start a random tree of processes that leave their group and parents, and wait until all of it is there."
    there, alive = os.pipe()
    grow(f"{seed} ", 3, alive)
    if not os.fork():
        chain(alive)
    subprocess.Popen([sys.executable, "-S", "-c", "import time; time.sleep(60)"], start_new_session=True)
    os.close(alive)
    assert os.read(there, 1) == b""
    (folder / "begun").touch()

def grow(place, depth, alive):
    chance = random.Random(place)
    for number in range(chance.randint(1, 3) if depth else 0):
        if os.fork():
            continue
        if chance.random() < 0.7:
            os.setsid()
        if chance.random() < 0.5:
            for one in set(signal.Signals) - {signal.SIGKILL, signal.SIGSTOP}:
                signal.signal(one, signal.SIG_IGN)
        grow(f"{place}{number}", depth - 1, alive)
        if depth > 1 and chance.random() < 0.5:
            os._exit(0)  # its children lose their parent
        os.closerange(0, 2)
        os.close(alive)
        while time.monotonic() < over:
            time.sleep(0.1)
        os._exit(0)

def chain(alive):
    "Live as one process after the other, each in a session of its own."
    os.setsid()
    os.close(alive)
    while time.monotonic() < over:
        if os.fork():
            os._exit(0)
        os.setsid()
        time.sleep(0.002)
    os._exit(0)

def returns(designs):
    detach(1)
    return designs.crank

def stays(designs):
    detach(2)
    while True:
        time.sleep(1.0)

def ends(designs):
    detach(3)
    os._exit(7)

def kills_its_group(designs):
    detach(4)
    os.killpg(0, signal.SIGKILL)

def is_late(designs):
    detach(5)
    while True:
        pass

def closes_its_answers(designs):
    (folder / "begun").touch()
    os.closerange(3, 100)
    while True:
        time.sleep(1.0)

def number(designs):
    return 1.0 * os.getpid() + 0.0 * designs.crank[:, 0].real

def floods(designs):
    for _ in range(50):
        os.write(1, b"x" * 1_000_000)
    return designs.crank

def speaks(designs):
    print("here", 1.5)
    return designs.crank

def babbles(designs):
    chance = random.Random(1)
    for word in range(2000):
        print(word, "." * chance.randrange(800), file=chance.choice((sys.stdout, sys.stderr)))
    print("and no more", end="", flush=True)
    return designs.crank

def paints(designs):
    every = "".join(map(chr, range(160))) + "\\u2028\\u202e\\u2066\\u00fc\\u20ac"
    os.write(1, every.encode() + b"\\r\\n\\xff end\\n")
    raise type("Wrong\\a", (Exception,), {})(every + "\\udc80")
"""


class Over(Exception):
    """Exception that ends a call here."""


@pytest.fixture
def worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Worker]]:
    """Return a factory of workers, each for one of the functions; their processes are known by a variable."""
    (tmp_path / "detached.py").write_text(MODULE)
    monkeypatch.setenv("GUARDED", str(tmp_path))
    monkeypatch.delenv("PYTHONUNBUFFERED", raising=False)
    yield lambda name, limit=1e5: Worker(f"detached:{name}", [str(tmp_path)], limit)
    for process in guarded(tmp_path):
        process.kill()


def guarded(folder: Path) -> list[psutil.Process]:
    """Return the processes that run and descend from a function's in a folder, wherever they are now."""
    found = []
    for process in psutil.process_iter():
        try:
            if process.environ().get("GUARDED") == str(folder) and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
        except psutil.Error:
            continue
    return found


def none_left(folder: Path) -> bool:
    """Whether all processes of a function end soon."""
    end = time.monotonic() + SOON
    while guarded(folder):
        if time.monotonic() > end:
            return False
    return True


def until(condition: Callable[[], object]) -> None:
    """Wait until something is so."""
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_nothing_that_a_function_started_is_left_at_the_end_of_its_job(
    tmp_path: Path, worker: Callable[..., Worker]
) -> None:
    asked = worker("returns")
    asked(Mechanism(), DESIGNS, None)
    assert len(guarded(tmp_path)) > 6
    asked.close()
    assert none_left(tmp_path)


def test_nothing_that_a_function_started_outlives_a_cancellation(tmp_path: Path, worker: Callable[..., Worker]) -> None:
    def end() -> None:
        if (tmp_path / "begun").exists():
            raise Over

    with interrupted_by(end, farewell=0.1), pytest.raises(Over):
        worker("stays")(Mechanism(), DESIGNS, None)
    assert none_left(tmp_path)


ENDS = {
    "ends": "it ended with code 7",
    "kills_its_group": "its process was killed",
    "is_late": "must return within 3 s",
    "closes_its_answers": "its process was killed",
}


@pytest.mark.slow
@pytest.mark.parametrize("function", ENDS)
def test_nothing_is_left_of_a_function_that_ends_or_is_refused(
    function: str, tmp_path: Path, worker: Callable[..., Worker], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(own_worker, "_ENDING", 0.5)
    begin = time.monotonic()
    with pytest.raises(Refused, match=ENDS[function]):
        worker(function, 3.0 if function == "is_late" else 1e5)(Mechanism(), DESIGNS, None)
    assert (tmp_path / "begun").exists()
    assert time.monotonic() - begin < 30.0  # nobody waits for processes that hold the pipe of the answers
    assert none_left(tmp_path)


ASKING = """
import os, pathlib, signal, sys, threading, time
import numpy as np
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.own.function_process_client import Worker
from slidercrank.service.workers.heartbeat import end_process_tree

def leave_in_the_middle():
    while not pathlib.Path(sys.argv[1], "begun").exists():
        time.sleep(0.01)
    end_process_tree(3)

signal.signal(signal.SIGINT, signal.default_int_handler)  # these tests may run where it is ignored
os.environ["GUARDED"] = sys.argv[1]
if sys.argv[2] == "leaves":
    threading.Thread(target=leave_in_the_middle).start()
Worker("detached:stays", [sys.argv[1]], 1e5)(Mechanism(), np.array([[0.03, 0.1, 0.01]]), None)
"""


@pytest.mark.slow
@pytest.mark.parametrize("end", ["SIGINT", "SIGTERM", "SIGKILL", "leaves"])
def test_nothing_that_a_function_started_outlives_the_process_that_asks(
    end: str, tmp_path: Path, worker: Callable[..., Worker], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("GUARDED")
    command = [sys.executable, "-c", ASKING, str(tmp_path), end]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as asking:
        try:
            until((tmp_path / "begun").exists)
            if end != "leaves":
                asking.send_signal(signal.Signals[end])
            assert asking.wait(30.0) == (3 if end == "leaves" else -signal.Signals[end])
        finally:
            asking.kill()
    assert none_left(tmp_path)


def test_a_function_ends_with_its_guard_and_a_suspended_guard_ends_with_its_job(
    tmp_path: Path, worker: Callable[..., Worker]
) -> None:
    asked = worker("number")
    for end in (signal.SIGKILL, signal.SIGSTOP):
        function = int(asked(Mechanism(), DESIGNS, None).values[0, 0])
        (its_guard,) = (process for process in guarded(tmp_path) if process.pid != function)
        its_guard.send_signal(end)
        if end == signal.SIGSTOP:
            asked.close()
        assert none_left(tmp_path)
        asked.close()


@pytest.mark.slow
@pytest.mark.parametrize("closed", ["<&-", "2>&-", "<&- >&- 2>&-"])
def test_a_process_without_standard_files_may_ask(closed: str, tmp_path: Path, worker: Callable[..., Worker]) -> None:
    worker("number")
    script = ASKING.replace("detached:stays", "detached:speaks") + "sys.exit(5)\n"
    command = ["sh", "-c", f'exec "$0" "$@" {closed}', sys.executable, "-c", script, str(tmp_path), ""]
    assert subprocess.run(command, timeout=60.0).returncode == 5
    assert none_left(tmp_path)


def test_what_a_function_prints_is_passed_on_up_to_a_bound(
    worker: Callable[..., Worker], capfd: pytest.CaptureFixture[str]
) -> None:
    asked = worker("floods")
    asked(Mechanism(), DESIGNS, None)
    asked.close()
    printed, note = capfd.readouterr().err.split("\n", 1)
    assert printed == "x" * guard_process.PRINTED
    assert note == "A custom function printed more than 1 MB; the rest is left out; print less.\n"


def test_what_a_function_prints_or_raises_has_no_control_characters(
    worker: Callable[..., Worker], capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(Refused, match=r"^must not raise; got Wrong\\x07: \\x00.* \(detached.py:\d+\)") as refused:
        worker("paints")(Mechanism(), DESIGNS, None)
    printed = capfd.readouterr().err
    assert printed.endswith("\u00fc\u20ac\n\\xff end\n")
    assert "\u00fc\u20ac\\udc80 (" in str(refused.value)
    for text, kept in ((str(refused.value), ""), (printed, "\t\n")):
        categories = {unicodedata.category(letter) for letter in text if letter not in kept}
        assert not categories & {"Cc", "Cf", "Cs", "Zl", "Zp"}
        for code in {*range(32), *range(127, 160), 0x2028, 0x202E, 0x2066} - set(map(ord, kept)):
            assert ascii(chr(code))[1:-1] in text


def test_a_printed_line_comes_at_once(worker: Callable[..., Worker], capfd: pytest.CaptureFixture[str]) -> None:
    worker("speaks")(Mechanism(), DESIGNS, None)
    others = iter(lambda: capfd.readouterr().err, "here 1.5\n")
    until(lambda: next(others, None) is None)


def test_what_is_below_the_bound_is_passed_on_with_an_end_of_its_last_line(
    worker: Callable[..., Worker], capfd: pytest.CaptureFixture[str]
) -> None:
    chance = random.Random(1)
    expected = ""
    for word in range(2000):
        expected += f"{word} {'.' * chance.randrange(800)}\n"
        chance.choice("ab")
    asked = worker("babbles")
    asked(Mechanism(), DESIGNS, None)
    asked.close()
    assert len(expected) < guard_process.PRINTED
    assert capfd.readouterr().err == f"{expected}and no more\n"
