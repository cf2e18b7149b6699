"""Machine code of kernels on disk; missing kernels are compiled together, in parallel."""

from __future__ import annotations

import atexit
import contextlib
import json
import logging
import os
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from hashlib import sha256
from pathlib import Path
from threading import Thread
from typing import Any, NamedTuple

from .batches import poll_interruption
from .kernel_digest import kernel_digest, kernel_folder, log_refused_folders, read_only_folders
from .machine_code import MachineCode

_log = logging.getLogger(__name__)

MODEL = __name__.split(".kernel.")[0]
INTO = "--into"
"""Option for the compiling processes, placed before their folder."""
_PATIENCE = 300.0  # s; a process that compiles for longer has stopped or failed
_TICK = 0.05  # s
_REPORT_INTERVAL = 3.0  # s
_LINE = 120
"""Characters of a progress line in a notebook; blanks erase the end of a longer one before it."""
_SIDE_BY_SIDE = 4
"""Maximum number of compiling processes; each takes 200 MB."""
_STATES = 8
"""Number of recent machine codes stored per kernel, for other formulas, versions and processors."""


class KernelSource(NamedTuple):
    """A kernel to compile: its name, its function, and example arguments that determine the types."""

    name: str
    function: Callable[..., Any]
    examples: tuple[Any, ...]

    @property
    def module_name(self) -> str:
        """Name of the module that defines the function."""
        return self.function.__module__

    def machine_code_file(self, folder: Path) -> Path:
        """Return the file for its machine code."""
        return folder / f"{self.name}.{kernel_digest(self.function, self.examples)}"

    def compile(self) -> MachineCode:
        """Return its machine code, compiled in this process now."""
        from .compiler import compile_kernel

        return compile_kernel(self.function, self.examples)


def load_or_compile(source: KernelSource, modules: Iterable[str] = ()) -> MachineCode:
    """Return the machine code of a kernel, compiled and stored if necessary.

    Other processes also compile the missing kernels in its package while this process lives. They do the same for
    sister packages that contain some of `modules`, the modules of other kernels, last ones first. In both cases,
    kernels in these modules come before the rest.
    """
    folder, name = kernel_folder(), source.machine_code_file(Path()).name
    code = read_from_any_folder(name, folder)
    if code is not None:
        return code
    log_refused_folders()
    if folder is None:
        return source.compile()
    package, root = _package_of(source.module_name), source.module_name.partition(".")[0] + "."
    related = [module for module in reversed(list(modules)) if module.startswith(root)]
    packages = dict.fromkeys([*map(_package_of, related), package])
    if folder not in _refusing:
        compile_in_processes(folder, " ".join(packages), folder / name, dict.fromkeys([*related, source.module_name]))
        code = read_machine_code(folder / name)
    if code is None:  # no process could be started, or nothing could be stored
        if folder in _refusing:
            _log.warning(f"slidercrank is compiling its formulas: {source.name.rpartition('.')[2]}")
        code = source.compile()
        if not store_machine_code(folder / name, code):
            _refusing.add(folder)
    return code


def _package_of(module: str) -> str:
    return ".".join(module.split(".")[:2])


def read_from_any_folder(name: str, folder: Path | None) -> MachineCode | None:
    """Return the machine code stored under a name, in this folder or in a read-only one."""
    codes = (read_machine_code(place / name) for place in (folder, *read_only_folders()) if place is not None)
    return next((code for code in codes if code is not None), None)


def read_machine_code(file: Path) -> MachineCode | None:
    """Return the stored machine code; None if there is no complete file."""
    try:
        head, code = file.read_bytes().split(b"\n", 1)
        header = json.loads(head)
        if header["sha256"] == sha256(code).hexdigest():
            return MachineCode(header["symbol"], tuple(header["arguments"]), tuple(header["calls"]), code)
    except (OSError, ValueError, KeyError):
        pass
    return None


_refusing: set[Path] = set()
"""Folders in which storing has failed; each process then compiles only the kernels that it needs."""


def store_machine_code(file: Path, code: MachineCode) -> bool:
    """Store machine code, keep a few earlier versions, and return whether it was stored.

    Logs a message if the disk is full.
    """
    head = code._asdict() | {"code": None, "sha256": sha256(code.code).hexdigest()}
    unfinished = file.with_name(f"{uuid.uuid4().hex}.unfinished")
    is_stored = False
    with contextlib.suppress(OSError):
        try:
            unfinished.write_bytes(json.dumps(head).encode() + b"\n" + code.code)
            unfinished.replace(file)
            is_stored = True
        except OSError as error:
            _warn_not_stored(file.parent, error.strerror or str(error))
        finally:
            unfinished.unlink(missing_ok=True)
        earlier = sorted(file.parent.glob(f"{file.stem}.*"), key=lambda path: path.stat().st_mtime)
        for path in earlier[:-_STATES]:
            path.unlink(missing_ok=True)
    return is_stored


@cache
def _warn_not_stored(folder: Path, reason: str) -> None:
    _log.warning(
        f"slidercrank cannot store its compiled formulas in {folder} ({reason}) and will compile them again; free "
        "some space there"
    )


