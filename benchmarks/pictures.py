"""The pictures of README and docs, made anew: `make pictures`, or `python -m benchmarks.pictures [NAME ...]`.

On a quiet machine: a run's time is on the pictures of the page, and the courses of methods are measured (minutes).
"""

from __future__ import annotations

import contextlib
import math
import re
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path

from playwright.sync_api import Page, expect

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.optimise.job import load_job, parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.drawings.design_drawing import linkage_drawing
from slidercrank.service.figures.front_figures import write_front_figures
from slidercrank.service.figures.panel_drawing import save_figure
from slidercrank.service.figures.shape_painting import drawing_figure
from slidercrank.service.figures.style import save_png
from slidercrank.service.jobs.submission import submit
from slidercrank.service.questions.cylinders import analysis as cylinders
from slidercrank.service.questions.indicator import analysis as indicator
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service.page.browser import chromium

from . import gallery_pictures, glossary_sketch, load_pictures
from .moving_picture import exploring_front
from .service_process import service

README = Path(__file__).parents[1] / "README.md"
FOLDER = README.parent / "docs"
MOST_SECONDS = 5.0
"""Time of the feeder's search that is shown at most: on a quiet machine it takes about one."""
_JOB = Path(__file__).parents[1] / "runs" / "feeder.toml"
_COMPRESSOR = Linkage(0.03, 0.11, -0.01)
"""Of docs/machines.md."""
_KNEE_ANGLE = 120  # deg, where all forces of the feeder are clear of each other


def require_quick(seconds: float) -> None:
    """End the program if a search took longer than it does on a quiet machine: readers would take it for the rule."""
    if not seconds <= MOST_SECONDS:
        raise SystemExit(
            f"a search that is shown takes {MOST_SECONDS:g} s at most; got {seconds:.1f} s; "
            "end what else runs on this machine, and make the pictures again"
        )


def knee(name: str, folder: Path) -> None:
    """Draw the branch of the knee of a shipped job."""
    with tempfile.TemporaryDirectory() as place:
        front = solve(load_job(_JOB.with_name(f"{name}.toml")))
        (file,) = (file for file in write_front_figures(front, Path(place)) if file.stem == "knee")
        shutil.copyfile(file, folder / f"{name}_knee.png")


def exploring(folder: Path) -> None:
    """Let the linkages of the feeder's front turn."""
    exploring_front(solve(load_job(_JOB)), folder / "exploring_front.gif")


def python_example(folder: Path) -> None:
    """Draw what the Python of the README draws."""
    import matplotlib.pyplot as plt

    (code,) = re.findall(r"^```python\n(.*?)^```$", README.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    plt.switch_backend("agg")
    with contextlib.chdir(README.parent), plt.rc_context({"figure.figsize": (7.0, 3.2), "figure.autolayout": True}):
        exec(code.replace('"torque.png"', repr(str(folder / "torque.png"))), {})


def sealer(folder: Path) -> None:
    """Draw the design that docs/tutorial.md decides for."""
    page = (FOLDER / "tutorial.md").read_text(encoding="utf-8")
    (job,) = re.findall(r"^```toml\n# sealer\.toml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    lengths = re.search(r"crank ([\d.]+) mm, rod ([\d.]+) mm, offset (-[\d.]+) mm", page)
    assert lengths is not None
    crank, rod, offset = (1e-3 * float(length) for length in lengths.groups())
    linkage = Linkage(crank, rod, offset)
    drawn = linkage_drawing(parse_job(tomllib.loads(job)).mechanism, linkage, name="Carton sealer", design="design 1")
    save_png(drawing_figure(drawn), folder / "sealer.png")


def page(folder: Path) -> None:
    """Take the run and its knee on the page."""
    with _feeder() as (opened, job, design):
        opened(f"jobs/{job}", 1130, _explorer).screenshot(path=folder / "page_front.png")
        opened(f"jobs/{job}/designs/{design}", 1000, _with_forces).screenshot(path=folder / "page_design.png")


def compressor(folder: Path) -> None:
    """Draw pressure and volume of the shipped compressor, and the torque of two of them on one crankshaft."""
    machine = load_job(_JOB.with_name("compressor.toml")).mechanism
    two = replace(machine, arrangement=Arrangement(phases=(0.0, math.pi), places=(-0.05, 0.05)))
    save_figure(indicator.figure(machine, _COMPRESSOR), folder / "compressor_indicator.png")
    save_figure(cylinders.figure(two, _COMPRESSOR), folder / "compressor_cylinders.png")


def methods(folder: Path) -> None:
    """Measure every method on the shipped jobs."""
    from . import methods as measured  # its peers are of the benchmark extra

    measured.compare()
    shutil.copyfile(measured.FIGURE, folder / "methods.png")


PICTURES: dict[str, Callable[[Path], None]] = {
    "exploring_front.gif": exploring,
    "feeder_knee.png": partial(knee, "feeder"),
    "press_knee.png": partial(knee, "press"),
    "servo_press_knee.png": partial(knee, "servo_press"),
    "sieve_knee.png": partial(knee, "sieve"),
    "compressor_indicator.png": compressor,
    "compressor_cylinders.png": compressor,
    "sealer.png": sealer,
    "glossary.svg": glossary_sketch.draw,
    "torque.png": python_example,
    "page_front.png": page,
    "page_design.png": page,
    "methods.png": methods,
    **gallery_pictures.drawers(),
    **dict.fromkeys(load_pictures.names(), load_pictures.draw),
}


@contextmanager
def _feeder() -> Iterator[tuple[Callable[[str, int, Callable[[Page], None]], Page], int, int]]:
    """Solve the feeder; give what opens a view of it in a window of a height, its job and its knee."""
    tables = tomllib.loads(_JOB.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as place, chromium() as browser:
        file = Path(place) / "store.db"
        solve(load_job(_JOB))  # the first search of a process loads what is compiled
        with Store(file) as store:
            job = submit(store, tables).id
            work(store, drain=True)
            result = store.result(job)
        require_quick(result.seconds)
        with service(str(file), Path(place), workers=0) as running:

            def opened(view: str, height: int, ready: Callable[[Page], None]) -> Page:
                context = browser.new_context(
                    viewport={"width": 1280, "height": height}, reduced_motion="reduce", color_scheme="light"
                )
                shown = context.new_page()
                shown.goto(running.address_of(view))
                ready(shown)
                return shown

            yield opened, job, 1 + (result.knee or 0)


def _explorer(shown: Page) -> None:
    expect(shown.locator(".run-head time")).to_have_text("just now")
    expect(shown.locator(".trade-offs li").first).to_be_visible(timeout=30_000)


def _with_forces(shown: Page) -> None:
    expect(shown.locator(".trade-offs li").first).to_be_visible(timeout=30_000)
    shown.get_by_role("checkbox", name="Forces").check()
    angle = shown.get_by_role("slider", name="Crank angle")
    angle.evaluate(f"(node) => {{ node.value = {_KNEE_ANGLE}; node.dispatchEvent(new Event('input')); }}")
    shown.mouse.move(0, 0)


def main(names: Iterable[str]) -> None:
    """Make the pictures of these names, all by default."""
    chosen = list(names) or list(PICTURES)
    unknown = [name for name in chosen if name not in PICTURES]
    if unknown:
        raise SystemExit(f"the pictures are {', '.join(PICTURES)}; got {', '.join(unknown)}; choose some of them")
    for make in dict.fromkeys(PICTURES[name] for name in chosen):
        make(FOLDER)
    print(f"made {', '.join(chosen)} in {FOLDER}")


if __name__ == "__main__":
    main(sys.argv[1:])
