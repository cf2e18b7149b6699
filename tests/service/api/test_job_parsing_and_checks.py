"""Shipped jobs, job files read and written, and quantities explained, through the API."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path
from typing import Any

import httpx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slidercrank.model.errors import JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.objectives.registry import FACTS, QUANTITIES
from slidercrank.optimise.job import load_job, read_job
from slidercrank.service.jobs.job_toml import job_toml
from tests.service.api.serving import refusal_sentence

TOML = {"Content-Type": "application/toml"}
SHIPPED = ("feeder", "sieve", "support", "compressor", "press", "servo_press", "tipper")


def shipped(root: Path) -> dict[str, Any]:
    return {file.stem: read_job(file) for file in (root / "runs").glob("*.toml")}


def test_the_packaged_jobs_are_those_of_the_folder_runs(pytestconfig: pytest.Config) -> None:
    root = pytestconfig.rootpath
    for kind in ("*.toml", "*.csv"):
        files = {file.name: file.read_bytes() for file in (root / "runs").glob(kind)}
        packaged = {file.name: file.read_bytes() for file in (root / "service" / "presets").glob(kind)}
        assert packaged == files, f"copy runs/{kind} to service/presets"


def test_presets_are_the_shipped_jobs(shared: httpx.Client, pytestconfig: pytest.Config) -> None:
    presets = shared.get("/presets").json()["presets"]
    assert {preset["name"]: preset["job"] for preset in presets} == shipped(pytestconfig.rootpath)
    for preset in presets:
        assert (preset["title"], preset["sentence"]) == (preset["job"]["name"], preset["job"]["description"])
        assert shared.post("/check", json={"job": preset["job"]}).status_code == 200


@pytest.mark.parametrize("name", SHIPPED)
def test_the_design_that_shows_a_shipped_job_is_one_of_its_ranges_and_moves_as_asked(
    shared: httpx.Client, pytestconfig: pytest.Config, name: str
) -> None:
    problem = load_job(pytestconfig.rootpath / "runs" / f"{name}.toml")
    presets = shared.get("/presets").json()["presets"]
    (shown,) = (preset["design"] for preset in presets if preset["name"] == name)
    lengths = [shown[f"{part}_mm"] / 1e3 for part in ("crank", "rod", "offset")]
    for length, ends in zip(lengths, (problem.crank, problem.rod, problem.offset), strict=True):
        assert ends.lower - 1e-9 <= length <= ends.upper + 1e-9
    parts = shown["outlines"]
    assert [each["bore_mm"] for each in parts["cylinders"]] == ([70.0] if name == "compressor" else [])
    assert (parts["body"] is not None, parts["actuator"] is not None) == (
        name in ("support", "tipper"),
        name == "support",
    )
    assert (parts["lever"] is not None) == (name == "tipper")
    if shown["from_deg"] is not None:
        motion = tomllib.loads((pytestconfig.rootpath / "runs" / f"{name}.toml").read_text())["motion"]
        assert (f"{shown['from_deg']:g} deg", f"{shown['to_deg']:g} deg") == (motion["from"], motion["to"])
        return
    linkage = Linkage(*lengths)
    for rule in problem.constraints:
        value = {"stroke": linkage.stroke, "rod_to_offset": abs(lengths[1] / lengths[2])}.get(str(rule.quantity))
        if value is not None:
            assert 0.999 * (rule.lower or 0.0) <= float(value) <= 1.001 * (rule.upper or math.inf)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_job_comes_back_the_same_through_toml(
    shared: httpx.Client, pytestconfig: pytest.Config, name: str
) -> None:
    file = (pytestconfig.rootpath / "runs" / f"{name}.toml").read_bytes()
    tables = shared.post("/parse", content=file, headers=TOML).json()["job"]
    assert tables == tomllib.loads(file.decode())
    written = shared.post("/toml", json={"job": tables})
    assert written.headers["content-type"] == "application/toml"
    assert tomllib.loads(written.text) == tables
    assert "[mechanism]\n" in written.text


TEXT = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=12)
NUMBERS = st.integers(-(2**53), 2**53) | st.floats(allow_nan=False, allow_infinity=False)
NESTED = st.recursive(
    st.booleans() | NUMBERS | TEXT,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(TEXT, inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=60)
@given(st.dictionaries(TEXT, NESTED, max_size=5))
def test_whatever_the_tables_hold_reading_what_was_written_gives_it_again(tables: dict[str, Any]) -> None:
    assert tomllib.loads(job_toml(tables)) == tables


@pytest.mark.parametrize("value", [None, float("nan"), float("inf")])
def test_what_toml_has_no_word_for_is_refused(value: object) -> None:
    with pytest.raises(JobError, match="leave the key out"):
        job_toml({"mechanism": {"speed": value}})


def test_a_file_that_is_no_toml_is_said_with_its_line(shared: httpx.Client) -> None:
    sentence = refusal_sentence(shared.post("/parse", content=b"name = \n", headers=TOML), 422)
    assert sentence.startswith(
        'line 1, name: there must be = and a value after a key; got name =; write name = "Vibrating sieve"'
    )


def test_every_quantity_is_explained(shared: httpx.Client, pytestconfig: pytest.Config) -> None:
    found = {item["name"]: item for item in shared.get("/quantities").json()["quantities"]}
    assert set(found) == {"crank", "rod", "offset", *FACTS}
    theory = (pytestconfig.rootpath / "docs" / "theory.md").read_text()
    sections = set(re.findall(r"^## (.+)$", theory, re.MULTILINE))
    pictures = (pytestconfig.rootpath / "service/page/static/help/picture.js").read_text()
    for name, item in found.items():
        assert item["sentence"].endswith("."), name
        assert 30 < len(item["sentence"]) < 260, name
        assert item["formula"], name
        assert item["section"] in sections, name
        assert re.search(rf'^  "?{re.escape(item["picture"])}"?: \{{', pictures, re.MULTILINE), item["picture"]
        if name in QUANTITIES:
            quantity = QUANTITIES[name]
            assert (item["column"], item["title"], item["unit"]) == (
                quantity.field,
                quantity.title,
                quantity.unit.symbol,
            )
        if item["source"].startswith("R. Chetana"):
            assert "*Analysis of Position Error in Offset Slider Crank Mechanism*, Eq. (3)" in theory


def test_a_catalogue_that_is_sent_as_a_table_gives_the_options_that_no_other_one_beats(shared: httpx.Client) -> None:
    table = "name,room min (mm),peak_torque max (N m)\nA,3,40\nB,4,40\nC,5,90\n"
    found = shared.post("/catalogue", json={"table": table, "own": ["room"]}).json()
    assert found["rows"] == 3
    assert [(option["name"], option.get("searched", True)) for option in found["option"]] == [
        ("C", True),
        ("B", False),  # the least that serves some designs, though A beats it
        ("A", True),
    ]
    assert found["option"][2]["constraints"] == {"room": {"min": "3 mm"}, "peak_torque": {"max": "40 N m"}}
    for wrong, said in (("", "empty"), ("name,peak_torque max (mm)\nA,1", "unit"), ("name,crank\nA,=1", "formula")):
        assert said in refusal_sentence(shared.post("/catalogue", json={"table": wrong}), 422)


def test_check_says_of_each_load_what_it_does_and_warns_of_one_that_pushes_with_the_stroke(
    shared: httpx.Client, pytestconfig: pytest.Config
) -> None:
    job = shipped(pytestconfig.rootpath)["feeder"]
    push = {"positions": ["0 mm", "60 mm"], "forces": ["350 N", "350 N"], "measured_from": "outer dead centre"}
    sentence = (
        "350 N outward, helps the outward stroke, from 60 mm before the outer dead centre to it; "
        "constant beyond, hence everywhere"
    )
    before = shared.post("/check", json={"job": job}).json()
    assert before["loads"] == [
        "2000 N inward, resists the outward stroke, throughout",
        "60 N, resists both strokes, throughout",
    ]
    changed = job | {"load": [push | {"during": "outward stroke"}]}
    after = shared.post("/check", json={"job": changed}).json()
    assert after["loads"] == [sentence]
    assert f"load: {sentence}" in after["given"]
    (said,) = set(after["warnings"]) - set(before["warnings"])
    assert f"load #1 ({sentence})" in said
    helps = {"force": "350 N", "helps": "outward stroke", "over": "last 60 mm"}
    stated = shared.post("/check", json={"job": job | {"load": [helps]}}).json()
    assert stated["loads"] == [sentence.replace("constant beyond, hence everywhere", "zero beyond")]
    assert stated["warnings"] == before["warnings"]
