"""Without extras the library and `optimise` work, and what needs an extra names it."""

import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

pytestmark = pytest.mark.slow
DEVELOPMENT = {"test", "benchmark", "docs"}  # extras of those who work on the project
COMMAND = "from slidercrank.service.cli import main; main()"
LENGTHS = ("--crank", "50 mm", "--rod", "200 mm", "--offset", "10 mm")
PRESS = """
name = "Press"
[mechanism]
speed = "120 rpm"
crank = { width = "30 mm", depth = "20 mm", density = "7850 kg/m^3" }
rod = { width = "30 mm", depth = "20 mm", density = "7850 kg/m^3" }
slider = { mass = "4 kg" }
gravity = "9.81 m/s^2"
[[load]]
force = "2 kN"
opposes = "outward stroke"
[tolerances]
crank = "0.05 mm"
rod = "0.1 mm"
[costs]
crank = { cost = 8.0, at = "0.05 mm" }
rod = { cost = 6.0, at = "0.1 mm" }
[sections]
pins = { crank_pivot = "15 mm", crank_pin = "12 mm", slider_pin = "10 mm" }
[sections.material]
density = "7850 kg/m^3"
elasticity = "207 GPa"
yield_strength = "350 MPa"
ultimate_strength = "520 MPa"
endurance = "150 MPa"
bearing_pressure = "20 MPa"
[variables]
crank = "50 mm"
rod = ["100 mm", "400 mm"]
offset = "10 mm"
[objectives]
peak_torque = "minimise"
[optimiser]
method = "minimax"
"""


@pytest.fixture(scope="module")
def root(pytestconfig: pytest.Config) -> Path:
    return pytestconfig.rootpath


@pytest.fixture(scope="module")
def project(root: Path) -> dict[str, Any]:
    with (root / "pyproject.toml").open("rb") as file:
        found: dict[str, Any] = tomllib.load(file)["project"]
    return found


def installed_with(wanted: Iterator[Requirement] | list[Requirement], seen: set[str]) -> set[str]:
    """Return the distributions that requirements bring, those of their requirements included."""
    for requirement in wanted:
        name = canonicalize_name(requirement.name)
        extras = ["", *requirement.extras]
        key = f"{name}{sorted(extras)}"
        if key in seen or (requirement.marker and not requirement.marker.evaluate({"extra": ""})):
            continue
        seen |= {key, name}
        try:
            needs = [Requirement(line) for line in requires(requirement.name) or []]
        except PackageNotFoundError:  # of another platform
            continue
        for need in needs:
            if need.marker is None or any(need.marker.evaluate({"extra": extra}) for extra in extras):
                need.marker = None
                installed_with([need], seen)
    return seen


@pytest.fixture(scope="module")
def script(project: dict[str, Any]) -> str:
    """Python that lets only modules of a light installation be found, to be followed by what is to run."""
    light = installed_with([Requirement(line) for line in project["dependencies"]], {"slidercrank"})
    gone = sorted(
        module
        for module, homes in packages_distributions().items()
        if module.isidentifier() and not {canonicalize_name(home) for home in homes} & light
    )
    assert {"matplotlib", "cvxpy", "ezdxf", "fastapi", "uvicorn", "httpx", "distributed", "pyarrow", "PIL"} <= {*gone}
    assert {"numpy", "numba", "sqlalchemy", "optuna", "rich", "slidercrank"}.isdisjoint(gone)
    return f"""
import sys
class Light:
    def __init__(self, finder):
        self.finder = finder
    def __getattr__(self, name):
        return getattr(self.finder, name)
    def find_spec(self, name, path=None, target=None):
        return None if name.partition(".")[0] in {gone!r} else self.finder.find_spec(name, path, target)
sys.meta_path[:] = [Light(finder) for finder in sys.meta_path]
"""


