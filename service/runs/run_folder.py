"""Writing of a run: its folder is complete or marked unfinished, whenever the machine stops.

    runs/20260131-142501-feeder/
        job.toml        the job, byte for byte (job.json if it was JSON), and the files beside it that it names
        front.csv       every design with all its quantities, full precision
        front.json      the same with how it was found: what `slidercrank optimise --json` prints
        figures/        PNG files
        versions.json   versions of this software and of the libraries that computed the numbers
        log.txt         what happened when
        UNFINISHED      only until everything else is on the disk

The folder appears under its name with UNFINISHED already in it; removing that file is the last step.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
import time
import traceback
import unicodedata
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType

from ...model.errors import InputError, MissingExtra, RunError
from ...model.file_name_encoding import path_from_text, path_text
from ..resources.disk import free_space_text, is_disk_full
from .result import Result, csv_text, json_text

MARK = "UNFINISHED"
DEFAULT_PLACE = "runs"
PLACE_VARIABLE = "SLIDERCRANK_RUNS"


def runs_folder(option: Path | None) -> Path:
    """Return the folder of runs: the option, or SLIDERCRANK_RUNS, or ./runs."""
    return option or Path(os.environ.get(PLACE_VARIABLE) or DEFAULT_PLACE)


def slug(name: str) -> str:
    """Convert a name to lower-case letters, digits and hyphens, for a folder."""
    spelt = name.replace("ß", "ss").replace("ẞ", "SS")  # ß has no decomposition
    plain = unicodedata.normalize("NFKD", spelt).encode("ascii", "ignore").decode()
    return re.sub(r"[^a-z0-9]+", "-", plain.lower()).strip("-")[:40].rstrip("-") or "run"


def run_name(name: str) -> str:
    """Return the folder name for a run that starts now: the time, then the job name."""
    return f"{time.strftime('%Y%m%d-%H%M%S')}-{slug(name)}"


class RunFolder:
    """Run that is being written. Every method raises `RunError` if the disk cannot be written.

    As a context manager it records the outcome of the run. Exit without an error finishes it. An `InputError` or a
    `MissingExtra` before there is a result removes the folder, since nothing was done. Any other error leaves the run
    unfinished, with the reason in log.txt, and adds the location of the log to the error as a note. A resumed run keeps
    its
    files: nothing changes before `resume`, and after an error the result of a cancelled run stays readable.
    """

    def __init__(self, place: Path, name: str) -> None:
        """Create the folder in `place`, named by time and job name; unique even among runs of the same second."""
        self.started = time.strftime("%Y-%m-%d %H:%M:%S")
        with translate_disk_errors(place):
            place.mkdir(mode=0o700, parents=True, exist_ok=True)
            # Prepared under a hidden name, then renamed, so that the folder never appears without its mark.
            hidden = place / f".new-{os.getpid()}-{secrets.token_hex(4)}"
            hidden.mkdir(mode=0o700)  # its log contains the command line
            try:
                _write_atomically(hidden / MARK, f"Started {self.started}. The run continues, or was interrupted.\n")
                self.path = _rename_hidden(hidden, place / run_name(name))
            except BaseException:
                shutil.rmtree(hidden, ignore_errors=True)
                raise
        self._has_result = self._was_complete = self._is_as_before = False
        self._lock = _lock_folder(self.path)
        self.log(f"run {self.path.name} started")

    @classmethod
    def reopen(cls, path: Path) -> RunFolder:
        """Open the folder of an interrupted or cancelled run to continue it; it stays unchanged until `resume`.

        Raises `InputError` while another process uses it.
        """
        run = cls.__new__(cls)
        run.started = time.strftime("%Y-%m-%d %H:%M:%S")
        run.path = path
        with translate_disk_errors(path):
            run._lock = _lock_folder(path)
            run._was_complete, run._has_result = not (path / MARK).exists(), True
        run._is_as_before = True
        return run

    def resume(self) -> None:
        """Mark an interrupted or cancelled run as unfinished again."""
        self._is_as_before = False
        with translate_disk_errors(self.path):
            _write_atomically(self.path / MARK, f"Resumed {self.started}. The run continues, or was interrupted.\n")
        self.log(f"run {self.path.name} continues")

    @property
    def figures(self) -> Path:
        """Folder with the figures."""
        return self.path / "figures"

    def log(self, line: str) -> None:
        """Add a line to log.txt."""
        with translate_disk_errors(self.path), (self.path / "log.txt").open("a", encoding="utf-8") as file:
            file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')}  {path_text(line)}\n")

    def rename(self, name: str) -> None:
        """Rename the folder. Raises `RunError` if the name is taken."""
        if name != self.path.name:
            with translate_disk_errors(self.path.parent):
                self.path = self.path.rename(self.path.with_name(name))

    def keep_files(self, files: Mapping[str, bytes]) -> None:
        """Write files under their names, which may include subfolders but must stay inside this folder."""
        for name, content in files.items():
            target = self.path / path_from_text(name)
            if not target.resolve().is_relative_to(self.path.resolve()):
                raise RunError(f"the files of a run must be in its folder; got {name!r}; choose another name")
            with translate_disk_errors(self.path):
                target.parent.mkdir(parents=True, exist_ok=True)
                _write_atomically(target, content)

    def keep_result(self, result: Result, versions: dict[str, str]) -> None:
        """Write front.csv, front.json and versions.json."""
        self._has_result, self._was_complete = True, False
        with translate_disk_errors(self.path):
            _write_atomically(self.path / "versions.json", json_text(versions))
            _write_atomically(self.path / "front.csv", csv_text(result.designs))
            _write_atomically(self.path / "front.json", json_text(result.record()))

    def finish(self) -> None:
        """Flush everything to disk, then remove the mark."""
        self.log("run finished")
        with translate_disk_errors(self.path):
            for folder in (self.figures, self.path):
                for file in sorted(folder.glob("*")):
                    flush_to_disk(file)
            (self.path / MARK).unlink(missing_ok=True)
            flush_to_disk(self.path)
        self._release_lock()

    def _release_lock(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def __enter__(self) -> RunFolder:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None and not self._is_as_before:
            self.finish()
        elif isinstance(error, (InputError, MissingExtra)) and not self._has_result:
            shutil.rmtree(self.path, ignore_errors=True)
        elif error is not None and not self._is_as_before:
            with contextlib.suppress(RunError, OSError):  # the pending error matters more
                self._record_failure(error)
        self._release_lock()

    def _record_failure(self, error: BaseException) -> None:
        """Log an error. The run is unfinished, unless it was cancelled before and still has that result."""
        reason = str(error) or "interrupted"
        if isinstance(error, InputError):
            self.log(f"stopped: {reason}")
        else:
            self.log("".join(traceback.format_exception(error)).rstrip())
            error.add_note(f"log: {self.path / 'log.txt'}")
        if self._was_complete:
            (self.path / MARK).unlink(missing_ok=True)
        else:
            _write_atomically(self.path / MARK, f"Started {self.started}, stopped by an error: {reason}\n")


def write_file(path: Path, content: str | bytes) -> None:
    """Write a file completely or not at all.

    A pipe or device receives the content directly, a link stays a link, and an existing file keeps its permissions.
    Raises `RunError` if the disk cannot be written, `InputError` for a folder.
    """
    if path.is_dir():
        raise InputError(f"an output must be a file; got the folder {path}; name a file in it")
    with translate_disk_errors(path.parent):
        if path.exists() and not path.is_file():
            with path.open("wb") as stream:
                stream.write(_bytes_of(content))
        else:
            _write_atomically(path.resolve(), content)


def _lock_folder(folder: Path) -> int | None:
    """Return a handle that locks the folder against other processes while it is open; None if locks are not supported.

    The lock ends with the process, however it ends. Raises `InputError` if another process holds it.
    """
    if os.name == "nt":
        return None
    import fcntl

    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(handle)
        raise InputError(
            f"only one process may use a run at a time; another one is using {folder}; wait for it, or stop it"
        ) from None
    except OSError:  # some network disks have no locks
        os.close(handle)
        return None
    return handle


def _rename_hidden(hidden: Path, target: Path) -> Path:
    for number in range(1, 10_000):
        path = target if number == 1 else target.with_name(f"{target.name}-{number}")
        try:
            if not path.exists():  # needed on Windows; elsewhere the rename itself fails for a folder with files
                hidden.rename(path)
                return path
        except OSError:
            if not path.exists():
                raise
    raise RunError(f"no free name for a run in {target.parent}; move old runs away")


def _bytes_of(content: str | bytes) -> bytes:
    return content.encode(errors="surrogateescape") if isinstance(content, str) else content  # of paths


def _write_atomically(path: Path, content: str | bytes) -> None:
    """Write a file under another name, flush it to disk, then rename it."""
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with draft.open("wb") as file:
            file.write(_bytes_of(content))
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            shutil.copymode(path, draft)
        draft.replace(path)
    except OSError:
        draft.unlink(missing_ok=True)
        raise


def flush_to_disk(path: Path) -> None:
    """Flush a file, or a folder's directory entry, to disk."""
    if os.name == "nt":  # on Windows a read-only handle cannot be flushed, and a folder cannot be opened
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextlib.contextmanager
def translate_disk_errors(place: Path) -> Iterator[None]:
    """Turn a disk error into a `RunError` that names the location, and its free space if it is full."""
    try:
        yield
    except OSError as error:
        if is_disk_full(error):
            raise RunError(
                f"Disk full: {free_space_text(place)}; free some space, or choose another folder for runs"
            ) from error
        reason = error.strerror or str(error)
        remedy = "create the folder" if isinstance(error, FileNotFoundError) else "free it or change its permissions"
        raise RunError(
            f"{place} must be a writable folder; got: {reason}; {remedy}, or choose another folder"
        ) from error