def compile_in_processes(folder: Path, packages: str, file: Path | None = None, modules: Iterable[str] = ()) -> None:
    """Let other processes compile the missing kernels in packages; return when a file exists, or when they have ended.

    packages: names separated by blanks. They compile the kernel of that file next, and those in modules before the
    others. Waits for processes that are already compiling. `poll_interruption` ends the wait.
    """
    if file is not None:
        with contextlib.suppress(OSError), (folder / "wanted").open("a") as queue:
            queue.write(f"{file.name}\n")
    start_time = last_report = time.monotonic()
    before = sum(_waits)
    _waits.append(0.0)
    workers = _ahead.pop(packages, None)
    if workers:
        _report_compilation()
    while (file is None or read_machine_code(file) is None) and time.monotonic() < start_time + _PATIENCE:
        if workers is not None and all(worker.poll() is not None for worker in workers):
            return
        if workers is None:
            with hold_lock(compilation_lock_file(folder, packages)) as lock:
                if lock is not None:
                    _report_compilation()
                    workers = _start_compilers(folder, packages, modules, lock)
        _waits[-1] = time.monotonic() - start_time
        if time.monotonic() > last_report + _REPORT_INTERVAL:
            last_report = time.monotonic()
            with contextlib.suppress(OSError):
                if far := compilation_lock_file(folder, packages).read_text():
                    report_compilation_progress(
                        f"slidercrank is compiling its formulas: {far}; {before + _waits[-1]:.0f} s so far"
                    )
        time.sleep(_TICK)
        poll_interruption()


def compile_ahead(packages: str, modules: Iterable[str]) -> None:
    """Compile the kernels in modules ahead if none is compiled yet.

    A process that needs one of them requests it and waits for it.
    """
    folder = kernel_folder() if os.environ.get("NUMBA_DISABLE_JIT", "0") == "0" else None
    begins = f"{packages.partition('.')[0]}.*.*"
    if folder is not None and not any(any(place.glob(begins)) for place in (folder, *read_only_folders())):
        with hold_lock(compilation_lock_file(folder, packages)) as lock:
            if lock is not None:
                _ahead[packages] = _start_compilers(folder, packages, modules, lock)


@cache
def _report_compilation() -> None:
    _log.warning("slidercrank is compiling its formulas (only once after installation)")


def report_compilation_progress(text: str) -> None:
    """Report the progress of compilation: in a notebook on one line that is updated, elsewhere in the log."""
    if "ipykernel" in sys.modules:
        sys.stderr.write(f"\r{text:<{_LINE}}")
        sys.stderr.flush()
    else:
        _log.warning(text)


_waits: list[float] = []
"""Times that this process has waited for kernels, s."""
_ahead: dict[str, list[subprocess.Popen[bytes]]] = {}
"""Processes that `compile_ahead` has started and nobody has waited for yet."""


def _start_compilers(folder: Path, packages: str, modules: Iterable[str], lock: int) -> list[subprocess.Popen[bytes]]:
    """Start one process per processor; they hold the lock as long as they live, and end with this process."""
    if not sys.executable:
        return []
    started: list[subprocess.Popen[bytes]] = []
    atexit.register(_end_compilers, started, os.getpid())
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "NUMBA_DISABLE_JIT": "0"}
    # numba composes messages for every formula that it tries without success.
    environment |= {"NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING": "1"}
    command = [sys.executable, "-m", f"{MODEL}.kernel.compile_all", INTO, str(folder), packages, *modules]
    options: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    options |= {"start_new_session": True, "pass_fds": [] if lock == _NO_LOCK else [lock]}
    with contextlib.suppress(OSError):
        for _ in range(1 if lock == _NO_LOCK else min(os.cpu_count() or 1, _SIDE_BY_SIDE)):
            started.append(subprocess.Popen(command, env=environment, **options))
            Thread(target=started[-1].wait, daemon=True).start()  # so that it disappears when it has ended
    return started


def compilation_lock_file(folder: Path, packages: str) -> Path:
    """Return the file that is locked while kernels in packages are compiled, and that records the progress."""
    return folder / f"{packages.replace(' ', '+')}.building"


def awaited_file_names(folder: Path) -> list[str]:
    """Return the names of the files that processes wait for, or waited for, in order."""
    try:
        return (folder / "wanted").read_text().split()
    except OSError:
        return []


_NO_LOCK = -1


def _end_compilers(started: list[subprocess.Popen[bytes]], owner: int) -> None:
    if os.getpid() == owner:  # not in a fork of the owner
        for worker in started:
            worker.terminate()
            worker.wait()


@contextlib.contextmanager
def hold_lock(file: Path) -> Iterator[int | None]:
    """Lock a file and yield its descriptor; None if another process holds the lock, -1 if locks are unavailable."""
    try:
        import fcntl

        lock = os.open(file, os.O_CREAT | os.O_RDWR, 0o600)
    except (ImportError, OSError):
        yield _NO_LOCK
        return
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield None
        else:
            yield lock
    finally:
        os.close(lock)
