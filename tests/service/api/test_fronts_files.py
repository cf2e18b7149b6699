"""Figures and exports over the API, and that a design has the same numbers wherever it is read."""

from __future__ import annotations

import io
import json
import math
import sys
import threading
import tomllib
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from slidercrank.service.api import front_files
from slidercrank.service.api.settings import Settings
from slidercrank.service.cli import app as command_line
from slidercrank.service.client import Client
from slidercrank.service.designs.selection import numbered_rows
from slidercrank.service.runs.result import csv_text, json_ready, rows_from_csv
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of, rows_with, served, store_result

TABLES = tomllib.loads(fronts.JOB)
NAMES = ["scatter_matrix", "parallel_coordinates", "best_time_ratio", "best_transmission_angle", "knee"]


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    """Return a client of its service."""
    with client_of(solved.store) as found:
        yield found


def test_a_design_has_the_same_numbers_everywhere(solved: Solved, tmp_path: Path) -> None:
    done = CliRunner().invoke(command_line, ["export", str(solved.folder), "--csv", "-"])
    exported = rows_from_csv(done.stdout)
    with served(solved.store) as address, Client(address) as client:
        front = client.front(solved.number)
        table = client.designs(solved.number)
        by_csv = rows_from_csv(client.export(solved.number, tmp_path / "front.csv").read_text(encoding="utf-8"))
        by_json = json.loads(client.export(solved.number, tmp_path / "front.json").read_text(encoding="utf-8"))
        parquet = pd.read_parquet(client.export(solved.number, tmp_path / "front.parquet"))
        singles = [client.design(solved.number, number + 1) for number in range(len(exported))]
    assert len(exported) == 8
    for row, given in enumerate(exported):
        assert (given.pop("number"), by_csv[row]["number"], singles[row]["number"], table.index[row]) == (row + 1,) * 4
        for key, value in given.items():
            same = value if isinstance(value, str) else pytest.approx(value, rel=0.0, abs=0.0, nan_ok=True)
            assert (by_csv[row][key], parquet.iloc[row][key]) == (same, same), (row, key)
            shown = json_ready(value)
            assert [table.iloc[row][key]] == ([value] if shown is not None else [pytest.approx(math.nan, nan_ok=True)])
            assert by_json["designs"][row][key] == shown, (row, key)
            for other in (singles[row], front.designs[row]):
                assert other[key] == (None if shown is None else value), (row, key)


def test_exports_are_those_of_the_command_line_but_for_formulas(solved: Solved, client: httpx.Client) -> None:
    csv = client.get(f"{solved.path}/export.csv")
    assert csv.text == csv_text(numbered_rows(solved.result.designs))
    assert csv.headers["content-type"] == "text/csv; charset=utf-8"
    assert csv.headers["content-disposition"] == f'attachment; filename="short-test-job-{solved.number}.csv"'
    whole = client.get(f"{solved.path}/export.json").text
    assert json.loads(whole) == solved.store.result(solved.number).record()


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r"])
def test_text_is_never_a_formula_of_a_spreadsheet(start: str, solved: Solved, store: Store) -> None:
    text = f'{start}HYPERLINK("http://x","y")'
    rows = rows_with(solved.result.designs, choice_motor=text, slack_x_mm=-1.5, low_mm=-math.inf)
    job = store_result(store, solved.result, TABLES, designs=rows)
    with client_of(store) as client:
        back = rows_from_csv(client.get(f"{API}/jobs/{job}/export.csv").text)
    assert {row["choice_motor"] for row in back} == {f"'{text}"}
    assert {row["slack_x_mm"] for row in back} == {-1.5}
    assert {row["low_mm"] for row in back} == {-math.inf}


def test_parquet_keeps_what_is_infinite(solved: Solved, store: Store) -> None:
    rows = rows_with(solved.result.designs, slack_x_mm=math.inf)
    job = store_result(store, solved.result, TABLES, designs=rows)
    with client_of(store) as client:
        table = pd.read_parquet(io.BytesIO(client.get(f"{API}/jobs/{job}/export.parquet").content))
    assert np.isposinf(table["slack_x_mm"]).all()


