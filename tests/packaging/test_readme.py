"""README, docs/start.md and docs/commands.md: short, true, and everything in them runs."""

from __future__ import annotations

import contextlib
import re
import shlex
import shutil
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from PIL import Image
from typer.testing import CliRunner

import slidercrank
from benchmarks.gallery_pictures import Machine, machines
from benchmarks.moving_picture import visits
from slidercrank.service.cli import app
from tests.optimise.problems import shipped_front

PICTURE = "exploring_front.gif"


@pytest.fixture(scope="module")
def root(pytestconfig: pytest.Config) -> Path:
    return pytestconfig.rootpath


@pytest.fixture(scope="module")
def readme(root: Path) -> str:
    return (root / "README.md").read_text(encoding="utf-8")


def page(root: Path, name: str) -> str:
    return (root / "docs" / name).read_text(encoding="utf-8")


def blocks(text: str, kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands(text: str) -> list[str]:
    """Return the lines of shells that call slidercrank, without their comments."""
    lines = (line.split("  #")[0].strip() for block in blocks(text, "sh") for line in block.splitlines())
    return [line.partition("slidercrank ")[2] for line in lines if "slidercrank " in line]


def test_the_readme_is_one_screen_and_begins_with_a_moving_picture(readme: str, root: Path) -> None:
    assert len(readme.split()) <= 900
    before, picture, _ = readme.partition(f"](docs/{PICTURE})")
    assert picture
    assert len(before.splitlines()) < 10
    assert "|" not in before
    assert (root / "docs" / PICTURE).stat().st_size < 1.5e6
    with Image.open(root / "docs" / PICTURE) as moving:
        assert getattr(moving, "n_frames", 1) == len(visits(100, 56))


def test_the_picture_visits_every_stretch_of_the_front_and_rests_at_its_knee() -> None:
    shown = visits(100, 56)
    assert {0, 56, 99} < set(shown)
    assert max(abs(a - b) for a, b in zip(shown, shown[1:] + shown[:1], strict=True)) <= 6
    assert max(set(shown), key=shown.count) == 56


@pytest.mark.slow
def test_the_python_of_the_readme_draws_its_figure(readme: str, root: Path, tmp_path: Path) -> None:
    (code,) = blocks(readme, "python")
    shutil.copytree(root / "runs", tmp_path / "runs")
    plt.switch_backend("agg")
    with contextlib.chdir(tmp_path):
        exec(code, {})
    texts = plt.gca().get_legend()
    assert texts is not None
    ratios = shipped_front("feeder").columns["time_ratio"][[0, shipped_front("feeder").knee(), -1]]
    assert [text.get_text() for text in texts.get_texts()] == [f"time ratio {ratio:.2f}" for ratio in ratios]
    plt.close("all")
    assert (tmp_path / "torque.png").stat().st_size > 10_000


def test_windows_types_what_the_workflow_runs(readme: str, root: Path) -> None:
    (typed,) = blocks(readme, "powershell")
    assert blocks(page(root, "start.md"), "powershell") == [typed]
    workflow = (root / ".github/workflows/checks.yml").read_text(encoding="utf-8")
    lines = [line.strip() for line in workflow.splitlines()]
    begin = lines.index(typed.splitlines()[0])
    assert lines[begin : begin + len(typed.splitlines())] == typed.splitlines()


def test_the_table_of_extras_has_each_one_for_users(root: Path) -> None:
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    listed = {
        name for row in re.findall(r"^\| (`.*?) \|", page(root, "start.md"), re.MULTILINE) for name in row.split(", ")
    }
    listed = {name.strip("`") for name in listed}
    (every,) = project["optional-dependencies"]["all"]
    named = set(every.partition("[")[2].rstrip("]").split(","))
    assert {*named, "all", "notebook"} == {name for name in listed if name in project["optional-dependencies"]}


@pytest.mark.slow
def test_the_front_of_the_first_page_is_that_of_the_feeder(root: Path) -> None:
    front, text = shipped_front("feeder"), page(root, "start.md")
    rows = re.findall(r"^ *(\d+) +([\d.* ]+?)(?: knee)? *$", text, re.MULTILINE)
    assert len(rows) == 6
    names = "crank_mm rod_mm offset_mm time_ratio peak_torque_Nm least_transmission_angle_deg position_error_mm"
    for number, cells in rows:
        for key, cell in zip(names.split(), cells.replace("*", " ").split(), strict=True):
            last = 10.0 ** -len(cell.partition(".")[2])
            assert abs(front.columns[key][int(number) - 1] - float(cell)) <= 0.501 * last, (number, key)
    assert f"\n {front.knee() + 1} " in text
    for sentence in front.trade_offs(front.knee())[:2]:
        assert sentence in text


@pytest.mark.slow
@pytest.mark.parametrize("job", ["feeder", "sieve", "support", "compressor", "press", "servo_press", "tipper"])
def test_the_gallery_has_the_knee_of_each_front(job: str, root: Path) -> None:
    (part,) = (part for part in page(root, "gallery.md").split("\n## ") if f"Job: `runs/{job}.toml`.\n" in part)
    told = re.search(r"^Knee: crank ([\d.]+) mm, rod ([\d.]+) mm, offset (-?[\d.]+) mm\.$", part, re.MULTILINE)
    assert told is not None
    front = shipped_front(job)
    knee = [
        f"{front.columns[f'{name}_mm'][front.knee()]:#.4g}".removesuffix(".") for name in ("crank", "rod", "offset")
    ]
    assert list(told.groups()) == knee


@pytest.mark.slow
@pytest.mark.parametrize("machine", list(machines()), ids=lambda machine: machine.job["name"])
def test_the_gallery_has_the_knee_and_the_numbers_of_each_job_of_the_page(machine: Machine, root: Path) -> None:
    problem = slidercrank.problem(machine.job)
    front = slidercrank.solve(problem)
    lengths = [1e3, 1e3, 1e3, *[1.0] * (front.dimensions.shape[1] - 3)]
    knee = front.dimensions[front.knee()] * lengths
    assert machine.knee == [f"{number:#.4g}".removesuffix(".") for number in knee]
    (learned,) = re.findall(
        rf'^name = "{machine.job["name"]}"$.*?\*\*Learned\*\*: (.*?)\n\n',
        page(root, "gallery.md"),
        re.MULTILINE | re.DOTALL,
    )
    crank, rod, offset, *others = front.dimensions[front.knee()]
    ends = front.designs.iloc[[0, -1]]
    match machine.job["name"]:
        case "Power hacksaw":
            ratio, length = (ends[name].max() / ends[name].min() for name in ("time_ratio", "envelope_length_mm"))
            numbers = [f"{100 * (ratio - 1):.0f} %", f"{100 * (length - 1):.0f} %"]
        case "Four-stroke engine":
            sizes = ((e, float(slidercrank.crank_from_stroke(0.086, rod=rod, offset=e))) for e in (0.0, offset, -0.008))
            numbers = [f"{problem.analyse([r, rod, e])['peak_guide_force']:,.0f} N" for e, r in sizes]
        case "Needle loom":
            masses = (0.0, others[0], 8.5)
            forces = (problem.analyse([crank, rod, offset, mass])["peak_shaking_force"] for mass in masses)
            numbers = [f"{1e-3 * force:#.4g} kN" for force in forces]
        case "Loom sley":
            numbers = [f"{angle:.1f} deg" for angle in ends["dwell_angle_deg"]]
            numbers += [f"{acceleration:.1f} m/s^2" for acceleration in ends["peak_slider_acceleration_m_s2"]]
        case _:
            numbers = [f"{error:.3f} mm" for error in ends["position_error_mm"]]
    assert [number for number in numbers if number not in learned] == []


def test_bibtex_says_what_the_citation_file_says(root: Path) -> None:
    (entry,) = blocks(page(root, "start.md"), "bibtex")
    fields = dict(re.findall(r"(\w+) += \{+([^}]+)\}+", entry))
    cited = (root / "CITATION.cff").read_text(encoding="utf-8")
    stated = dict(re.findall(r"^(?:  - )?(\w+): (\S.*)$", cited, re.MULTILINE))
    preferred = dict(re.findall(r"^ +(?:- )?(\w+): (\S.*)$", cited.partition("preferred-citation:")[2], re.MULTILINE))
    shared = {key: stated[key] for key in ("title", "version", "license")}
    assert preferred == {"type": stated["type"], "name": stated["name"], "year": fields["year"], **shared}
    assert fields == {"author": stated["name"], "year": preferred["year"], **shared}
    assert fields["version"] == slidercrank.__version__


def test_the_readme_quotes_a_trade_off_of_the_knee(readme: str) -> None:
    front = shipped_front("feeder")
    quoted = re.search(r'"(1 deg more [^"]+)\."', readme)
    assert quoted is not None
    assert quoted[1] in front.trade_offs(front.knee())


@pytest.mark.slow
def test_every_command_of_the_page_runs(root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(root / "runs", tmp_path / "runs")
    monkeypatch.chdir(tmp_path)
    listed = commands(page(root, "commands.md"))
    assert len(listed) > 12
    for line in listed:
        done = CliRunner().invoke(app, shlex.split(line))
        assert done.exit_code == 0, f"{line}: {done.output}"
