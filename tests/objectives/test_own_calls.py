"""Calls of own functions that do not return: what ends them, and that nothing of them is left."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import psutil
import pytest

from slidercrank.model.kernel.batches import interrupted_by
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.own.function_process import Refused
from slidercrank.objectives.own.function_process_client import Worker

pytestmark = pytest.mark.skipif(os.name != "posix", reason="groups of processes are those of POSIX")
DESIGNS = np.array([[0.03, 0.1, 0.01]])
MODULE = """
import os, pathlib, signal, time

begun = pathlib.Path(__file__).with_name("begun")

def one(designs):
    return designs.crank[:, 0]

def slow(designs):
    time.sleep(0.3)
    return designs.crank[:, 0]

def marks(designs):
    begun.touch()
    time.sleep(0.3)
    return designs.crank[:, 0]

def holds(designs):
    begun.touch()
    7 ** 10 ** 9

def forks(designs):
    for number in (1, 2, 15):
        signal.signal(number, signal.SIG_IGN)
    os.fork()
    begun.touch()
    while True:
        pass

def place(designs):
    return 1.0 * os.getpid() + 0.0 * designs.crank[:, 0].real

def slow_place(designs):
    time.sleep(0.5)
    return place(designs)

def killed(designs):
    os.kill(os.getpid(), 9)
"""


class Over(Exception):
    """Exception that ends a call here."""


@pytest.fixture
def worker(tmp_path: Path) -> Callable[[str], Worker]:
    """Return a factory of workers, each for one of the functions."""
    (tmp_path / "loops.py").write_text(MODULE)
    return lambda name: Worker(f"loops:{name}", [str(tmp_path)], 1e5)


def functions(of: int) -> list[psutil.Process]:
    """Return the processes below another one, guards included, but for those that compile kernels."""
    found = [each for each in psutil.Process(of).children(recursive=True) if each not in EARLIER]
    return [each for each in found if not any("compile_all" in word for word in command_of(each))]


EARLIER: list[psutil.Process] = []
"""Processes that other tests of this process keep: servers, browsers, pools."""


@pytest.fixture(autouse=True)
def earlier() -> None:
    """Note what runs before a test."""
    EARLIER[:] = psutil.Process().children(recursive=True)


def command_of(process: psutil.Process) -> list[str]:
    """Return the command line of a process, empty for one that has ended."""
    try:
        return process.cmdline()
    except psutil.NoSuchProcess:
        return []


def gone(processes: list[psutil.Process], within: float = 5.0) -> bool:
    """Whether processes end in that time; one that nobody has waited for has ended."""
    end = time.monotonic() + within
    while time.monotonic() < end:
        if not any(each.is_running() and each.status() != psutil.STATUS_ZOMBIE for each in processes):
            return True
        time.sleep(0.02)
    return False


@pytest.mark.parametrize("function", ["holds", "forks"])
def test_a_call_that_does_not_return_is_ended_with_all_that_it_started(
    function: str, tmp_path: Path, worker: Callable[[str], Worker]
) -> None:
    seen: list[psutil.Process] = []

    def end() -> None:
        if (tmp_path / "begun").exists():
            seen.extend(functions(os.getpid()))
            raise Over

    with interrupted_by(end, farewell=0.2), pytest.raises(Over):
        worker(function)(Mechanism(), DESIGNS, None)
    assert len(seen) >= (2 if function == "holds" else 3)  # the function, its guard and its fork
    assert gone(seen)


def test_a_call_about_to_return_leaves_its_process_for_the_next_one(worker: Callable[[str], Worker]) -> None:
    asked = worker("slow")
    asked(Mechanism(), DESIGNS, None)
    (guard, child) = sorted(each.pid for each in functions(os.getpid()))

    def end() -> None:
        raise Over

    with interrupted_by(end), pytest.raises(Over):
        asked(Mechanism(), 2.0 * DESIGNS, None)
    assert asked(Mechanism(), 3.0 * DESIGNS, None).values == 3.0 * DESIGNS[0, 0]  # not the answer that came too late
    assert sorted(each.pid for each in functions(os.getpid())) == [guard, child]
    asked.close()
    assert functions(os.getpid()) == []


def test_a_process_that_is_killed_is_told_apart_from_one_that_takes_too_long(worker: Callable[[str], Worker]) -> None:
    with pytest.raises(Refused, match="its process was killed, perhaps for lack of memory"):
        worker("killed")(Mechanism(), DESIGNS, None)


def test_no_limit_goes_beyond_what_is_allowed(tmp_path: Path, worker: Callable[[str], Worker]) -> None:
    worker("one")
    asked = Worker("loops:holds", [str(tmp_path)], 1e9, 0.5)
    with pytest.raises(Refused, match=r"must return within 0.5 s; .* no call may take longer here; correct it"):
        asked(Mechanism(), DESIGNS, None)


def test_a_function_does_not_outlive_a_killed_process(tmp_path: Path, worker: Callable[[str], Worker]) -> None:
    worker("forks")
    code = (
        "import numpy as np\n"
        "from slidercrank.model.machine.mechanism import Mechanism\n"
        "from slidercrank.objectives.own.function_process_client import Worker\n"
        f"Worker('loops:forks', [{str(tmp_path)!r}], 1e5)(Mechanism(), np.array([[0.03, 0.1, 0.01]]), None)\n"
    )
    with subprocess.Popen([sys.executable, "-c", code]) as asking:
        end = time.monotonic() + 60.0
        while len(functions(asking.pid)) < 3:  # guard, function, and its fork
            assert time.monotonic() < end
            time.sleep(0.05)
        left = functions(asking.pid)
        asking.send_signal(signal.SIGKILL)
    assert gone(left)


FORKING = """
import gc, json, multiprocessing, os, signal, sys, threading, time, traceback
import numpy as np
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.own.function_process_client import Worker