def run(script: str, place: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python in a light installation, in a folder."""
    command = [sys.executable, "-c", script, *arguments]
    return subprocess.run(command, cwd=place, capture_output=True, text=True, check=False, timeout=500)


@pytest.fixture(scope="module")
def place(script: str, root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run that a light installation has made."""
    folder = tmp_path_factory.mktemp("light")
    done = run(f"{script}{COMMAND}", folder, "optimise", str(root / "runs/feeder.toml"), "--designs", "8", "--json")
    assert done.returncode == 0, done.stderr
    assert len(json.loads(done.stdout)["designs"]) == 8
    assert 'no figures drawn: they need the extra "figures": pip install "slidercrank[figures]"' in done.stderr
    (folder / "press.toml").write_text(PRESS, encoding="utf-8")
    return folder


def commands(script: str, place: Path, lines: list[list[str]]) -> list[tuple[int, str]]:
    """Run commands one after the other in one light process; return exit code and output of each."""
    code = f"""{script}
import json
from typer.testing import CliRunner
from slidercrank.service.cli import app
done = [CliRunner().invoke(app, line) for line in json.loads(sys.argv[1])]
sys.__stdout__.write(json.dumps([(one.exit_code, one.output) for one in done]))
"""
    done = run(code, place, json.dumps(lines))
    assert done.returncode == 0, done.stderr
    found: list[tuple[int, str]] = json.loads(done.stdout)
    return found


def test_library_and_commands_work_without_extras(script: str, place: Path, root: Path) -> None:
    job = str(root / "runs/feeder.toml")
    lines = [
        ["--help"],
        ["check", job],
        ["schema"],
        ["front", "latest", "--knee"],
        ["export", "latest", "--csv", "front.csv", "--json", "front.json", "--svg", "linkage.svg", "--knee"],
        ["analyse", job, *LENGTHS, "--show", "friction", "--show", "tolerances"],
        ["optimise", job, "--no-figures", "--designs", "4"],
        ["like", "latest", "1", "--where", "transmission_angle >= 30 deg"],
        ["round", "latest", "1", "--to", "0.5 mm"],
        ["compare", "1", "2"],
        ["jobs"],
        ["submit", job, "--store", "others.db"],
        ["cancel", "latest", "--store", "others.db"],
        ["doctor"],
        ["cases", "--case", "1"],
    ]
    for line, (code, output) in zip(lines, commands(script, place, lines), strict=True):
        assert code == 0, f"{line}: {output}"
        assert "slidercrank[" not in output, f"{line}: {output}"
    assert (place / "linkage.svg").stat().st_size > 1000


def test_every_command_that_needs_an_extra_names_it(script: str, place: Path) -> None:
    extras = {
        "convex": [
            ["allocate", "press.toml", *LENGTHS, "--limit", "1 mm"],
            ["balance", "press.toml", *LENGTHS, "--radius", "60 mm"],
            ["sections", "press.toml", *LENGTHS],
            ["optimise", "press.toml", "--no-figures", "--runs", "others"],  # by the method minimax
        ],
        "dask": [["optimise", "press.toml", "--scheduler", "tcp://127.0.0.1:1", "--runs", "others"]],
        "export": [["export", "latest", "--knee", "--dxf", "linkage.dxf"]],
        "figures": [
            ["optimise", "press.toml", "--figures", "--runs", "others"],
            ["report", "latest", "--knee", "--out", "report.html"],
            ["export", "latest", "--knee", "--gif", "linkage.gif"],
            ["analyse", "press.toml", *LENGTHS, "--figures", "figures"],
            ["compare", "latest", "latest", "--figures", "figures"],
            ["sweep", "press.toml", "--over", "rod=90 mm..99 mm:3", "--of", "stroke", "--figures", "figures"],
            ["cases", "--figures", "figures"],
            ["allocate", "press.toml", *LENGTHS, "--limit", "1 mm", "--figures", "figures"],
            ["balance", "press.toml", *LENGTHS, "--radius", "60 mm", "--figures", "figures"],
        ],
        "mcp": [["mcp"]],
        "postgres": [["jobs", "--store", "postgresql://127.0.0.1:1/jobs"]],
        "service": [["serve", "--port", "0"], ["worker", "--drain"]],
    }
    lines = [line for group in extras.values() for line in group]
    wanted = [extra for extra, group in extras.items() for _ in group]
    for line, extra, (code, output) in zip(lines, wanted, commands(script, place, lines), strict=True):
        assert code == 2, f"{line}: {output}"
        output = re.sub("^warning: .*\n", "", output)  # about the job
        assert re.fullmatch(r'slidercrank: [^"\n]+ needs? the extra "(\w+)", .*\n', output), f"{line}: {output}"
        assert f'the extra "{extra}", which is not installed' in output, f"{line}: {output}"
        assert f'pip install "slidercrank[{extra}]"' in output, f"{line}: {output}"
    assert not (place / "figures").exists()


def test_python_raises_an_error_of_the_project(script: str, tmp_path: Path) -> None:
    code = """
from importlib import import_module
from slidercrank.model.errors import SlidercrankError
for name in sys.argv[1:]:
    try:
        import_module(name)
    except SlidercrankError as error:
        print(error)
"""
    names = ["slidercrank.service.figures.style", "slidercrank.service.api.app", "slidercrank.service.client"]
    done = run(f"{script}{code}", tmp_path, *names)
    assert done.returncode == 0, done.stderr
    assert re.findall(r'the extra "(\w+)"', done.stdout) == ["figures", "service", "service"]


def test_every_plot_names_the_extra_for_figures(script: str, root: Path, tmp_path: Path) -> None:
    code = f"""
import slidercrank as sc
from slidercrank.model.errors import MissingExtra
linkage = sc.Linkage(crank=0.04, rod=0.1, offset=0.02)
analysis = sc.analyse(sc.Mechanism(speed=3.0, slider_mass=1.0), (0.04, 0.1, 0.02))
front = sc.solve(sc.load_job({str(root / "runs/feeder.toml")!r}))
for plot in (linkage.plot, analysis.plot, front.plot):
    try:
        plot()
    except MissingExtra as error:
        print(error)
"""
    done = run(f"{script}{code}", tmp_path)
    assert done.returncode == 0, done.stderr
    line = 'figures need the extra "figures", which is not installed; install it: pip install "slidercrank[figures]"'
    assert done.stdout.splitlines() == [line] * 3


def test_every_package_belongs_to_one_extra_and_all_has_those_of_every_command(project: dict[str, Any]) -> None:
    extras = {name: [Requirement(line) for line in lines] for name, lines in project["optional-dependencies"].items()}
    uses = {name: needs for name, needs in extras.items() if name not in DEVELOPMENT | {"all"}}
    packages = [need.name for needs in uses.values() for need in needs if need.name != "slidercrank"]
    packages += [Requirement(line).name for line in project["dependencies"]]
    assert len(packages) == len(set(packages))
    (everything,) = extras["all"]
    ours = {"convex", "dask", "export", "figures", "mcp", "parquet", "postgres", "service"}
    assert ours <= everything.extras <= set(uses)
