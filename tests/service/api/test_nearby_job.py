"""A search near a design: a copy of the job whose lengths vary around it, also outside of the job."""

from __future__ import annotations

import random
import tomllib
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.job import parse_job
from slidercrank.service.designs.derived_jobs import job_near_lengths
from slidercrank.service.store import Store
from slidercrank.service.store.bookmarks_and_wishes import bookmarks_of
from slidercrank.service.store.damage_check_and_backup import back_up
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of


@pytest.fixture
def store(solved: Solved, tmp_path: Path) -> Iterator[Store]:
    back_up(solved.store, tmp_path / "store.db")
    with Store(tmp_path / "store.db") as opened:
        yield opened


@pytest.fixture
def client(store: Store) -> Iterator[httpx.Client]:
    with client_of(store) as opened:
        yield opened


def test_the_ranges_hold_the_design_in_their_middle_and_all_else_stays() -> None:
    chance = random.Random(3)
    tables = {**tomllib.loads(fronts.JOB), "constraints": {}}
    problem = parse_job(tables)
    for _ in range(20):
        lengths = (chance.uniform(100, 200), chance.uniform(300, 900), chance.uniform(-250, 250))
        share = chance.uniform(0.02, 0.5)
        made = job_near_lengths(problem, tables, lengths, share=share)
        part = parse_job(made)
        for name, length in zip(("crank", "rod", "offset"), lengths, strict=True):
            of = getattr(part, name)
            assert 500 * (of.lower + of.upper) == pytest.approx(length, rel=1e-4, abs=1e-2)
            room = share * (max(abs(length), lengths[0]) if name == "offset" else length)
            assert 500 * (of.upper - of.lower) == pytest.approx(room, rel=1e-3)
        assert {**made, "name": "", "variables": {}} == {**tables, "name": "", "variables": {}}


def test_what_the_job_fixes_stays_fixed() -> None:
    tables = {**tomllib.loads(fronts.JOB), "constraints": {}}
    tables["variables"]["crank"] = "140 mm"
    made = job_near_lengths(parse_job(tables), tables, (120.0, 400.0, 60.0))
    assert made["variables"]["crank"] == "140 mm"
    tables["variables"] |= {"rod": "400 mm", "offset": "60 mm"}
    with pytest.raises(InputError, match="this job fixes all three"):
        job_near_lengths(parse_job(tables), tables, (120.0, 400.0, 60.0))


def test_the_copy_is_queued_and_knows_where_it_is_from(store: Store, client: httpx.Client, solved: Solved) -> None:
    lengths = {"crank_mm": 138.0, "rod_mm": 650.0, "offset_mm": 60.0}
    made = client.post(f"{solved.path}/nearby", json=lengths)
    assert made.status_code == 201, made.text
    assert made.json()["origin"] == solved.number
    job = client.get(f"{API}/jobs/{made.json()['id']}/job").json()
    assert job["variables"]["rod"] == ["585 mm", "715 mm"]
    (start,) = bookmarks_of(store, made.json()["id"])
    assert start.name == f"Start, from run {solved.number}"
    assert start.dimensions == pytest.approx((0.138, 0.65, 0.06))
    locked = client.post(f"{solved.path}/nearby", json={**lengths, "rod_mm": 195.0, "share": 0.9})
    assert bookmarks_of(store, locked.json()["id"]) == []
    assert client.post(f"{solved.path}/nearby", json={**lengths, "share": 1.0}).status_code == 422
