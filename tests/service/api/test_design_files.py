"""Single designs as files over the API."""

from __future__ import annotations

import io
import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import httpx
import pypdfium2
import pytest
from ezdxf.filemanagement import read as read_dxf

from slidercrank.service.api.settings import Settings
from slidercrank.service.designs.columns import find_column
from slidercrank.service.designs.display_units import convert_row
from slidercrank.service.render.numerals import format_cell
from slidercrank.service.runs.result import rows_from_csv
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import API, Solved, client_of, store_result
from tests.service.api.serving import refusal_sentence

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


@pytest.mark.slow
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


def columns_of_machine(page: str, design: Mapping[str, Any]) -> list[str]:
    """Return the columns of a design but for those that its report says its machine does not have."""
    (told,) = re.findall(r"Not defined for this machine: ([^<]*)\.</p>", page)
    found = [key for key in design if f", {find_column(key, list(design)).title}, " not in f", {told}, "]
    assert {"crank_mm", "crank_in"} & set(found)
    assert "efficiency" not in found  # nothing rubs
    assert "peak_torque_Nm" in found or "peak_torque_lbf_in" in found
    return found


def numbers_read_in(page: str) -> dict[str, str]:
    """Return the texts of all numbers of a design in a report, by column."""
    table = page.partition("Every number of the design</h2>")[2]
    cells = re.findall(r'<td class="right">([^<]*)</td><td>[^<]*</td><td>([a-zA-Z0-9_]+)</td></tr>', table)
    return {key: text for text, key in cells}


def test_the_report_has_the_numbers_of_the_api_and_of_the_csv(solved: Solved, client: httpx.Client) -> None:
    page = client.get(f"{solved.path}/designs/3/report.html").text
    stored = numbers_read_in(page)
    design = client.get(f"{solved.path}/designs/3").json()["design"]
    table = rows_from_csv(client.get(f"{solved.path}/export.csv").text)[2]
    assert table.pop("number") == 3
    assert list(design) == list(table)
    assert list(stored) == columns_of_machine(page, design)
    for key, value in design.items():
        if value is None:  # not defined, as a position error without tolerances
            assert (key in stored, str(table[key])) == (False, "nan"), key
        elif isinstance(value, float) and key in stored:
            assert (stored[key], value) == (format_cell(value), table[key]), key
        elif key in stored:
            assert stored[key] == value == table[key], key
    versions = client.get(f"{solved.path}/files/versions.json").json()
    assert f"numpy {versions['numpy']}" in page
    assert "No certificate" in page


def test_a_report_is_in_the_units_that_are_asked_for(solved: Solved, client: httpx.Client) -> None:
    page = client.get(f"{solved.path}/designs/3/report.html", params={"units": "inch"}).text
    stored = numbers_read_in(page)
    design = convert_row(client.get(f"{solved.path}/designs/3").json()["design"], "inch")
    assert "crank_in" in stored
    assert list(stored) == columns_of_machine(page, design)
    for key, text in stored.items():
        value = design[key]
        assert text == (format_cell(value) if isinstance(value, float) else value), key
    assert "mm" not in re.sub(r"<[^>]*>", " ", page.partition("Summary")[2].partition("</section>")[0]).split()
    refusal_sentence(client.get(f"{solved.path}/designs/3/report.html", params={"units": "feet"}), 422)


def test_drawings_and_motion_are_in_the_units_that_are_asked_for(solved: Solved, client: httpx.Client) -> None:
    files = ("linkage.svg", "motion.html", "motion.gif")
    metric, inch = (
        {file: client.get(f"{solved.path}/designs/3/{file}", params={"units": units}) for file in files}
        for units in ("metric", "inch")
    )
    assert metric["linkage.svg"].text == client.get(f"{solved.path}/designs/3/linkage.svg").text
    crank = client.get(f"{solved.path}/designs/3").json()["design"]["crank_mm"]
    for file in ("linkage.svg", "motion.html"):
        found = re.search(r"crank ([\d.]+) in, rod", inch[file].text)
        assert found is not None, file
        assert found[1] == f"{crank / 25.4:.5g}", file
        assert "millimetres" not in inch[file].text, file
    data = (page["motion.html"].text.partition('id="data">')[2].partition("<")[0] for page in (metric, inch))
    before, after = (json.loads(text)["curves"]["slider_position_mm"] for text in data)
    assert after == pytest.approx([value / 25.4 for value in before], rel=1e-6)
    assert len(inch["motion.gif"].content) > 1000
    assert inch["motion.gif"].content != metric["motion.gif"].content


