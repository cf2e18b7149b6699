"""The six gearmotors of a pusher on the command line and over HTTP: price, maker, and the cheapest one."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.optimise.test_catalogue_amounts import PUSHER, SIX
from tests.service.api.fixed_front import API, client_of
from tests.service.conftest import Command

LEAST = {"choice_least_gearmotor", "choice_least_gearmotor_maker", "least_gearmotor_price_EUR"}
KEYS = {"choice_gearmotor", "choice_gearmotor_maker", "price_EUR", *LEAST}


def expected_catalogue_values(design: dict[str, Any]) -> None:
    """Compare what a design has of its catalogue with the torque that it needs."""
    assert set(design) >= KEYS
    assert (design["choice_gearmotor"], design["price_EUR"], design["choice_gearmotor_maker"]) == (
        "GM 150",
        830.0,
        "Acme",
    )
    least = ("GM 30", "Acme", 280.0) if design["peak_torque_Nm"] <= 30.0 else ("GM 45", "Bolt", 340.0)
    assert (
        design["choice_least_gearmotor"],
        design["choice_least_gearmotor_maker"],
        design["least_gearmotor_price_EUR"],
    ) == least


@pytest.fixture
def pusher(tmp_path: Path) -> Path:
    """Return a job file with its catalogue beside it."""
    (tmp_path / "gearmotors.csv").write_text(SIX)
    job = {**PUSHER, "choice": [{"name": "gearmotor", "file": "gearmotors.csv"}]}
    (tmp_path / "pusher.json").write_text(json.dumps(job))
    return tmp_path / "pusher.json"


def test_commands_check_and_tell_catalogues_and_keep_their_columns(pusher: Path, command: Command) -> None:
    checked = command("check", pusher)
    assert "of 6 rows 1 is searched" in " ".join(checked.stdout.split())
    done = command("optimise", pusher, "--no-figures", "--json")
    assert done.exit_code == 0, done.stderr
    record = json.loads(done.stdout)
    assert len(record["designs"]) > 3
    for design in record["designs"]:
        expected_catalogue_values(design)
    table = command("front", record["run"])
    said = "In every design: offset 20 mm, gearmotor GM 150, gearmotor maker Acme, price 830 EUR"
    assert said in " ".join(table.stdout.split())
    assert re.search("GM 30 +(280.0 +Acme|Acme +280.0)", table.stdout)
    one = " ".join(command("analyse", record["run"], "--design", 1).stdout.split())
    assert "price 830 EUR" in one


def test_the_api_checks_catalogues_gives_their_columns_and_filters_by_price(store: Store) -> None:
    number = submit(store, dict(PUSHER)).id
    work(store, drain=True)
    with client_of(store) as client:
        checked = client.post(f"{API}/check", json={"job": PUSHER}).json()
        assert any("of 6 rows 1 is searched" in note for note in checked["notes"])
        found = client.get(f"{API}/jobs/{number}/designs").json()
        for row in found["designs"]:
            expected_catalogue_values(row)
        front = client.get(f"{API}/jobs/{number}/front").json()
        groups = {column["key"]: column["group"] for column in front["columns"]}
        assert {groups[key] for key in KEYS} == {groups["crank_mm"]}
        heads = {column["key"]: (column["title"], column["unit"]) for column in front["columns"]}
        assert heads["least_gearmotor_price_EUR"] == ("smallest sufficient gearmotor price", "EUR")
        look = client.post(f"{API}/preview", json={"job": PUSHER}).json()
        assert {"name": "price", "title": "price", "unit": "EUR"} in look["names"]
