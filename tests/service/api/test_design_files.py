"""Single designs as files over the API."""

from __future__ import annotations

import io
import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace

import httpx
import pytest
from ezdxf.filemanagement import read as read_dxf

from slidercrank.service.api.settings import Settings
from slidercrank.service.runs.result import rows_from_csv
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of, put_in
from tests.service.api.serving import refused

TABLES = tomllib.loads(fronts.JOB)
KINDS = {
    "linkage.dxf": ("image/vnd.dxf", "dxf"),
    "linkage.svg": ("image/svg+xml", "svg"),
    "motion.html": ("text/html; charset=utf-8", "html"),
    "motion.gif": ("image/gif", "gif"),
    "report.html": ("text/html; charset=utf-8", "html"),
    "report.pdf": ("application/pdf", "pdf"),
}


@pytest.fixture(scope="module")
def client(solved: Solved) -> Iterator[httpx.Client]:
    """Return a client of its service."""
    with client_of(solved.store) as found:
        yield found


@pytest.mark.parametrize("name", KINDS)
def test_a_file_of_a_design_is_a_download_that_is_sealed_off(name: str, solved: Solved, client: httpx.Client) -> None:
    media_type, ending = KINDS[name]
    answer = client.get(f"{solved.path}/designs/3/{name}")
    assert (answer.status_code, answer.headers["content-type"]) == (200, media_type)
    part = "" if name.startswith("linkage") else f"-{name.split('.')[0]}"
    file = f"short-test-job-{solved.number}-design-3{part}.{ending}"
    assert answer.headers["content-disposition"] == f'attachment; filename="{file}"'
    policy = answer.headers["content-security-policy"]
    assert policy.startswith("default-src 'none'")
    assert "sandbox" in policy
    assert "allow-same-origin" not in policy
    assert ("allow-scripts" in policy) == (name == "motion.html")
    assert len(answer.content) > 5_000


def test_the_dxf_is_the_design_of_the_table(solved: Solved, client: httpx.Client) -> None:
    answer = client.get(f"{solved.path}/designs/3/linkage.dxf", params={"crank_angle_deg": 100})
    document = read_dxf(io.StringIO(answer.text))
    assert document.audit().errors == []
    design = client.get(f"{solved.path}/designs/3").json()["design"]
    lengths = sorted(
        (line.dxf.end - line.dxf.start).magnitude for line in document.modelspace().query('LINE[layer=="SKELETON"]')
    )
    assert lengths == pytest.approx([design["crank_mm"], design["rod_mm"]], rel=1e-12)
    (path,) = document.modelspace().query('LINE[layer=="PATHS"]')
    assert (path.dxf.end - path.dxf.start).magnitude == pytest.approx(design["stroke_mm"], rel=1e-11)
    assert path.dxf.start.y == pytest.approx(design["offset_mm"], rel=1e-12)


def test_the_report_has_the_numbers_of_the_api_and_of_the_csv(solved: Solved, client: httpx.Client) -> None:
    page = client.get(f"{solved.path}/designs/3/report.html").text
    cells = re.findall(r'<td class="right">([^<]*)</td><td>([a-zA-Z0-9_]+)</td></tr>', page)
    stored = {key: text for text, key in cells}
    design = client.get(f"{solved.path}/designs/3").json()["design"]
    table = rows_from_csv(client.get(f"{solved.path}/export.csv").text)[2]
    assert list(stored) == list(design) == list(table)
    for key, value in design.items():
        if isinstance(value, float):
            assert float(stored[key]) == value == table[key], key
        else:
            assert (stored[key], value) == ("", table[key]), key
    versions = client.get(f"{solved.path}/files/versions.json").json()
    assert f"numpy {versions['numpy']}" in page
    assert "No certificate" in page


def test_a_report_is_kept_and_drawn_once(solved: Solved, monkeypatch: pytest.MonkeyPatch) -> None:
    with client_of(solved.store) as client:
        first = client.get(f"{solved.path}/designs/2/report.html")
        monkeypatch.setattr("slidercrank.service.report.html.html_file", None)
        assert client.get(f"{solved.path}/designs/2/report.html").content == first.content


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize(("design", "status"), [("9", 404), ("0", 422), ("x", 422), ("99999999999999", 422)])
def test_designs_that_are_not_there_are_refused(
    name: str, design: str, status: int, solved: Solved, client: httpx.Client
) -> None:
    refused(client.get(f"{solved.path}/designs/{design}/{name}"), status)


@pytest.mark.parametrize("angle", ["nan", "inf", "361", "-361", "x", ""])
def test_crank_angles_that_are_none_are_refused(angle: str, solved: Solved, client: httpx.Client) -> None:
    refused(client.get(f"{solved.path}/designs/1/linkage.svg", params={"crank_angle_deg": angle}), 422)


def test_a_service_without_figures_draws_for_cad_all_the_same(solved: Solved) -> None:
    with client_of(solved.store, Settings(figures=False)) as client:
        assert client.get(f"{solved.path}/designs/1/linkage.dxf").status_code == 200
        for name in ("motion.gif", "report.html", "report.pdf"):
            assert "draws no figures" in refused(client.get(f"{solved.path}/designs/1/{name}"), 404)


def test_any_name_of_a_job_can_be_taken_away(solved: Solved, store: Store) -> None:
    name = r'$\frac{ <script>&amp; "50" ${data} $title é'
    job = put_in(store, replace(solved.result, name=name), {**TABLES, "name": name})
    with client_of(store) as client:
        for kind in KINDS:
            answer = client.get(f"{API}/jobs/{job}/designs/1/{kind}")
            assert answer.status_code == 200, kind
            assert answer.headers["content-disposition"].isascii()


def test_a_job_without_a_result_has_no_designs_to_take_away(store: Store) -> None:
    store.submit(TABLES, name="x")
    with client_of(store) as client:
        refused(client.get(f"{API}/jobs/1/designs/1/linkage.dxf"), 409)
