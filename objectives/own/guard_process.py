"""Guard of a custom function process: its parent, which ends all that the function starts and bounds what it prints.

The guard ends everything when the function's process ends, on SIGTERM, and when the calling process has ended for any
reason. It forks the function's process before any large import, so it need not start another program.

On Linux, a process whose parent has ended becomes a child of the guard, so neither `setsid` nor a double fork escapes.
On other systems with forks, the group of the function's process is ended. On Windows there is no guard.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

from .printable import printable

PRINTED = 1_000_000
"""Bytes that a function and all that it starts may print."""
_LEFT_OUT = f"\nA custom function printed more than {PRINTED // 10**6} MB; the rest is left out; print less.\n"
_DEATH_SIGNAL, _SUBREAPER = 1, 36  # PR_SET_PDEATHSIG and PR_SET_CHILD_SUBREAPER of <linux/prctl.h>
_PAUSE, _LONGEST_PAUSE = 0.001, 0.1  # s between two searches for processes that are left: first, and at most
_LOOK = 0.1  # s between two looks at the process that asks; the end of a pipe would wait for its forks, too
_FLUSH = 1.0  # s for the last output, if nobody reads standard error


def main() -> None:
    """Run the process of a function, behind a guard where processes can fork."""
    asking, log = sys.argv[1:]
    del sys.argv[1:]  # modules of the user may read it
    if hasattr(os, "fork"):
        _fork_function_process(int(asking), log)
    from .child import main as run_function

    run_function()


def _fork_function_process(asking: int, log: str) -> None:
    """Fork the function's process and return only in it; the other process is the guard, and ends with it.

    asking: number of the calling process. log: crash log, which nobody reads once that process has ended.
    """
    signals = {signal.SIGCHLD, signal.SIGTERM, signal.SIGHUP}
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for who asked
    signal.signal(signal.SIGCHLD, lambda *_: None)  # macOS drops a signal without a handler, even one waited for
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    _set_process_attribute(_SUBREAPER, 1)
    printed, output = os.pipe()
    function = os.fork()
    if not function:
        _set_process_attribute(_DEATH_SIGNAL, signal.SIGKILL)
        os.dup2(output, 2)
        for pipe in {printed, output} - {2}:  # nobody may have had a standard error
            os.close(pipe)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        return
    os.setpgid(function, function)  # a function that kills its own group leaves the guard alive
    for pipe in (0, 1, output):  # requests and answers are the function's
        os.close(pipe)
    threading.Thread(target=_end_with, args=(asking,), daemon=True).start()
    relay = threading.Thread(target=_relay_output, args=(printed,), daemon=True)
    relay.start()
    family = _Family(function)
    while family.code is None and signal.sigwait(signals) == signal.SIGCHLD:
        family.reap()
    if family.code is None:
        Path(log).unlink(missing_ok=True)
    family.end()
    relay.join(_FLUSH)
    os._exit(family.code or 0)


class _Family:
    """Process of a function and all its descendants.

    code: its exit code, 128 + N after signal N as in shells; None while it runs.
    """

    def __init__(self, function: int) -> None:
        """Take the number of the function's process, which leads its group."""
        self.function = function
        self.code: int | None = None

    def reap(self) -> bool:
        """Record children that have ended, and return whether others are left."""
        with contextlib.suppress(ChildProcessError):
            while (ended := os.waitpid(-1, os.WNOHANG))[0]:
                if ended[0] == self.function:
                    code = os.waitstatus_to_exitcode(ended[1])
                    self.code = 128 - code if code < 0 else code
            return True
        return False

    def end(self) -> None:
        """Kill all of them until none is left; meanwhile some fork, and orphans become children."""
        with contextlib.suppress(OSError):
            os.killpg(self.function, signal.SIGKILL)  # a whole group at one moment, forks under way included
        pause = _PAUSE
        while self.reap():
            for process in _descendants(os.getpid()):
                with contextlib.suppress(OSError):
                    os.kill(process, signal.SIGKILL)
            time.sleep(pause)
            pause = min(2.0 * pause, _LONGEST_PAUSE)


def _descendants(process: int) -> Iterator[int]:
    """Yield the processes that descend from another one, each once its children are listed (Linux)."""
    waiting = [process]
    while waiting:
        parent = waiting.pop()
        with contextlib.suppress(OSError):  # it has ended
            for task in Path(f"/proc/{parent}/task").iterdir():
                waiting += map(int, (task / "children").read_text().split())
        if parent != process:
            yield parent


def _end_with(asking: int) -> None:
    while os.getppid() == asking:
        time.sleep(_LOOK)
    os.kill(os.getpid(), signal.SIGTERM)


def _relay_output(printed: int) -> None:
    """Forward whole printable lines, up to `PRINTED`; read the rest too, so that no writer blocks on a full pipe.

    The last line gets a line end even if the function writes none: others write to the same log.
    """
    left, unfinished = PRINTED, b""
    while piece := os.read(printed, 1 << 16):
        if left < 0:
            continue
        rest = _LEFT_OUT.encode() if len(piece) > left else b""
        lines, end, unfinished = (unfinished + piece[:left] + rest).rpartition(b"\n")
        _write(lines + end)
        left -= len(piece)
    if unfinished:
        _write(unfinished + b"\n")


def _write(text: bytes) -> None:
    printable_text = printable(text.decode(errors="backslashreplace").replace("\r\n", "\n"), allowed="\n\t")
    with contextlib.suppress(OSError):  # standard error is closed
        os.write(2, printable_text.encode())


def _set_process_attribute(attribute: int, value: int) -> None:
    """Set an attribute of this process (Linux)."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(attribute, value)
