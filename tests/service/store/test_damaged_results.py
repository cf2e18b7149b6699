"""A result that was damaged in the store: refused at every door in one sentence, and found by the doctor."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import select, update

from slidercrank.model.errors import RunError
from slidercrank.service.runs.result import ExactDesigns
from slidercrank.service.store import Store
from slidercrank.service.store.damage_check_and_backup import damages
from slidercrank.service.store.database import Database
from slidercrank.service.store.schema import designs, exact, jobs
from tests.service.api.serving import client_of
from tests.service.conftest import Command
from tests.service.store.contents import add, claim_waiting_job, result

PARTS = {
    "job": jobs.c.tables,
    "record": jobs.c.result,
    "summary": jobs.c.summary,
    "designs": designs.c.cells,
    "exact": exact.c.content,
}
SENTENCE = "the result of job 1 is damaged: "


@pytest.fixture
def solved(store: Store, monkeypatch: pytest.MonkeyPatch) -> Store:
    """Return a store in which two jobs are done, the first with exact designs."""
    monkeypatch.setattr("slidercrank.service.store.damage_check_and_backup._SETTINGS", ())
    slopes = (np.zeros(1), np.array([[0.5, 0.25]]))
    found = ExactDesigns(np.array([[0.1, 0.3, 0.0], [0.2, 0.4, 0.0]]), (), (slopes, slopes), (np.zeros((0, 2)),) * 2)
    for each in (replace(result(), exact=found), result()):
        add(store)
        claim_waiting_job(store).finish(each)
    return store


def change(database: Database, part: str, changed: Callable[[bytes], bytes]) -> None:
    """Change a part of the result of job 1 behind the store's back."""
    column = PARTS[part]
    number = column.table.c.id if column.table is jobs else column.table.c.job
    mine = [number == 1, *([designs.c.number == 1] if column.table is designs else [])]
    with database.writing() as connection:
        before = connection.execute(select(column).where(*mine)).scalar_one()
        content = changed(before.encode() if isinstance(before, str) else bytes(before))
        after = content.decode() if isinstance(before, str) else content
        connection.execute(update(column.table).where(*mine).values({column.name: after}))


def flip_digit(content: bytes) -> bytes:
    """Return JSON in which one bit of a digit has changed, so that it can still be read."""
    places = [at for at, byte in enumerate(content) if byte in b"23456789"]
    at = random.Random(len(content)).choice(places)
    return content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :]


def flip_bit(content: bytes) -> bytes:
    """Return bytes of which one bit has changed."""
    at = random.Random(len(content)).randrange(len(content))
    return content[:at] + bytes([content[at] ^ 4]) + content[at + 1 :]


@pytest.mark.parametrize("part", PARTS)
def test_a_damaged_result_is_refused_and_named_by_the_doctor(
    part: str, solved: Store, address: str, command: Command, tmp_path: Path
) -> None:
    assert damages(solved) == []
    change(solved, part, flip_bit if part == "exact" else flip_digit)
    with pytest.raises(RunError, match=f"{SENTENCE}.*; submit the job again"):
        solved.result(1)
    if part in ("job", "record", "summary"):
        with pytest.raises(RunError, match=SENTENCE):
            solved.result_record(1)
    assert len(solved.result(2).designs) == 2
    assert [found[: len(SENTENCE)] for found in damages(solved)] == [SENTENCE]
    with client_of(solved) as client:
        refused = client.get("/jobs/1/designs")
        assert not refused.is_success
        assert SENTENCE in refused.json()["detail"]
        assert client.get("/jobs/2/designs").is_success
    done = command("watch", 1, "--store", address)
    assert done.exit_code == 2
    assert SENTENCE in done.stderr
    looked = json.loads(command("doctor", "--json", "--store", address, "--runs", tmp_path / "runs").stdout)
    check = next(one for one in looked["checks"] if one["name"] == "integrity")
    assert check["grade"] == "problem"
    assert SENTENCE in check["text"]
    assert "restore a backup" in check["text"]


def test_a_result_without_a_checksum_is_read_as_before(solved: Store) -> None:
    with solved.writing() as connection:
        connection.execute(update(jobs).values(checksum=None))
    assert len(solved.result(1).designs) == solved.result_record(1)["count"] == 2
    assert damages(solved) == []
