"""Finding runs by name, and refusing those that cannot be trusted."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from slidercrank.model.errors import InputError, RunError
from slidercrank.service.jobs.stores import find_run
from slidercrank.service.runs.result import result_of
from slidercrank.service.runs.run_folder import MARK
from slidercrank.service.runs.runs_on_disk import read_run
from tests.service import fronts

NAMES = ("20260101-100000-sieve", "20260101-100000-sieve-2", "20260102-090000-feeder", "20260102-090001-feeder")


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """Return a place with four runs and things that are none."""
    place = tmp_path / "runs"
    for age, name in enumerate(NAMES):
        (place / name).mkdir(parents=True)
        (place / name / "front.json").write_text("{}")
        os.utime(place / name, (1e9 + age, 1e9 + age))
    (place / "feeder.toml").write_text("")
    (place / "20300101-000000-empty").mkdir()
    (place / ".new-1-abc").mkdir()
    (place / ".new-1-abc" / MARK).write_text("")
    return place


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("latest", NAMES[3]),
        (NAMES[0], NAMES[0]),
        (NAMES[1], NAMES[1]),
        ("20260102-090001", NAMES[3]),
        ("20260102-090000", NAMES[2]),
    ],
)
def test_a_run_is_found_by_name_and_by_the_start_of_it(text: str, name: str, place: Path) -> None:
    assert find_run(text, place) == place / name


def test_a_run_is_found_by_its_folder(place: Path) -> None:
    assert find_run(str(place / NAMES[0]), Path("elsewhere")) == place / NAMES[0]


def test_the_latest_may_be_an_unfinished_run(place: Path) -> None:
    (place / "20270101-000000-x").mkdir()
    (place / "20270101-000000-x" / MARK).write_text("Started")
    assert find_run("latest", place).name == "20270101-000000-x"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("202601", "must be unique; '202601' matches 20260101-100000-sieve, 20260101-100000-sieve-2"),
        ("2025", "there is no run '2025'.*; the latest is 20260102-090001-feeder"),
        ("", "there is no run ''"),
    ],
)
def test_a_name_that_fits_none_or_many_is_refused(text: str, words: str, place: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=words):
        find_run(text, place)


def test_a_file_is_no_run(place: Path) -> None:
    with pytest.raises(InputError, match="a run must be a folder; got the file"):
        find_run(str(place / NAMES[0] / "front.json"), place)


def test_there_may_be_no_runs_yet(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"there is no run in .* yet"):
        find_run("latest", tmp_path / "none")


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    """Return a run as files."""
    from slidercrank.service.runs.run_folder import RunFolder

    with RunFolder(tmp_path / "stored", "x") as run:
        run.keep_result(result_of(fronts.front(designs=4), str(run.path)), {})
    return run.path


def changed(stored: Path, **changes: Any) -> None:
    record = json.loads((stored / "front.json").read_text())
    (stored / "front.json").write_text(json.dumps({**record, **changes}))


def test_a_run_is_read_under_the_path_where_it_is_now(stored: Path, tmp_path: Path) -> None:
    moved = stored.rename(tmp_path / "moved")
    assert read_run(moved).run == str(moved)


def test_an_unfinished_run_says_so_although_all_files_are_there(stored: Path) -> None:
    (stored / MARK).write_text("Started 2026-01-31 10:00:00. The run continues, or was interrupted.\n")
    with pytest.raises(RunError, match=r"is unfinished: Started 2026-01-31 10:00:00.*interrupted; continue it with"):
        read_run(stored)


def test_a_folder_without_a_front_is_no_run(tmp_path: Path) -> None:
    with pytest.raises(RunError, match=r"a run must have a file front\.json"):
        read_run(tmp_path)


@pytest.mark.parametrize("name", ["front.json", "front.csv"])
@pytest.mark.parametrize("damage", ["cut", "empty", "binary", "missing"])
def test_a_damaged_file_is_refused(name: str, damage: str, stored: Path) -> None:
    file = stored / name
    content = file.read_bytes()
    if damage == "missing":
        file.unlink()
    else:
        file.write_bytes({"cut": content[: len(content) // 2], "empty": b"", "binary": b"\xff\x00" * 50}[damage])
    with pytest.raises(RunError, match=r"damaged|front\.json"):
        read_run(stored)


@pytest.mark.parametrize(
    "changes",
    [
        {"knee": 99},
        {"extremes": {"time_ratio": -1}},
        {"objectives": [{"quantity": "x"}]},
        {"objectives": None},
        {"seconds": "soon"},
        {"designs": []},
        {"extremes": []},
    ],
)
def test_a_front_that_contradicts_itself_is_refused(changes: dict[str, Any], stored: Path) -> None:
    changed(stored, **changes)
    with pytest.raises(RunError, match="damaged"):
        read_run(stored)


def test_a_changed_number_is_noticed(stored: Path) -> None:
    lines = (stored / "front.csv").read_text().splitlines()
    cells = lines[1].split(",")
    cells[0] = repr(float(cells[0]) + 1e-12)
    (stored / "front.csv").write_text("\n".join([lines[0], ",".join(cells), *lines[2:]]) + "\n")
    with pytest.raises(RunError, match=r"front\.csv and front\.json differ"):
        read_run(stored)
