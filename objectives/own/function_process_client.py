"""Caller's end of `function_process`: starts the process, sends requests, and explains how the process ended.

The process started here is a guard (see `guard_process`), the parent of the function's process. It ends when this
process ends for any reason. It then ends everything that the function started, even if the function holds the
interpreter, ignores signals or forks.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import queue
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any

import numpy as np

from ...model.arrays import Array
from ...model.kernel.batches import interruption_grace_time, poll_interruption, record_killed_call
from ...model.machine.mechanism import Mechanism
from .function_process import HEAD, FunctionResult, Refused, unpack_result

_START = 600.0  # s for importing this software or compiling a kernel on a busy machine; neither counts as call time
_GRACE = 10.0  # s beyond the limit before the process is ended from here
_TICK = 0.1  # s between two checks whether the call should end
_PAUSE = 1.0  # s that a tick takes at most on a busy machine; after a longer one, this process was suspended
_ENDING = 5.0  # s within which a process must end after closing its output
_FRAME = re.compile(r'File "([^"]+)", line (\d+)')
_PROGRAM = "from slidercrank.objectives.own.guard_process import main; main()"
_KILLED = 9, 128 + 9  # exit codes

Message = tuple[bytes, bytes]
Process = subprocess.Popen[bytes]


def is_guard_command(command: Sequence[str]) -> bool:
    """Whether a command line starts a guard, or its function's process."""
    return _PROGRAM in command


_running: weakref.WeakSet[Worker] = weakref.WeakSet()


def _leave_workers_to_parent() -> None:
    """Leave all function processes, in a fork, to the process that started them."""
    for worker in list(_running):
        worker.leave_to_starter()
    _running.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_leave_workers_to_parent)


class _Suspended(Exception):
    """The time limit of a call expired while this process, or perhaps the whole machine, was suspended."""


