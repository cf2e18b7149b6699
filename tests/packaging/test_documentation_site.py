"""The documentation site: every page has its place, and what is generated tells all that it is made of."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from mkdocs.config import load_config

import slidercrank
from benchmarks.load_pictures import whole_job
from docs.site import hooks
from docs.site.api_reference import api_reference
from docs.site.doctests import with_code
from docs.site.job_reference import headings, job_reference
from docs.site.python_reference import folder_reference, front_door_reference
from docs.site.quantity_reference import quantity_reference, requirement, section
from docs.site.schema_tables import kind
from slidercrank.objectives.registry import FACTS
from slidercrank.optimise.job import job_schema, parse_job, with_file_contents
from tests.optimise.problems import LEVER, SHAPER


def places(nav: Any) -> list[str]:
    """Return the pages of a navigation, at any depth."""
    if isinstance(nav, str):
        return [nav]
    return [page for part in (nav.values() if isinstance(nav, dict) else nav) for page in places(part)]


def test_every_page_has_one_place_in_the_navigation(pytestconfig: pytest.Config) -> None:
    root = pytestconfig.rootpath
    site = load_config(str(root / "mkdocs.yml"))
    assert site.theme["font"] is False  # nothing comes from other sites
    written = [str(file.relative_to(root / "docs")) for file in (root / "docs").rglob("*.md")]
    assert sorted(places(site.nav)) == sorted([*written, *hooks.pages()])


def test_reference_of_jobs_names_every_table_and_key() -> None:
    schema, page = job_schema(), job_reference()
    names = {*schema["properties"], *(key for part in schema["$defs"].values() for key in part.get("properties", ()))}
    assert [name for name in sorted(names) if f"| `{name}` |" not in page] == []


def test_examples_of_the_reference_of_jobs_are_parts_of_jobs(tmp_path: Path) -> None:
    (tmp_path / "trace.csv").write_text("crank angle (deg),force (kN)\n0,-0.2\n180,0\n")
    blocks = re.findall(r"^```toml\n(.*?)^```$", job_reference(), re.MULTILINE | re.DOTALL)
    assert len(blocks) > 25
    for block in blocks:
        part = tomllib.loads(block)
        ((name, table),) = part.items()
        whole = {"cylinder": LEVER, "spring": LEVER, "arm": SHAPER}.get(name) or whole_job()
        swings = name == "load" and "torque_per_angle" in table[0]
        merged = {**whole[name], **table} if isinstance(whole.get(name), dict) and name != "objectives" else table
        if not swings:
            assert (
                parse_job(with_file_contents({**whole, name: merged}, tmp_path), require_feasible=False).name
                == whole["name"]
            ), block


def test_headings_of_the_reference_of_jobs_say_where_a_job_has_them() -> None:
    found = headings(job_schema())
    assert set(found) == set(job_schema()["$defs"])
    assert len(set(found.values())) == len(found)
    assert found["OpposingForce"] == "`[[load]]` with `opposes`"
    assert found["SectionLink"] == "`[mechanism] crank, rod` with `width`"
    assert found["LengthBounds"] == "Bounds: length"


def test_reference_of_quantities_has_a_section_and_a_row_for_each() -> None:
    page = quantity_reference()
    headings = re.findall(r"^### (\w+)$", page, re.MULTILINE)
    assert sorted(headings) == sorted(FACTS)
    assert sorted(re.findall(r"^\| \[`(\w+)`\]\(#\1\) \|", page, re.MULTILINE)) == sorted(FACTS)
    theory = (hooks.ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    assert {of.section for of in FACTS.values()} <= set(re.findall(r"^## (.+)$", theory, re.MULTILINE))


@pytest.mark.parametrize("name", FACTS)
def test_a_section_of_a_quantity_defines_it(name: str) -> None:
    of, text = FACTS[name], section(FACTS[name])
    for fact in (
        of.sentence,
        of.advice,
        of.formula,
        of.field,
        of.kind.metric.symbol,
        *(need.rule for need in of.needs),
    ):
        assert fact in text
    assert ("may be negative" in text) == of.signed
    assert text.count("`") % 2 == 0
    assert "{instead}" not in text
    assert "got " not in text
    (limits,) = tomllib.loads(requirement(of)).values()
    assert list(limits.values()) == [of.usual_value]
    assert list(limits) == [{"low": "max", "high": "min", "": "equals"}[of.better]]


def test_reference_of_the_api_names_every_operation() -> None:
    page = api_reference()
    for operation in ("GET /api/v1/health/live", "POST /api/v1/jobs", "GET /api/v1/jobs/{number}/export.parquet"):
        assert f"### {operation}\n" in page
    assert "| `idempotency-key` | header |" in page
    assert "](#submission)" in page
    assert "### Submission\n" in page


def test_reference_of_python_has_the_public_names_and_every_module(pytestconfig: pytest.Config) -> None:
    front_door = front_door_reference()
    functions = [name for name in slidercrank.__all__ if callable(getattr(slidercrank, name))]
    assert [name for name in functions if f"heading: {name}\n" not in front_door] == []
    page = folder_reference("objectives")
    modules = [file for file in (pytestconfig.rootpath / "objectives").rglob("*.py") if file.name != "__init__.py"]
    assert page.count("\n::: slidercrank.objectives.") == len(modules)


@pytest.mark.parametrize(
    ("schema", "words"),
    [
        ({"$ref": "#/$defs/LengthBounds"}, "[LengthBounds](#lengthbounds)"),
        ({"anyOf": [{"type": "number"}, {"type": "null"}, {"type": "number"}]}, "number or null"),
        ({"type": "array", "items": {"enum": ["a", 1]}}, 'list of `"a"`, `1`'),
        ({"type": "object", "additionalProperties": {"type": "boolean"}}, "table of true or false"),
        ({}, "anything"),
    ],
)
def test_kinds_of_values_are_told_in_words(schema: dict[str, Any], words: str) -> None:
    assert kind(schema) == words


def test_links_stay_within_the_site_or_lose_their_target() -> None:
    text = (
        "[a](../model/linkage/linkage.py), [b](../README.md#start), [c](../Makefile), [d](jobs.md), [e](https://e.org)"
        ", [f](commands.md#quantities)"
    )
    assert hooks.on_page_markdown(text) == (
        "[a][slidercrank.model.linkage.linkage], [b](index.md#start), c, [d](jobs.md), [e](https://e.org)"
        ", [f](reference/quantities.md)"
    )


def test_links_of_the_reference_into_the_guide_stay() -> None:
    text = "[a](../theory.md#2-closed-forms), ![b](../sketch.svg)"
    assert hooks.on_page_markdown(text) == text


def test_examples_of_docstrings_are_code() -> None:
    text = "Length.\n\n>>> a = 1\n>>> a + 1\n2\n\nThe end."
    assert with_code(text) == "Length.\n\n```pycon\n>>> a = 1\n>>> a + 1\n2\n```\n\nThe end."


def test_formulas_become_mathml() -> None:
    made = hooks.on_page_content('<p><span class="arithmatex">\\(l &gt; r\\)</span></p>')
    assert made.startswith('<p><math xmlns="http://www.w3.org/1998/Math/MathML" display="inline">')
    assert "<mo>&#x0003E;</mo>" in made