def test_a_report_is_kept_and_drawn_once(solved: Solved, client: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    first = client.get(f"{solved.path}/designs/3/report.html")
    monkeypatch.setattr("slidercrank.service.report.html.html_file", None)
    assert client.get(f"{solved.path}/designs/3/report.html").content == first.content


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize(("design", "status"), [("9", 404), ("0", 422), ("x", 422), ("99999999999999", 422)])
def test_designs_that_are_not_there_are_refused(
    name: str, design: str, status: int, solved: Solved, client: httpx.Client
) -> None:
    refusal_sentence(client.get(f"{solved.path}/designs/{design}/{name}"), status)


@pytest.mark.parametrize("angle", ["nan", "inf", "361", "-361", "x", ""])
def test_crank_angles_that_are_none_are_refused(angle: str, solved: Solved, client: httpx.Client) -> None:
    refusal_sentence(client.get(f"{solved.path}/designs/1/linkage.svg", params={"crank_angle_deg": angle}), 422)


def test_a_service_without_figures_draws_for_cad_all_the_same(solved: Solved) -> None:
    with client_of(solved.store, Settings(figures=False)) as client:
        assert client.get(f"{solved.path}/designs/1/linkage.dxf").status_code == 200
        for name in ("motion.gif", "report.html", "report.pdf"):
            assert "cannot draw figures" in refusal_sentence(client.get(f"{solved.path}/designs/1/{name}"), 404)


def changed(solved: Solved) -> dict[str, float]:
    """Return lengths that design 3 does not have, near its own."""
    row = solved.result.designs[2]
    return {
        name: float(row[name] or 0.0) * factor
        for name, factor in (("crank_mm", 0.98), ("rod_mm", 1.03), ("offset_mm", 1.01))
    }


@pytest.fixture(scope="module")
def files_of_changed(solved: Solved, client: httpx.Client) -> dict[str, httpx.Response]:
    """Return every file of design 3 with other lengths."""
    names = (*(f"designs/3/{name}" for name in KINDS), "figures/design_3.png", "figures/design_3.svg")
    return {name: client.get(f"{solved.path}/{name}", params=changed(solved)) for name in names}


def test_files_of_changed_lengths_say_so_in_name_and_title(
    files_of_changed: dict[str, httpx.Response], solved: Solved, client: httpx.Client
) -> None:
    for name, answer in files_of_changed.items():
        assert answer.status_code == 200, (name, answer.text)
        file = answer.headers["content-disposition"]
        assert f"short-test-job-{solved.number}-design-3-changed" in file, name
    for name in ("designs/3/linkage.svg", "designs/3/motion.gif"):
        unchanged = client.get(f"{solved.path}/{name}")
        assert files_of_changed[name].content != unchanged.content, name
        assert "changed" not in unchanged.headers["content-disposition"]
    for name in ("designs/3/linkage.svg", "designs/3/motion.html", "designs/3/report.html"):
        assert "design 3, changed" in files_of_changed[name].text, name
    document = read_dxf(io.StringIO(files_of_changed["designs/3/linkage.dxf"].text))
    assert any("design 3, changed" in text.dxf.text for text in document.modelspace().query("TEXT"))
    paper = pypdfium2.PdfDocument(files_of_changed["designs/3/report.pdf"].content)
    assert paper.get_metadata_dict()["Title"] == "Short test [job]: design 3, changed"


def test_files_of_changed_lengths_have_their_numbers(
    files_of_changed: dict[str, httpx.Response], solved: Solved, client: httpx.Client
) -> None:
    lengths = changed(solved)
    answer = client.post(f"{solved.path}/designs/3/what-if", json=lengths).json()
    design = answer["design"]
    document = read_dxf(io.StringIO(files_of_changed["designs/3/linkage.dxf"].text))
    drawn = sorted(
        (line.dxf.end - line.dxf.start).magnitude for line in document.modelspace().query('LINE[layer=="SKELETON"]')
    )
    assert drawn == pytest.approx([lengths["crank_mm"], lengths["rod_mm"]], rel=1e-12)
    page = files_of_changed["designs/3/report.html"].text
    stored = numbers_read_in(page)
    assert list(stored) == columns_of_machine(page, design)
    for key, text in stored.items():
        assert text == (format_cell(design[key]) if isinstance(design[key], float) else design[key]), key
    assert "Not all requirements are met" in page
    assert answer["broken"]  # such a design is never said to dominate
    assert " the front at least as good in every objective" in page or not answer["dominated_by"]
    assert ("no listed design is better in every objective" in page) == (not answer["dominated_by"])
    assert f"crank {lengths['crank_mm']:.5g} mm instead of" in page
    for name in ("designs/3/linkage.svg", "designs/3/motion.html"):
        assert f"crank {lengths['crank_mm']:.5g} mm" in files_of_changed[name].text, name


def test_the_lengths_of_the_design_itself_change_nothing(solved: Solved, client: httpx.Client) -> None:
    own = {name: solved.result.designs[2][name] for name in ("crank_mm", "rod_mm", "offset_mm")}
    answer = client.get(f"{solved.path}/designs/3/linkage.svg", params=own)
    assert answer.text == client.get(f"{solved.path}/designs/3/linkage.svg").text


@pytest.mark.parametrize(
    ("query", "said"),
    [
        (
            {"crank_mm": 100},
            "must be given together, crank_mm, rod_mm and offset_mm; got none for rod_mm and offset_mm",
        ),
        ({"crank_mm": 100, "rod_mm": 90, "offset_mm": 0}, "rod must exceed crank + |offset| for full rotation"),
        ({"crank_mm": "nan", "rod_mm": 300, "offset_mm": 0}, "crank_mm: must be a finite number; got"),
        ({"crank_mm": 0, "rod_mm": 300, "offset_mm": 0}, "crank_mm"),
        ({"crank_mm": 10, "rod_mm": 300, "offset_mm": "inf"}, "offset_mm: must be a finite number; got"),
        ({"crank_mm": "long", "rod_mm": 300, "offset_mm": 0}, "crank_mm"),
    ],
)
@pytest.mark.parametrize("name", ["designs/3/linkage.dxf", "designs/3/report.pdf", "figures/design_3.png"])
def test_lengths_that_make_no_design_are_refused(
    name: str, query: dict[str, object], said: str, solved: Solved, client: httpx.Client
) -> None:
    assert said in refusal_sentence(client.get(f"{solved.path}/{name}", params=query), 422)  # type: ignore[arg-type]


def test_other_lengths_are_those_of_one_design(solved: Solved, client: httpx.Client) -> None:
    answer = client.get(f"{solved.path}/figures/parallel_coordinates.png", params=changed(solved))
    assert "other lengths and values only apply to a single design" in refusal_sentence(answer, 422)


def test_any_name_of_a_job_can_be_taken_away(solved: Solved, store: Store) -> None:
    name = r'$\frac{ <script>&amp; "50" ${data} $title é'
    job = store_result(store, replace(solved.result, name=name), {**TABLES, "name": name})
    with client_of(store) as client:
        for kind in ("linkage.dxf", "linkage.svg", "motion.html", "report.html"):
            answer = client.get(f"{API}/jobs/{job}/designs/1/{kind}")
            assert answer.status_code == 200, kind
            assert answer.headers["content-disposition"].isascii()


def test_a_job_without_a_result_has_no_designs_to_take_away(store: Store) -> None:
    store.submit(TABLES, name="x")
    with client_of(store) as client:
        refusal_sentence(client.get(f"{API}/jobs/1/designs/1/linkage.dxf"), 409)