def test_parquet_without_pyarrow_says_what_to_install(
    solved: Solved, client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    answer = client.get(f"{solved.path}/export.parquet")
    assert (answer.status_code, answer.headers["content-type"]) == (501, "application/problem+json")
    assert 'pip install "slidercrank[parquet]"' in answer.json()["detail"]


def test_parquet_is_offered_only_where_pyarrow_is(solved: Solved, monkeypatch: pytest.MonkeyPatch) -> None:
    for there, expected in ((True, ["csv", "json", "parquet"]), (False, ["csv", "json"])):
        monkeypatch.setattr(front_files, "is_installed", lambda name, there=there: there)
        with client_of(solved.store) as client:
            assert client.get(f"{solved.path}/files").json()["exports"] == expected
            schema = client.get(f"{API}/openapi.json").json()
            assert (f"{API}/jobs/{{number}}/export.parquet" in schema["paths"]) == there
            links = schema["paths"][f"{API}/jobs"]["post"]["responses"]["201"]["links"]
            assert ("export_parquet" in links) == there


def test_figures_are_listed_and_drawn(solved: Solved, client: httpx.Client) -> None:
    listed = [figure["name"] for figure in client.get(f"{solved.path}/figures").json()["figures"]]
    assert set(listed) == set(NAMES)
    for name in ("best_time_ratio", "design_1"):
        png = client.get(f"{solved.path}/figures/{name}.png")
        assert (png.status_code, png.headers["content-type"]) == (200, "image/png")
        assert png.content.startswith(b"\x89PNG")


def test_a_figure_as_svg_runs_nothing(solved: Solved, client: httpx.Client) -> None:
    svg = client.get(f"{solved.path}/figures/knee.svg")
    assert svg.headers["content-type"] == "image/svg+xml"
    assert "default-src 'none'" in svg.headers["content-security-policy"]
    assert "sandbox" in svg.headers["content-security-policy"]
    assert ElementTree.fromstring(svg.text).tag == "{http://www.w3.org/2000/svg}svg"


def test_many_may_ask_for_figures_at_once(solved: Solved, client: httpx.Client) -> None:
    expected = {number: client.get(f"{solved.path}/figures/design_{number}.png").content for number in (1, 2)}
    found: list[bool] = []

    def ask(number: int) -> None:
        found.append(client.get(f"{solved.path}/figures/design_{number}.png").content == expected[number])

    threads = [threading.Thread(target=ask, args=(1 + n % 2,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [True] * 4


@pytest.mark.parametrize(
    ("name", "status"),
    [
        ("nothing.png", 404),
        ("design_0.png", 404),
        ("design_9.png", 404),
        ("design_1.gif", 404),
        ("..%2F..%2Fetc%2Fpasswd.png", 404),
        ("%2e%2e%2fknee.png", 404),
        ("....png", 422),
        ("knee%00.png", 400),
        ("KNEE.png", 422),
        (f"{'a' * 200}.svg", 422),
        ("design_99999999999999999999.png", 404),
    ],
)
def test_names_that_no_figure_has_are_refused(name: str, status: int, solved: Solved, client: httpx.Client) -> None:
    answer = client.get(f"{solved.path}/figures/{name}")
    assert (answer.status_code, answer.headers["content-type"]) == (status, "application/problem+json")


def test_a_service_without_figures_says_so(solved: Solved) -> None:
    with client_of(solved.store, Settings(figures=False)) as client:
        for place in ("figures", "figures/knee.png"):
            answer = client.get(f"{solved.path}/{place}")
            assert (answer.status_code, "cannot draw figures" in answer.json()["detail"]) == (404, True)


def test_any_name_of_a_job_can_be_drawn(solved: Solved, store: Store) -> None:
    name = r"$\frac{ <script>&amp; 50 $"
    job = store_result(store, replace(solved.result, name=name), {**TABLES, "name": name})
    with client_of(store) as client:
        drawn = client.get(f"{API}/jobs/{job}/figures/knee.svg")
    assert drawn.status_code == 200
    ElementTree.fromstring(drawn.text)


def test_a_job_with_functions_of_its_own_has_numbers_but_no_analysis(solved: Solved, store: Store) -> None:
    own: dict[str, Any] = {**TABLES, "quantity": {"cost": {"function": "prices:cost", "unit": "", "title": "cost"}}}
    job = store_result(store, solved.result, own)
    with client_of(store) as client:
        assert len(client.get(f"{API}/jobs/{job}/designs").json()["designs"]) == 8
        refused = client.get(f"{API}/jobs/{job}/designs/1/analysis")
    assert refused.status_code == 422
    assert "only functions that the operator allows" in refused.json()["detail"]
