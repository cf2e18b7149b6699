"""The documentation: its links lead somewhere, its formulas can be shown, its numbers are those of the code."""

import json
import math
import re
import shlex
import tomllib
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

from benchmarks import glossary_sketch
from docs.site import hooks
from slidercrank.model.errors import JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import load_job, parse_job, with_file_contents
from slidercrank.optimise.search.stroke_warnings import stroke_warnings
from slidercrank.optimise.solve import solve
from slidercrank.service.api.preview import AllowedModel, PreviewModel
from slidercrank.service.cli import app
from tests.packaging.feeder import numbers

LINK = re.compile(r"\[[^\]\n]*\]\(([^)\s]+)\)")
MODULE = re.compile(r"`((?:model|objectives|optimise|service|runs|tests|benchmarks|docs)/[\w./]*)`")
ROW = re.compile(r"^\| ([^|]+) \| (-?\d+\.\d+) \| [^|]*\|$", re.MULTILINE)


@pytest.fixture(scope="module")
def root(pytestconfig: pytest.Config) -> Path:
    return pytestconfig.rootpath


@pytest.fixture(scope="module")
def pages(root: Path) -> dict[Path, str]:
    files = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
    return {file: file.read_text(encoding="utf-8") for file in files}


@pytest.fixture(scope="module")
def theory(root: Path) -> str:
    return (root / "docs" / "theory.md").read_text(encoding="utf-8")


def prose(page: str) -> str:
    """Return a page without its fenced blocks."""
    return re.sub(r"^```.*?^```$", "", page, flags=re.MULTILINE | re.DOTALL)


