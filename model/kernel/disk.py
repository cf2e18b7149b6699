"""Machine code of kernels on disk; what is missing there is compiled, all at once and side by side."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from .closure import digest
from .folder import kernel_folder
from .machine_code import MachineCode

_log = logging.getLogger(__name__)

MODEL = __name__.split(".kernel.")[0]
_PATIENCE = 300.0  # s; who compiles for longer is stopped, or gone wrong
_TICK = 0.05  # s
_TELL = 3.0  # s
_STATES = 8
"""Machine codes kept of a kernel, the latest ones: of other formulas, versions and processors."""


class Wanted(NamedTuple):
    """A kernel's variant: its name, its function, and example arguments that decide about their types."""

    name: str
    function: Callable[..., Any]
    examples: tuple[Any, ...]

    @property
    def module(self) -> str:
        """Name of the function's module."""
        return self.function.__module__

    def file(self, folder: Path) -> Path:
        """Return where its machine code is kept."""
        return folder / f"{self.name}.{digest(self.function, self.examples)}"

    def compile(self) -> MachineCode:
        """Return its machine code, compiled here and now."""
        from .compiler import compile_kernel

        return compile_kernel(self.function, self.examples)


def machine_code(wanted: Wanted) -> MachineCode:
    """Return the machine code of a variant; all that is missing beside it is compiled too, and kept."""
    folder = kernel_folder()
    if folder is None:
        return wanted.compile()
    file = wanted.file(folder)
    found = read(file)
    if found is None:
        build(folder, MODEL if wanted.module.startswith(f"{MODEL}.") else wanted.module, file)
        found = read(file)
    if found is None:  # no process could be started, or nothing be kept
        found = wanted.compile()
        keep(file, found)
    return found


def read(file: Path) -> MachineCode | None:
    """Return what is kept, None where there is nothing whole."""
    try:
        head, code = file.read_bytes().split(b"\n", 1)
        kept = json.loads(head)
        if kept["sha256"] == sha256(code).hexdigest():
            return MachineCode(kept["symbol"], tuple(kept["arguments"]), tuple(kept["calls"]), code)
    except (OSError, ValueError, KeyError):
        pass
    return None


def keep(file: Path, found: MachineCode) -> None:
    """Keep machine code, if there is room, and of earlier ones the last few."""
    head = found._asdict() | {"code": None, "sha256": sha256(found.code).hexdigest()}
    unfinished = file.with_name(f"{uuid.uuid4().hex}.unfinished")
    with contextlib.suppress(OSError):
        try:
            unfinished.write_bytes(json.dumps(head).encode() + b"\n" + found.code)
            unfinished.replace(file)
        finally:
            unfinished.unlink(missing_ok=True)
        earlier = sorted(file.parent.glob(f"{file.stem}.*"), key=lambda other: other.stat().st_mtime)
        for other in earlier[:-_STATES]:
            other.unlink(missing_ok=True)


def build(folder: Path, package: str, file: Path) -> None:
    """Compile what is missing of a package's kernels, on all processors; another process at it is waited for."""
    with locked(folder / "building", wait=True) as alone:
        if read(file) is not None or not sys.executable:
            return
        _log.warning("slidercrank compiles its formulas, once after installation")
        count = (os.cpu_count() or 1) if alone else 1
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "NUMBA_DISABLE_JIT": "0"}
        command = [sys.executable, "-m", f"{MODEL}.kernel.compile_all", str(folder), package]
        reading, writing = os.pipe()
        started: list[subprocess.Popen[bytes]] = []
        try:
            with contextlib.suppress(OSError):
                started += (subprocess.Popen(command, stdout=writing, env=environment) for _ in range(count))
            os.close(writing)
            _tell(reading)
        finally:
            for process in started:
                process.terminate()
                process.wait()


def _tell(reading: int) -> None:
    """Tell of what the compiling processes say, until all of them have ended."""
    told = time.monotonic()
    done = 0
    with open(reading) as lines:
        for line in lines:
            done += 1
            name, left = line.split()
            if time.monotonic() - told > _TELL:
                told = time.monotonic()
                _log.warning(f"slidercrank compiles its formulas: {done} of {left} done, the last one {name}")


@contextlib.contextmanager
def locked(file: Path, *, wait: bool) -> Iterator[bool]:
    """Hold a lock while others do not; give whether it is held. Not held: taken, or no locks here."""
    try:
        import fcntl

        lock = os.open(file, os.O_CREAT | os.O_RDWR, 0o600)
    except (ImportError, OSError):
        yield False
        return
    try:
        held, end = False, time.monotonic() + (_PATIENCE if wait else 0.0)
        while not held:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                held = True
            except BlockingIOError:
                if time.monotonic() >= end:
                    break
                time.sleep(_TICK)
        yield held
    finally:
        os.close(lock)
