"""Short versions of the benchmarks of the service: what they count, not what they time."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from benchmarks.report import Row
from benchmarks.service_load import load
from benchmarks.store_scale import measure


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="workers of the benchmark are stopped by signals of POSIX systems")
def test_clients_at_once_see_no_errors_and_miss_no_events(tmp_path: Path) -> None:
    address = str(tmp_path / "store.db")
    rows = load(address, tmp_path, seconds=2.0, clients=10, keyed=20, small=5, workers=1)
    counted = {row.what: row for row in rows if not {"ms", "percentile"} & set(row.what.replace(",", "").split())}
    assert [what for what, row in counted.items() if row.kept() is False] == []
    assert only_row_with(rows, "jobs made by").figures == [1]
    assert only_row_with(rows, "small jobs: done").figures == [5]


def test_a_store_that_was_filled_in_bulk_answers_everything(tmp_path: Path) -> None:
    rows = measure(str(tmp_path / "store.db"), runs=20, large=200, repeats=1)
    assert len(rows) > 20
    assert all(row.figures[0] > 0.0 for row in rows)


def only_row_with(rows: list[Row], words: str) -> Row:
    (found,) = (row for row in rows if words in row.what)
    return found