def anchor(heading: str) -> str:
    """Return the anchor that GitHub gives a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def test_relative_links_of_the_pages_lead_to_files(pages: dict[Path, str]) -> None:
    found, broken = 0, []
    for file, page in pages.items():
        for target in LINK.findall(prose(page)):
            path = target.partition("#")[0]
            if path and "://" not in target:
                found += 1
                generated = file.parent.name == "docs" and path in hooks.pages()
                broken += [] if generated or (file.parent / path).exists() else [f"{file.name}: {target}"]
    assert found > 40
    assert broken == []


def test_links_within_a_page_lead_to_headings(pages: dict[Path, str]) -> None:
    found, broken = 0, []
    for file, page in pages.items():
        headings = {anchor(heading) for heading in re.findall(r"^#+ (.+)$", prose(page), re.MULTILINE)}
        for target in LINK.findall(prose(page)):
            if target.startswith("#"):
                found += 1
                broken += [] if target[1:] in headings else [f"{file.name}: {target}"]
    assert found > 20
    assert broken == []


def test_files_that_the_pages_name_exist(pages: dict[Path, str], root: Path) -> None:
    named = {path for page in pages.values() for path in MODULE.findall(prose(page))}
    assert "runs/feeder.toml" in named
    assert {path for path in named if not (root / path).exists()} == set()


def test_every_model_module_with_a_formula_is_named_by_the_theory(theory: str, root: Path) -> None:
    # `analytic` marks physical formulas.
    modules = {
        file.relative_to(root).as_posix()
        for file in (root / "model").rglob("*.py")
        if re.search("^@analytic$", file.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert "model/kinematics/position.py" in modules
    linked = {target.removeprefix("../") for target in LINK.findall(theory)}
    assert modules - linked == set(), "derive its equations in docs/theory.md"


def test_formulas_use_only_what_github_shows(theory: str) -> None:
    # In $...$ Markdown takes a backslash before punctuation as its own, and * as emphasis; \operatorname is refused.
    assert theory.count("```") % 2 == 0
    text = re.sub(r"`[^`\n]*`", "", prose(theory))
    for paragraph in text.split("\n\n"):
        assert paragraph.count("$") % 2 == 0, paragraph
    inline = re.findall(r"\$([^$]+)\$", text)
    assert len(inline) > 200
    assert [formula for formula in inline if re.search(r"\\[^a-zA-Z]|[*<\n]", formula)] == []
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert [row for row in rows if any("|" in formula for formula in re.findall(r"\$([^$]+)\$", row))] == []
    blocks = re.findall(r"^```math\n(.*?)^```$", theory, re.MULTILINE | re.DOTALL)
    assert len(blocks) > 50
    for formula in [*inline, *blocks]:
        assert "operatorname" not in formula
        bare = re.sub(r"\\[{}]", "", formula)
        assert bare.count("{") == bare.count("}"), formula
        assert formula.count(r"\begin") == formula.count(r"\end"), formula


def test_numbers_of_the_worked_example_are_those_of_the_code(theory: str) -> None:
    printed = dict(ROW.findall(theory))
    computed = numbers()
    assert list(printed) == list(computed)
    wrong = {}
    for name, text in printed.items():
        unit = 10.0 ** -len(text.partition(".")[2])
        # Half a unit of the last digit, and a little for halves that rounding moves.
        if abs(float(text) - computed[name]) > 0.501 * unit:
            wrong[name] = (text, computed[name])
    assert wrong == {}


def points(file: Path) -> dict[str, tuple[float, float]]:
    """Return the circles of a drawing by their names, counted from the crank pivot, y upwards."""
    circles = [element for element in ElementTree.parse(file).iter() if element.tag.endswith("}circle")]
    named = {
        circle.attrib["id"]: (float(circle.attrib["cx"]), float(circle.attrib["cy"]))
        for circle in circles
        if "id" in circle.attrib
    }
    x, y = named["crank-pivot"]
    return {name: (at[0] - x, y - at[1]) for name, at in named.items()}


def arrow(file: Path, name: str) -> tuple[float, float]:
    """Return the vector of a named line of a drawing, y upwards."""
    for element in ElementTree.parse(file).iter():
        if element.attrib.get("id") == name:
            x1, y1, x2, y2 = (float(element.attrib[key]) for key in ("x1", "y1", "x2", "y2"))
            return x2 - x1, y1 - y2
    raise AssertionError(f"{file.name} has no line called {name}")


def linkage_of_sketch(file: Path) -> tuple[Linkage, float]:
    """Return the linkage of the sketch of signs, with pixels as metres, and its crank angle."""
    at = points(file)
    (ax, ay), (bx, by) = at["crank-pin"], at["slider-pin"]
    return Linkage(math.hypot(ax, ay), math.hypot(bx - ax, by - ay), by), math.atan2(ay, ax)


def test_the_sketch_shows_the_signs_of_the_code(root: Path) -> None:
    file = root / "docs" / "sketch.svg"
    linkage, angle = linkage_of_sketch(file)
    at = points(file)
    pixel = 0.02  # coordinates are given to a hundredth
    assert linkage.rotates_fully
    assert 0.0 < angle < 0.5 * math.pi
    assert linkage.offset > 0.0
    open_branch, crossed = (
        Linkage(linkage.crank, linkage.rod, linkage.offset, branch).at(angle) for branch in ("open", "crossed")
    )
    assert float(open_branch.slider_position) == pytest.approx(at["slider-pin"][0], abs=pixel)
    assert float(crossed.slider_position) == pytest.approx(at["slider-pin-crossed"][0], abs=pixel)
    assert at["slider-pin-crossed"][1] == pytest.approx(linkage.offset, abs=pixel)
    assert float(open_branch.rod_angle) > 0.0
    # Outward: where the distance from the crank pivot grows.
    assert arrow(file, "load")[0] > 0.0
    assert arrow(file, "outward-open")[0] > 0.0
    assert arrow(file, "outward-crossed")[0] < 0.0
    assert arrow(file, "guide") == pytest.approx((0.0, 85.0))


def test_the_sketch_of_the_dead_centres_is_to_scale(root: Path) -> None:
    at = points(root / "docs" / "dead_centres.svg")
    linkage, _ = linkage_of_sketch(root / "docs" / "sketch.svg")
    pixel = 0.02
    inner, outer = linkage.dead_centres
    assert (float(inner), linkage.offset) == pytest.approx(at["inner"], abs=pixel)
    assert (float(outer), linkage.offset) == pytest.approx(at["outer"], abs=pixel)
    for name, angle in zip(("inner", "outer"), linkage.dead_centre_angles, strict=True):
        pin = at[f"{name}-crank-pin"]
        assert pin == pytest.approx((linkage.crank * math.cos(angle), linkage.crank * math.sin(angle)), abs=pixel)
    # Counter-clockwise the inward stroke, from the outer to the inner dead centre, takes pi + b: the slow one.
    assert linkage.slow_stroke(direction=1.0) == "inward"


def test_the_sketch_of_the_glossary_is_made_by_its_script_and_names_terms_of_the_page(
    root: Path, pages: dict[Path, str]
) -> None:
    file = root / "docs" / "glossary.svg"
    assert file.read_text(encoding="utf-8") == glossary_sketch.sketch()
    texts = [element.text or "" for element in ElementTree.parse(file).iter() if element.tag.endswith("}text")]
    assert len(texts) > 14
    machine = pages[root / "docs" / "glossary.md"].split("## The problem")[0]
    terms = {term.strip() for row in re.findall(r"^\| ([^|]+) \|", machine, re.MULTILINE) for term in row.split(",")}
    assert {text for text in texts if text.removeprefix("inner ").removeprefix("outer ") not in terms} == set()


def test_every_term_of_the_glossary_is_explained_once(root: Path, pages: dict[Path, str]) -> None:
    rows = re.findall(r"^\| ([^|]+) \| \S", pages[root / "docs" / "glossary.md"], re.MULTILINE)
    terms = [term.strip() for row in rows if row not in ("term", "---") for term in row.split(",")]
    assert len(terms) > 70
    assert [term for term in terms if terms.count(term) > 1] == []


def _tables(page: str) -> list[dict[str, Any]]:
    return [tomllib.loads(block) for block in re.findall(r"^```toml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)]


def test_the_parts_of_jobs_that_the_pages_show_are_valid(pages: dict[Path, str], root: Path, tmp_path: Path) -> None:
    """Each is added to the whole job at the beginning of the page; keys of tables in both are merged.

    A swing has requirements and objectives of its own; a time of the cycle takes the place of the speed.
    """
    whole, *parts = _tables(pages[root / "docs" / "jobs.md"])
    assert len(parts) >= 5
    (table,) = re.findall(r"^```csv\n(name,.*?)^```$", pages[root / "docs" / "jobs.md"], re.MULTILINE | re.DOTALL)
    (tmp_path / "gearmotors.csv").write_text(table)
    (tmp_path / "trace.csv").write_text("crank angle (deg),force (kN)\n0,-0.2\n180,0\n")
    for part in [{}, *parts]:
        job = {**whole, **part}
        for name in part:
            if isinstance(whole.get(name), dict) and "motion" not in part:
                job[name] = {**whole[name], **part[name]}
        if "cycle_time" in job["mechanism"]:
            del job["mechanism"]["speed"]
        assert parse_job(with_file_contents(job, tmp_path)).name == "Press feed"


@pytest.mark.slow
def test_a_job_has_room_for_as_many_tables_of_loads_as_the_page_says(pages: dict[Path, str], root: Path) -> None:
    text = " ".join(pages[root / "docs" / "jobs.md"].split())
    said = re.search(r"enough for (\w+) tables of loads with ([\d,]+) points", text)
    assert said is not None
    count, points = ["none", "one", "two", "three", "four", "five"].index(said[1]), int(said[2].replace(",", ""))
    whole, *_ = _tables(pages[root / "docs" / "jobs.md"])
    table = {"positions": [1e-4 * place for place in range(points)], "forces": [-1.0] * points}
    assert len(parse_job({**whole, "load": [table] * count}).mechanism.loads) == count
    with pytest.raises(JobError, match="at most 50000 values"):
        parse_job({**whole, "load": [table] * (count + 1)})


@pytest.mark.parametrize("page", ["optimisers.md", "sizing.md"])
@pytest.mark.slow
def test_convex_programmes_of_the_pages_run(page: str, pages: dict[Path, str], root: Path, tmp_path: Path) -> None:
    """On the first job of docs/jobs.md with the costs and sections of that page."""
    costs = next(part for part in _tables(pages[root / "docs" / "jobs.md"]) if "costs" in part)
    whole, *_ = _tables(pages[root / "docs" / "jobs.md"])
    (tmp_path / "job.json").write_text(json.dumps({**whole, **costs}))
    lines = re.findall(r"slidercrank ((?:allocate|balance|sections) JOB [^#`\n]*)", pages[root / "docs" / page])
    assert lines
    for line in lines:
        words = (str(tmp_path / "job.json") if word == "JOB" else word for word in shlex.split(line))
        done = CliRunner().invoke(app, [*words])
        assert done.exit_code == 0, f"{line}: {done.output}"


def test_the_tree_of_the_architecture_has_every_folder(pages: dict[Path, str], root: Path) -> None:
    tree = pages[root / "docs" / "architecture.md"].split("```text\n")[1].split("```")[0]
    named = {folder for folders in re.findall(r"^ *((?:[a-z_]+/ )+)", tree, re.MULTILINE) for folder in folders.split()}
    tops = ("model", "objectives", "optimise", "service")
    folders = {f"{file.parent.name}/" for top in tops for file in (root / top).glob("*/__init__.py")}
    assert len(folders) > 40
    assert folders - named == set()


def test_the_parts_of_a_preview_are_those_that_the_page_lists(pages: dict[Path, str], root: Path) -> None:
    section = pages[root / "docs" / "api.md"].split("## Write a job")[1].split("\n## ")[0]
    fields = {*PreviewModel.model_fields, *AllowedModel.model_fields}
    assert {field for field in fields if f"`{field}`" not in section} == set()


def test_the_first_job_of_the_page_presses_slowly(pages: dict[Path, str], root: Path) -> None:
    whole, *_ = _tables(pages[root / "docs" / "jobs.md"])
    problem = parse_job({**whole, "optimiser": {"designs": 10, "samples": 500}})
    assert stroke_warnings(problem) == []
    front = solve(problem)
    assert set(front.designs["loaded_stroke"]) == {"outward"}
    assert set(front.designs["slow_stroke"]) == {"outward"}
    assert (front.dimensions[:, 2] < 0.0).all()


@pytest.mark.parametrize("job", ["feeder", "sieve", "support", "compressor", "press", "servo_press", "tipper"])
def test_no_shipped_job_loads_its_fast_stroke(job: str, root: Path) -> None:
    assert stroke_warnings(load_job(root / "runs" / f"{job}.toml")) == []
