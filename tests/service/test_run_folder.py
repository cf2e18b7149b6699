"""The folder of a run: complete, or marked unfinished, at every moment."""

from __future__ import annotations

import json
import os
import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from slidercrank.model.errors import InputError, RunError
from slidercrank.service.runs import run_folder
from slidercrank.service.runs.result import Result, result_of
from slidercrank.service.runs.run_folder import MARK, RunFolder, runs_folder, slug, write_file
from slidercrank.service.runs.runs_on_disk import read_run
from tests.service import fronts


class Killed(BaseException):
    """Stands for the end of the process: nothing after it runs."""


def result(run: RunFolder) -> Result:
    return result_of(fronts.front(designs=4), str(run.path))


def write(place: Path, job: Path) -> RunFolder:
    """Write a run without the context manager, as a process that may be killed on the way."""
    run = RunFolder(place, "Feeder")
    run.keep_files({"job.toml": job.read_bytes()})
    run.keep_result(result(run), {"python": "3"})
    run.finish()
    return run


def visible(place: Path) -> list[Path]:
    return [folder for folder in place.glob("*") if not folder.name.startswith(".")]


def test_a_finished_run_has_every_part(tmp_path: Path) -> None:
    job = fronts.job_file(tmp_path)
    with RunFolder(tmp_path / "runs", "Vibrating sieve") as run:
        assert (run.path / MARK).is_file()
        run.keep_files({"job.toml": job.read_bytes()})
        run.keep_result(result(run), {"python": "3"})
    names = {file.name for file in run.path.iterdir()}
    assert names == {"job.toml", "front.csv", "front.json", "versions.json", "log.txt"}
    assert run.path.name.endswith("-vibrating-sieve")
    assert (run.path / "job.toml").read_bytes() == job.read_bytes()
    assert json.loads((run.path / "front.json").read_text()) == result(run).record()
    assert read_run(run.path).record() == result(run).record()  # what is not defined is NaN, which equals nothing


def test_runs_of_the_same_second_have_their_own_folders(tmp_path: Path) -> None:
    paths = {RunFolder(tmp_path, "same").path for _ in range(5)}
    assert len(paths) == 5
    assert set(visible(tmp_path)) == paths


@pytest.mark.parametrize("step", range(13))
def test_a_run_killed_at_any_write_is_unfinished_or_whole(
    step: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    job, place = fronts.job_file(tmp_path), tmp_path / "runs"
    left = iter(range(step))

    def counted(handle: int) -> None:
        if next(left, None) is None:
            raise Killed

    monkeypatch.setattr(os, "fsync", counted)
    try:
        write(place, job)
    except Killed:
        assert step < 12
    for folder in visible(place):
        if step >= 11:  # killed when the mark was gone already, or not at all
            assert len(read_run(folder).designs) == 4
        else:
            with pytest.raises(RunError, match="unfinished"):
                read_run(folder)


def test_a_run_killed_before_the_mark_goes_is_unfinished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def killed(self: Path, missing_ok: bool = False) -> None:
        raise Killed

    monkeypatch.setattr(Path, "unlink", killed)
    with pytest.raises(Killed):
        write(tmp_path / "runs", fronts.job_file(tmp_path))
    with pytest.raises(RunError, match="unfinished"):
        read_run(visible(tmp_path / "runs")[0])


def test_an_error_leaves_the_run_unfinished_with_its_reason_in_the_log(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError) as caught, RunFolder(tmp_path, "x") as run:
        _ = 1 / 0
    assert "ZeroDivisionError" in (run.path / "log.txt").read_text()
    assert caught.value.__notes__ == [f"log: {run.path / 'log.txt'}"]
    with pytest.raises(RunError, match="stopped by an error: division by zero"):
        read_run(run.path)


def test_wrong_input_leaves_no_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError), RunFolder(tmp_path, "x"):
        raise InputError("no")
    assert list(tmp_path.iterdir()) == []


def test_wrong_input_after_the_result_keeps_the_result(tmp_path: Path) -> None:
    run = RunFolder(tmp_path, "x")
    run.keep_result(result(run), {})
    with pytest.raises(InputError), run:
        raise InputError("no")
    assert (run.path / "front.csv").is_file()


def test_a_place_that_is_no_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "runs").write_text("a file")
    with pytest.raises(RunError, match=r"must be a writable folder; got: .*choose another folder"):
        RunFolder(tmp_path / "runs", "x")


def test_a_full_disk_is_said_and_leaves_nothing_half_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(RunError, match="Disk full"):
        RunFolder(tmp_path, "x")
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_replaced_as_a_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "front.csv"
    write_file(file, "old")
    with monkeypatch.context() as context:
        context.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(5, "Input/output error")))
        with pytest.raises(RunError, match="Input/output error"):
            write_file(file, "new")
    with pytest.raises(InputError, match="name a file in it"):
        write_file(tmp_path, "new")
    assert file.read_text() == "old"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.skipif(os.name == "nt", reason="links, pipes and permissions of Unix")
def test_a_link_stays_one_and_a_pipe_takes_what_is_written(tmp_path: Path) -> None:
    file, link, pipe = (tmp_path / name for name in ("front.csv", "link.csv", "pipe"))
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to(file)
    write_file(link, "new")
    assert link.is_symlink()
    assert (file.read_text(), stat.S_IMODE(file.stat().st_mode)) == ("new", 0o640)
    os.mkfifo(pipe)
    with ThreadPoolExecutor() as pool:
        read = pool.submit(pipe.read_text)
        write_file(pipe, "through the pipe")
        assert read.result(timeout=20.0) == "through the pipe"
    assert pipe.is_fifo()
    dangling = tmp_path / "later.csv"
    dangling.symlink_to(tmp_path / "not there yet.csv")
    write_file(dangling, "made")
    assert (tmp_path / "not there yet.csv").read_text() == "made"


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("Feeder with rod = 3.2 offset", "feeder-with-rod-3-2-offset"),
        ("Rüttelsieb Nº 5", "ruttelsieb-no-5"),
        ("Förderer größer", "forderer-grosser"),
        ("GROẞE PRESSE", "grosse-presse"),
        ("../../etc/passwd", "etc-passwd"),
        ("振動篩", "run"),
        ("x" * 80, "x" * 40),
        ("a" * 39 + " b", "a" * 39),
    ],
)
def test_a_folder_name_is_made_of_plain_letters(name: str, expected: str) -> None:
    assert slug(name) == expected


def test_the_place_is_the_option_then_the_variable_then_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(run_folder.PLACE_VARIABLE, "elsewhere")
    assert runs_folder(Path("here")) == Path("here")
    assert runs_folder(None) == Path("elsewhere")
    monkeypatch.setenv(run_folder.PLACE_VARIABLE, "")
    assert runs_folder(None) == Path("runs")
