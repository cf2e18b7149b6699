"""Pictures of every view of the page, to be looked at one by one: `make screens`.

`python -m benchmarks.screens NAME ...` makes those of some views. On screens of a phone, a tablet, a laptop and a
monitor, light and dark, into docs/screens: names are VIEW_WIDTH_SCHEME.
"""

from __future__ import annotations

import io
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page

from slidercrank.optimise.job import load_job
from slidercrank.optimise.solve import solve
from slidercrank.service.runs.result import Result, result_of
from slidercrank.service.store import Store
from tests.service.page.browser import chromium
from tests.service.page.every_view import HEIGHTS, WIDTHS, View, fill

from .service_process import service

FOLDER = Path(__file__).parents[1] / "docs" / "screens"
SCHEMES = ("light", "dark")
_TALLEST = 1.8
"""Height that is shown at most, in heights of the screen: what is below repeats what is above."""
_JOB = Path(__file__).parents[1] / "runs" / "feeder.toml"


def screens(folder: Path, names: Sequence[str] = (), widths: Sequence[int] = WIDTHS) -> int:
    """Make the pictures of the views of these names, all by default; return how many."""
    tables = tomllib.loads(_JOB.read_text(encoding="utf-8"))
    folder.mkdir(parents=True, exist_ok=True)
    made = 0
    with tempfile.TemporaryDirectory() as place, chromium() as browser:
        file = Path(place) / "store.db"
        with Store(file) as store:
            views = fill(store, _results(), tables)
        unknown = [name for name in names if name not in {view.name for view in views}]
        if unknown:
            raise SystemExit(f"the views are {', '.join(view.name for view in views)}; got {', '.join(unknown)}")
        with service(str(file), Path(place), workers=0) as running:
            page = browser.new_context(reduced_motion="reduce").new_page()
            page.goto(running.address_of(""))  # with the token, once
            for view in (view for view in views if not names or view.name in names):
                for width in widths:
                    for scheme in SCHEMES:
                        _take(page, view, width, scheme).save(
                            folder / f"{view.name}_{width}_{scheme}.webp", quality=50, method=6
                        )
                        made += 1
    return made


def _results() -> tuple[Result, Result]:
    """Return the results of the feeder with two seeds."""
    problem = load_job(_JOB)
    fronts = [solve(replace(problem, settings=replace(problem.settings, seed=seed))) for seed in (1, 2)]
    one, other = (result_of(front, "") for front in fronts)
    return one, replace(other, name=f"{other.name}, seed 2")


def _take(page: Page, view: View, width: int, scheme: str) -> Image.Image:
    page.set_viewport_size({"width": width, "height": HEIGHTS[width]})
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    page.evaluate("location.hash = '#/nowhere'")  # a view begins anew, with the colours and the width that are now
    page.evaluate(f"location.hash = '#{view.address}'")
    view.wait(page)
    page.wait_for_timeout(300)
    height = min(page.evaluate("document.documentElement.scrollHeight"), int(_TALLEST * HEIGHTS[width]))
    data = page.screenshot(full_page=True, clip={"x": 0, "y": 0, "width": width, "height": height})
    return Image.open(io.BytesIO(data)).convert("RGB")


def main(arguments: Sequence[str]) -> None:
    """Make the pictures and say how large they are."""
    made = screens(FOLDER, arguments)
    size = sum(file.stat().st_size for file in FOLDER.glob("*.webp")) / 1e6
    print(f"made {made} pictures in {FOLDER}, which holds {size:.1f} MB")


if __name__ == "__main__":
    main(sys.argv[1:])
