"""The other end of `child`: starting the process, asking it, and saying what became of it."""

from __future__ import annotations

import contextlib
import os
import pickle
import re
import subprocess
import sys
import tempfile
import threading
import weakref
from pathlib import Path
from typing import Any

import numpy as np

from ...model.mechanism import Mechanism
from .apply import Answer, Array, Refused
from .child import HEAD, unpacked

_START = 600.0  # s, for importing this software or compiling a kernel on a busy machine; neither counts in the limit
_GRACE = 10.0  # s beyond the limit after which the process is ended from here
_FRAME = re.compile(r'File "([^"]+)", line (\d+)')


class Worker:
    """A process that runs one function. Raises `Refused` for all that it does wrong, and is then over."""

    def __init__(self, function: str, folders: list[str], limit: float) -> None:
        """Take "module:function", the folders where its module may lie, and the time limit of a call, s."""
        self.function, self.folders, self.limit = function, folders, limit
        self._process: subprocess.Popen[bytes] | None = None
        self._mechanism: Mechanism | None = None
        self._lock = threading.Lock()

    def __call__(self, mechanism: Mechanism, dimensions: Array, column: int | None) -> Answer:
        """Return the function's answer for designs (n, 3); see `apply`."""
        with self._lock:
            if self._process is not None and self._owner != os.getpid():
                self._forget()
            if self._process is None:
                self._start()
            machine = None if mechanism is self._mechanism else mechanism
            self._send((machine, np.ascontiguousarray(dimensions, np.float64).tobytes(), column))
            self._mechanism = mechanism
            return unpacked(self._answer(self.limit))

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._end()

    def _start(self) -> None:
        # Only a name: the child opens it, and what it says of a crash is read here.
        handle, self._log = tempfile.mkstemp(prefix="slidercrank-", suffix=".log")
        os.close(handle)
        command = [sys.executable, "-P", "-c", "from slidercrank.objectives.own.child import main; main()"]
        self._process, self._owner = (
            subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE),
            os.getpid(),
        )
        self._end = weakref.finalize(self, _end, self._process, self._log)
        self._send((self._log, self.limit, self.function, self.folders))
        self._answer(_START + self.limit)

    def _forget(self) -> None:
        """Leave the process to the one that started it, of which this one is a fork."""
        assert self._process is not None
        self._end.detach()
        self._process.returncode = 0  # not a child of this process: nothing to wait for
        self._process = self._mechanism = None

    def _send(self, request: tuple[Any, ...]) -> None:
        assert self._process is not None
        assert self._process.stdin is not None
        with contextlib.suppress(OSError):  # it ended; `_answer` says why
            pickle.dump(request, self._process.stdin)
            self._process.stdin.flush()

    def _answer(self, limit: float) -> bytes:
        assert self._process is not None
        assert self._process.stdout is not None
        # The child watches its time itself; this is for a child that cannot.
        timer = threading.Timer(limit + _GRACE, self._process.kill)
        timer.daemon = True
        timer.start()
        try:
            head = self._process.stdout.read(HEAD.size)
            kind, length = HEAD.unpack(head) if len(head) == HEAD.size else (b"", 0)
            content = self._process.stdout.read(length)
        finally:
            timer.cancel()
        if kind == b"W":
            return self._answer(_START + self.limit)
        if not kind or len(content) < length:
            self._refuse(self._fate())
        if kind == b"E":
            self._refuse(content.decode())
        return content

    def _refuse(self, reason: str) -> None:
        self.close()
        self._process = None
        raise Refused(reason)

    def _fate(self) -> str:
        """Return why the process ended."""
        assert self._process is not None
        code = self._process.wait()
        text = Path(self._log).read_text(encoding="utf-8", errors="replace")
        frames = [(Path(file), line) for file, line in _FRAME.findall(text)]
        module = self.function.partition(":")[0].rpartition(".")[2]
        own = [frame for frame in frames if frame[0].stem == module] or frames  # the last call comes first
        where = f" ({own[0][0].name}:{own[0][1]})" if own else ""
        if "Timeout (" in text or code == -9:
            return (
                f"must return within {self.limit:g} s; it still ran{where} then; correct it, or raise the limit if it "
                "is only slow"
            )
        return f"must return, not end the process; it ended with code {code}{where}; correct the function"


def _end(process: subprocess.Popen[bytes], log: str) -> None:
    for stream in (process.stdin, process.stdout):
        if stream is not None:
            with contextlib.suppress(OSError):  # what was not sent yet has nobody to read it
                stream.close()
    process.kill()
    process.wait()
    Path(log).unlink(missing_ok=True)