signal.signal(signal.SIGALRM, lambda *_: os.killpg(0, signal.SIGKILL))  # a hang ends by itself, with its children
signal.alarm(60)
asked, slow = (Worker("loops:" + name, [sys.argv[1]], 1e5) for name in ("place", "slow_place"))

def place(_=None):
    return int(asked(Mechanism(), np.array([[0.03, 0.1, 0.01]]), None).values.ravel()[0])

def forked(work):
    child = os.fork()
    if not child:
        try:
            work()
        except BaseException:
            traceback.print_exc()
            sys.exit(1)
        sys.exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])

def differ():
    assert len({here, place(), place()}) == 2

here = place()
"""


def forking(folder: Path, script: str) -> subprocess.Popen[str]:
    """Start a process that asks a function, then does what a script says."""
    (folder / "loops.py").write_text(MODULE)
    command = [sys.executable, "-c", FORKING + script, str(folder)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)


FORKS = {
    "ends at once": "assert forked(lambda: None) == 0",
    "asks": "assert forked(differ) == 0",
    "forgets it": "assert forked(lambda: (globals().pop('asked'), gc.collect())) == 0",
    "closes it": "assert forked(lambda: (asked.close(), differ())) == 0",
    "as a pool": "assert here not in multiprocessing.get_context('fork').Pool(2).map(place, range(4))",
    "while a thread asks": """
asked = slow
here = place()
threading.Thread(target=place).start()
time.sleep(0.2)
assert forked(differ) == 0
""",
}
EACH = f"""
told = {{}}
for name, script in {FORKS!r}.items():
    try:
        exec(script)
        assert place() == here
    except Exception:
        told[name] = traceback.format_exc()
    else:
        told[name] = ""
print(json.dumps(told))
"""


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return the error of each case, nothing where there is none; one process forks for all of them."""
    with forking(tmp_path_factory.mktemp("forks"), EACH) as asking:
        output, errors = asking.communicate()
    assert asking.returncode == 0, errors
    found: dict[str, str] = json.loads(output)
    return found


@pytest.mark.parametrize("fork", FORKS)
def test_a_fork_has_a_process_of_its_own_and_leaves_that_of_its_parent_alone(fork: str, told: dict[str, str]) -> None:
    assert told[fork] == ""


def test_a_fork_that_lives_on_does_not_keep_the_function_of_its_parent_alive(tmp_path: Path) -> None:
    script = "other = os.fork()\nos.write(1, f'{here} {other or \"fork\"}\\n'.encode())\ntime.sleep(60)\n"
    with forking(tmp_path, script) as asking:
        assert asking.stdout is not None
        lines = sorted(asking.stdout.readline().split() for _ in range(2))
        functions_of = functions(asking.pid)
        (fork,) = (psutil.Process(int(other)) for _, other in lines if other != "fork")
        functions_of.remove(fork)
        assert [each.pid for each in functions_of if each.pid == int(lines[0][0])]
        try:
            asking.send_signal(signal.SIGKILL)
            assert gone(functions_of)
            assert fork.is_running()
        finally:
            fork.kill()


SUSPENDED = """
import sys, time
import numpy as np
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.own import function_process_client as client

def read_late(stream, length):
    content = read(stream, length)
    time.sleep(0.2)  # as on a busy machine: who asks wakes up before who listens
    return content

read, client._read_bytes, client._GRACE = client._read_bytes, read_late, 0.5
asked = client.Worker("loops:marks", [sys.argv[1]], 1.0)
for size in (1.0, 2.0, 3.0, 4.0):
    print(*asked(Mechanism(), size * np.array([[0.03, 0.1, 0.01]]), None).values.ravel(), flush=True)
"""


@pytest.mark.slow
@pytest.mark.parametrize("all_of_it", [False, True], ids=["by Ctrl-Z", "with its machine"])
def test_a_process_may_be_suspended_for_longer_than_a_call_may_take(all_of_it: bool, tmp_path: Path) -> None:
    (tmp_path / "loops.py").write_text(MODULE)
    begun = tmp_path / "begun"
    with subprocess.Popen(
        [sys.executable, "-c", SUSPENDED, str(tmp_path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as asking:
        end = time.monotonic() + 60.0
        while not begun.exists() and asking.poll() is None and time.monotonic() < end:
            time.sleep(0.01)
        suspended = [psutil.Process(asking.pid), *(functions(asking.pid) if all_of_it else [])]
        for each in suspended:
            each.suspend()
        time.sleep(3.0)
        for each in suspended:
            each.resume()
        output, errors = asking.communicate()
    assert ([float(value) for value in output.split()], errors) == (list(DESIGNS[0, 0] * np.array([1, 2, 3, 4])), "")
