"""File names that the locale cannot decode or UTF-8 cannot encode, in every interface that takes a path."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from slidercrank.model.file_name_encoding import path_from_text, path_text
from slidercrank.optimise.job import load_job, needed_files
from slidercrank.service.store.address import address_without_secrets, url_of
from slidercrank.service.workers.direct_search import job_and_attached_files
from slidercrank.service.workers.worker_process import WorkerSettings
from tests.service import fronts
from tests.service.conftest import Command

LATIN = os.fsdecode(b"F\xf6rderer")  # a name in Latin-1, as old disks have them
POINTS = "crank_angle_deg,position_mm\n0,240\n90,200\n180,160\n"
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="other systems keep no such names")


def test_text_of_a_path_can_be_written_and_leads_back_to_it() -> None:
    assert path_text(os.fsdecode("Förderer".encode())) == "Förderer"
    assert path_text(LATIN) == "F\ufffdrderer"
    assert path_from_text("Förderer") == Path("Förderer")
    assert path_from_text(LATIN) == Path(LATIN)


def test_files_that_a_job_names_are_kept_under_their_names(tmp_path: Path) -> None:
    (tmp_path / "Größe.csv").write_text(POINTS, encoding="utf-8")
    job = tmp_path / "job.toml"
    job.write_text(f'{fronts.JOB}\n[target_motion]\nfile = "Größe.csv"\n', encoding="utf-8")
    assert load_job(job).own
    assert [file.name for file in job_and_attached_files(job, needed_files(job))] == ["job.toml", "Größe.csv"]


def test_a_run_in_a_folder_of_such_a_name_is_read_exported_and_reported(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = tmp_path / f"{LATIN}.toml"
    monkeypatch.setattr("sys.argv", ["slidercrank", "optimise", str(job)])  # goes into the log
    job.write_text(fronts.JOB, encoding="utf-8")
    place = tmp_path / f"L{LATIN}"
    done = command("optimise", job, "--runs", place, "--no-figures", "--json")
    assert done.exit_code == 0, done.stderr
    assert "\ufffd" in json.loads(done.stdout)["run"]
    (run,) = (path for path in place.iterdir() if path.is_dir())
    assert "\ufffd" in (run / "log.txt").read_text(encoding="utf-8")
    for arguments in (
        ("front", run),
        ("front", run, "--json"),
        ("export", run, "--csv", tmp_path / f"{LATIN}.csv"),
        ("report", run, "--knee", "--out", tmp_path / f"{LATIN}.html"),
        ("submit", job, "--store", tmp_path / f"{LATIN}.db"),
        ("jobs", "--store", tmp_path / f"{LATIN}.db"),
    ):
        done = command(*arguments)
        assert done.exit_code == 0, (arguments, done.stderr)
    done = command("check", tmp_path / LATIN)
    assert done.exit_code == 2
    assert "\ufffd" in done.stderr


def test_a_worker_process_takes_an_address_of_such_a_name(tmp_path: Path) -> None:
    given = WorkerSettings(address=str(tmp_path / f"{LATIN}.db"))
    assert WorkerSettings.from_line(given.to_line()) == given
    assert address_without_secrets(url_of(given.address)).endswith("F%EF%BF%BDrderer.db")


@pytest.mark.slow
def test_umlauts_in_a_locale_of_ascii_are_no_fault(tmp_path: Path) -> None:
    """Job, place of runs, and a file that the job names."""
    folder = tmp_path / "Schübe"
    folder.mkdir()
    (folder / "Größe.csv").write_text(POINTS, encoding="utf-8")
    job = folder / "Förderer.toml"
    job.write_text(f'{fronts.JOB}\n[target_motion]\nfile = "Größe.csv"\n', encoding="utf-8")
    environment = {**os.environ, "LC_ALL": "C", "PYTHONUTF8": "0"}
    environment.pop("PYTHONIOENCODING", None)
    command = [sys.executable, "-m", "slidercrank", "optimise", str(job), "--no-figures"]
    done = subprocess.run(
        [*command, "--json", "--runs", str(tmp_path / "Läufe")],
        env=environment,
        capture_output=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    run = Path(json.loads(done.stdout)["run"])
    assert run.parent == tmp_path / "Läufe"
    assert {"Größe.csv", "job.toml"} <= {file.name for file in run.iterdir()}
    assert "Förderer.toml" in (run / "log.txt").read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize(("utf8", "shown"), [("0", "F?rder"), ("1", "Förder")])
def test_a_letter_of_a_path_is_one_character_on_every_screen(tmp_path: Path, utf8: str, shown: str) -> None:
    """As it is for the same letter of a name; a byte that is not UTF-8 is one character too."""
    (tmp_path / "Förderer.toml").write_text(fronts.JOB.replace("Short", "Förderer"), encoding="utf-8")
    (tmp_path / f"{LATIN}.toml").write_text(fronts.JOB, encoding="utf-8")
    environment = {**os.environ, "LC_ALL": "C", "PYTHONUTF8": utf8}
    environment.pop("PYTHONIOENCODING", None)
    for arguments, words in (
        (["check", "Förderer.toml"], f"{shown}er.toml is a valid job: {shown}er"),
        (["check", "Förder.toml"], f"{shown}.toml: no such file"),
        (["check", f"{LATIN}.toml"], f"F{'?' if utf8 == '0' else chr(0xFFFD)}rderer.toml is a valid job"),
    ):
        command = [sys.executable, "-m", "slidercrank", *arguments]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, timeout=300, check=False)
        assert words in (done.stdout + done.stderr).decode(), arguments