class Worker:
    """A process that runs one function. Raises `Refused` for any fault in the function, and is then closed.

    An exception from `poll_interruption` also ends the call and the process.
    """

    def __init__(self, function: str, folders: list[str], limit: float, longest: float = float("inf")) -> None:
        """Take "module:function", the folders that may contain the module, and the time limit of a call, s.

        longest: upper bound on the limit, s, set by whoever runs the function.
        """
        self.function, self.folders = function, folders
        self.limit, self.longest = min(limit, longest), longest
        self._process: Process | None = None
        self._mechanism: Mechanism | None = None
        self._late = self._paused = False
        self._lock = threading.Lock()

    def __call__(self, mechanism: Mechanism, dimensions: Array, column: int | None) -> FunctionResult:
        """Return the function's result for designs (n, 3); see `call_function`."""
        with self._lock:
            while True:
                with contextlib.suppress(_Suspended):
                    return self._call_process(mechanism, dimensions, column)

    def _call_process(self, mechanism: Mechanism, dimensions: Array, column: int | None) -> FunctionResult:
        self._paused = False
        if self._process is None:
            poll_interruption()
            self._start()
        machine = None if mechanism is self._mechanism else mechanism
        self._send((machine, np.ascontiguousarray(dimensions, np.float64).tobytes(), column))
        self._mechanism = mechanism
        return unpack_result(self._await_message(self.limit))

    def close(self) -> None:
        """End the process and everything that it started."""
        if self._process is not None:
            self._process = self._mechanism = None
            self._end()

    def _start(self) -> None:
        # Only a name: the child opens the file, and this process reads the crash report from it.
        handle, self._log = tempfile.mkstemp(prefix="slidercrank-", suffix=".log")
        os.close(handle)
        group: dict[str, Any] = {"process_group": 0} if os.name == "posix" else {}
        # Unbuffered: a fork would copy the buffers, and their locks as a thread holds them at that moment.
        self._process = process = subprocess.Popen(
            (sys.executable, "-P", "-c", _PROGRAM, str(os.getpid()), self._log),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
            **group,
        )
        self._late = False
        self._end = weakref.finalize(self, _end_process, process, self._log)
        _running.add(self)
        self._messages: queue.SimpleQueue[Message] = queue.SimpleQueue()
        threading.Thread(
            target=_queue_messages, args=(process.stdout, self._messages), name="own function", daemon=True
        ).start()
        self._send((self._log, self.limit, self.function, self.folders))
        self._await_message(_START + self.limit)

    def leave_to_starter(self) -> None:
        """Leave the process to its starter; this process is a fork of that one."""
        self._end.detach()  # also when this process ends
        if self._process is not None:
            for pipe in (self._process.stdin, self._process.stdout):
                if pipe is not None:
                    pipe.close()
            self._process.returncode = 0  # not a child of this process: nothing to wait for
        self._process = self._mechanism = None
        self._lock = threading.Lock()  # a thread that does not exist here may have held the other lock

    def _send(self, request: tuple[Any, ...]) -> None:
        assert self._process is not None
        assert self._process.stdin is not None
        with contextlib.suppress(OSError):  # it ended; `_await_message` says why
            left = memoryview(pickle.dumps(request))
            while left:
                left = left[self._process.stdin.write(left) :]

    def _await_message(self, limit: float) -> bytes:
        kind, content = self._next_message(limit)
        if kind == b"W":
            return self._await_message(_START + self.limit)
        if not kind:
            self._refuse(self._reason_of_end())
        if kind == b"E":
            self._refuse(content.decode())
        return content

    def _next_message(self, limit: float) -> Message:
        """Return the next message from the process; empty if it has ended, or is ended for exceeding the limit.

        An interruption ends a slow process. Time during which this process is suspended does not count.
        """
        # The child enforces its own time limit; this is for a child that cannot.
        waited, before = 0.0, time.monotonic()
        try:
            while waited <= limit + _GRACE:
                message = None
                with contextlib.suppress(queue.Empty):
                    message = self._messages.get(timeout=_TICK)
                now = time.monotonic()
                self._paused |= now - before > _PAUSE
                waited += min(now - before, _PAUSE)
                before = now
                if message is not None:
                    return message
                poll_interruption()
            self._late = True
            self._end()
            return b"", b""
        except BaseException:
            try:
                kind, _ = self._messages.get(timeout=interruption_grace_time())
            except queue.Empty:
                kind = b""
                record_killed_call()
            if kind not in (b"A", b"R"):
                self.close()
            raise

    def _refuse(self, reason: str) -> None:
        self.close()
        raise Refused(reason)

    def _reason_of_end(self) -> str:
        """Return the reason why the process ended. Raises `_Suspended` if the function is not at fault."""
        assert self._process is not None
        try:
            code: int | None = self._process.wait(_ENDING)
        except subprocess.TimeoutExpired:  # it closed its output but still runs
            self._end()
            code = self._process.poll()
        text = Path(self._log).read_text(encoding="utf-8", errors="replace") if Path(self._log).exists() else ""
        if "Timeout (" in text and self._paused:  # its timer also counts time while it is suspended
            self.close()
            raise _Suspended
        frames = [(Path(file), line) for file, line in _FRAME.findall(text)]
        module = self.function.partition(":")[0].rpartition(".")[2]
        frames_of_function = [
            frame for frame in frames if frame[0].stem == module
        ] or frames  # the most recent call comes first
        place = f" ({frames_of_function[0][0].name}:{frames_of_function[0][1]})" if frames_of_function else ""
        if "Timeout (" in text or self._late:
            raised = "correct it, or raise the limit if it is only slow"
            remedy = raised if self.limit < self.longest else "no call may take longer here; correct it"
            return f"must return within {self.limit:g} s; it was still running{place}; {remedy}"
        if code in _KILLED:
            return "must return; its process was killed, perhaps for lack of memory; let it use less"
        return f"must return, not end the process; it ended with code {code}{place}; correct the function"


def _queue_messages(stream: IO[bytes], messages: queue.SimpleQueue[Message]) -> None:
    """Put messages from a process into a queue, then an empty message at the end."""
    with stream, contextlib.suppress(OSError, ValueError):
        while len(head := _read_bytes(stream, HEAD.size)) == HEAD.size:
            kind, length = HEAD.unpack(head)
            content = _read_bytes(stream, length)
            if len(content) < length:
                break
            messages.put((kind, content))
    messages.put((b"", b""))


def _read_bytes(stream: IO[bytes], length: int) -> bytes:
    """Return `length` bytes; fewer only at the end of the stream."""
    content = bytearray()
    while len(content) < length and (chunk := stream.read(length - len(content))):
        content += chunk
    return bytes(content)


def _end_process(process: Process, log: str) -> None:
    """End a process through its guard, which may be suspended.

    Only the guard stays, with the processes that it may not kill.
    """
    process.terminate()
    if os.name == "posix":
        process.send_signal(signal.SIGCONT)
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(_ENDING)
    assert process.stdin is not None
    with contextlib.suppress(OSError):  # nobody is left to read the unsent rest
        process.stdin.close()
    Path(log).unlink(missing_ok=True)
