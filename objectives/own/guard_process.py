"""Guard of a custom function process: its parent, which ends all that the function starts and limits output.

The guard ends everything when the function's process ends, on SIGTERM, and when the calling process ends for any
reason. It forks the function's process before any large import, so no other program has to start.

On Linux, an orphaned descendant becomes a child of the guard, so neither `setsid` nor a double fork escapes. On other
systems with fork, the process group of the function is ended. On Windows there is no guard.
"""

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

from .function_process import escape_control_characters

PRINTED = 1_000_000
"""Bytes that a function and its descendants may print."""
_LEFT_OUT = f"\nA custom function printed more than {PRINTED // 10**6} MB; the rest is left out; print less.\n"
_DEATH_SIGNAL, _SUBREAPER = 1, 36  # PR_SET_PDEATHSIG and PR_SET_CHILD_SUBREAPER of <linux/prctl.h>
_PAUSE, _LONGEST_PAUSE = 0.001, 0.1  # s between two searches for surviving processes: first and longest interval
_LOOK = 0.1  # s between two checks that the calling process lives; its forks would keep a pipe open
_FLUSH = 1.0  # s for writing the last output, if nobody reads standard error


def main() -> None:
    """Run the process of a function, behind a guard if processes can fork."""
    asking, log = sys.argv[1:]
    del sys.argv[1:]  # modules of the user may read it
    if hasattr(os, "fork"):
        _fork_function_process(int(asking), log)
    from .function_process import main as run_function

    run_function()


def _fork_function_process(asking: int, log: str) -> None:
    """Fork the function's process and return only there; the other process becomes the guard, which exits with it.

    asking: process id of the calling process. log: crash log, which nobody reads after the calling process has ended.
    """
    signals = {signal.SIGCHLD, signal.SIGTERM, signal.SIGHUP}
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the calling process
    signal.signal(signal.SIGCHLD, lambda *_: None)  # macOS drops a signal that has no handler, even one waited for
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    _set_process_attribute(_SUBREAPER, 1)
    printed, output = os.pipe()
    function = os.fork()
    if not function:
        _set_process_attribute(_DEATH_SIGNAL, signal.SIGKILL)
        os.dup2(output, 2)
        for pipe in {printed, output} - {2}:  # there may be no standard error
            os.close(pipe)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        return
    os.setpgid(function, function)  # if a function kills its own process group, the guard survives
    for pipe in (0, 1, output):  # only the function's process uses requests and results
        os.close(pipe)
    threading.Thread(target=_end_with_caller, args=(asking,), daemon=True).start()
    relay = threading.Thread(target=_relay_output, args=(printed,), daemon=True)
    relay.start()
    family = _Family(function)
    while family.code is None and signal.sigwait(signals) == signal.SIGCHLD:
        family.reap_ended_children()
    if family.code is None:
        Path(log).unlink(missing_ok=True)
    family.kill_all()
    relay.join(_FLUSH)
    os._exit(family.code or 0)


class _Family:
    """Process of a function, with all its descendants.

    code: its exit code, 128 + N after signal N as in shells; None while it runs.
    """

    def __init__(self, function: int) -> None:
        """Take the id of the function's process, which leads its group."""
        self.function = function
        self.code: int | None = None

    def reap_ended_children(self) -> bool:
        """Record children that have ended; return whether any are left."""
        with contextlib.suppress(ChildProcessError):
            while (ended := os.waitpid(-1, os.WNOHANG))[0]:
                if ended[0] == self.function:
                    code = os.waitstatus_to_exitcode(ended[1])
                    self.code = 128 - code if code < 0 else code
            return True
        return False

    def kill_all(self) -> None:
        """Kill all processes until none is left; some may fork in the meantime, and orphans become children."""
        with contextlib.suppress(OSError):
            os.killpg(self.function, signal.SIGKILL)  # a whole group at once, including forks in progress
        pause = _PAUSE
        while self.reap_ended_children():
            for process in _descendants(os.getpid()):
                with contextlib.suppress(OSError):
                    os.kill(process, signal.SIGKILL)
            time.sleep(pause)
            pause = min(2.0 * pause, _LONGEST_PAUSE)


def _descendants(process: int) -> Iterator[int]:
    """Yield the descendants of a process, each after its children are listed (Linux)."""
    waiting = [process]
    while waiting:
        parent = waiting.pop()
        with contextlib.suppress(OSError):  # it has ended
            for task in Path(f"/proc/{parent}/task").iterdir():
                waiting += map(int, (task / "children").read_text().split())
        if parent != process:
            yield parent


def _end_with_caller(caller_process: int) -> None:
    while os.getppid() == caller_process:
        time.sleep(_LOOK)
    os.kill(os.getpid(), signal.SIGTERM)


def _relay_output(printed: int) -> None:
    """Forward complete printable lines, up to `PRINTED` bytes.

    Also read the rest, so that no writer blocks on a full pipe.

    The last line ends with a newline even if the function writes none, because others write to the same log.
    """
    left, unfinished = PRINTED, b""
    while piece := os.read(printed, 1 << 16):
        if left < 0:
            continue
        rest = _LEFT_OUT.encode() if len(piece) > left else b""
        lines, end, unfinished = (unfinished + piece[:left] + rest).rpartition(b"\n")
        _write_printable(lines + end)
        left -= len(piece)
    if unfinished:
        _write_printable(unfinished + b"\n")


def _write_printable(text: bytes) -> None:
    printable_text = escape_control_characters(
        text.decode(errors="backslashreplace").replace("\r\n", "\n"), allowed="\n\t"
    )
    with contextlib.suppress(OSError):  # standard error is closed
        os.write(2, printable_text.encode())


def _set_process_attribute(attribute: int, value: int) -> None:
    """Set an attribute of this process (Linux prctl)."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(attribute, value)
