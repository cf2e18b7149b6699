"""A store that the version before wrote, opened by this one: its jobs are listed, its fronts served."""

import gzip
import sqlite3
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from slidercrank.service.runs.result import json_ready, rows_from_csv
from slidercrank.service.store import Store, schema_version
from tests.service.api.serving import client_of

FOLDER = Path(__file__).parents[2] / "data" / "store_0001"
DESIGNS = {1: 6, 2: 2}


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("old") / "store.db"
    file.write_bytes(gzip.decompress((FOLDER / "store.db.gz").read_bytes()))
    return file


@pytest.fixture(scope="module")
def client(path: Path) -> Iterator[httpx.Client]:
    with Store(path) as store, client_of(store) as client:
        yield client


def version(path: Path) -> str:
    """Return the version of the tables of a store."""
    connection = sqlite3.connect(path)
    try:
        return str(connection.execute("select version_num from alembic_version").fetchone()[0])
    finally:
        connection.close()


def test_an_old_store_gets_the_tables_of_today_when_it_is_opened(path: Path) -> None:
    fresh = path.with_name("fresh.db")
    fresh.write_bytes(gzip.decompress((FOLDER / "store.db.gz").read_bytes()))
    assert version(fresh) == "0001"
    with Store(fresh) as store:
        assert [job.state for job in store.jobs()] == ["infeasible", "done", "done"]
    assert version(fresh) > "0001"


def test_jobs_of_an_old_store_are_listed(client: httpx.Client) -> None:
    listed = client.get("/jobs").json()["jobs"]
    assert [(job["id"], job["state"]) for job in listed] == [(3, "infeasible"), (2, "done"), (1, "done")]
    assert [job["summary"].keys() for job in listed] == [{"designs", "best", "seconds"}] * 3
    fronts = client.get("/front-points", params={"job": [1, 2, 3]}).json()["fronts"]
    assert [(front["job"], len(front["points"])) for front in fronts] == [(1, 6), (2, 2), (3, 0)]


@pytest.mark.parametrize("job", DESIGNS)
def test_fronts_of_an_old_store_are_served_as_they_were_written(client: httpx.Client, job: int) -> None:
    written = rows_from_csv((FOLDER / f"{job}.csv").read_text())
    assert len(written) == DESIGNS[job]
    served = client.get(f"/jobs/{job}/designs", params={"limit": 100}).json()["designs"]
    assert [{key: cell for key, cell in row.items() if key != "number"} for row in served] == json_ready(written)


@pytest.mark.parametrize("job", DESIGNS)
def test_designs_of_an_old_store_can_be_asked_about(client: httpx.Client, job: int) -> None:
    for number, row in enumerate(rows_from_csv((FOLDER / f"{job}.csv").read_text()), 1):
        analysis = client.get(f"/jobs/{job}/designs/{number}/analysis").json()["analysis"]
        for key in ("crank_mm", "rod_mm", "offset_mm", "peak_torque_Nm", "least_transmission_angle_deg"):
            if key in row:
                assert analysis[key] == pytest.approx(row[key], rel=1e-12, abs=1e-15), key
        assert client.get(f"/jobs/{job}/designs/{number}/curves", params={"angles": 8}).status_code == 200
        assert client.get(f"/jobs/{job}/designs/{number}/trade-offs").json()["trade_offs"]


def test_a_job_of_an_old_store_without_designs_says_why(client: httpx.Client) -> None:
    front = client.get("/jobs/3/front").json()
    assert front["status"] == "infeasible"
    assert "peak torque at most 0.001 N m is asked" in front["message"]


def test_the_version_that_opens_at_once_is_that_of_the_last_migration() -> None:
    _, scripts = schema_version._alembic_config_and_scripts()
    assert scripts.get_current_head() == schema_version.LATEST
