"""The pictures of docs/loads.md: the force of each example on the slider, against its position."""

from __future__ import annotations

import re
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import slidercrank as sc
from slidercrank.optimise.job import parse_job, with_file_contents
from slidercrank.service.figures.style import BLUE, INK, SMALL, VERMILION, add_axes, new_figure, save_png, style_axes

DOCS = Path(__file__).parents[1] / "docs"
_STROKE, _ROD, _OFFSET = 0.15, 0.22, -0.04  # m
_ANGLES = 1440


@dataclass(frozen=True)
class Example:
    """An example of the page. tables: of the job. file: a table beside it, by its name. picture: its file, if any.

    reported: what `slidercrank check` reports of it.
    """

    tables: dict[str, Any]
    file: dict[str, str]
    picture: str
    reported: list[str]


def whole_job() -> dict[str, Any]:
    """Return the job at the beginning of docs/jobs.md."""
    page = (DOCS / "jobs.md").read_text(encoding="utf-8")
    return tomllib.loads(_blocks(page, "toml")[0])


def examples() -> Iterator[Example]:
    """Yield the examples of the page, one for each block of TOML, with what stands below it."""
    page = (DOCS / "loads.md").read_text(encoding="utf-8")
    _, *parts = re.split(r"^(?=```toml\n)", page, flags=re.MULTILINE)
    for part in parts:
        (block,) = _blocks(part, "toml")
        tables = tomllib.loads(block)
        picture = re.search(r"\]\((load_\w+\.png)\)", part)
        names = [load["file"] for load in tables.get("load", []) if "file" in load]
        yield Example(
            tables,
            dict(zip(names, _blocks(part, "csv"), strict=True)),
            picture[1] if picture else "",
            re.findall(r"^check: (.*)$", part, re.MULTILINE),
        )


def draw(folder: Path) -> None:
    """Write the picture of every example that has one."""
    for example in examples():
        if example.picture:
            _draw(example, folder / example.picture)


def names() -> list[str]:
    """Return the files of the pictures."""
    return [example.picture for example in examples() if example.picture]


def _draw(example: Example, file: Path) -> None:
    with tempfile.TemporaryDirectory() as beside:
        for name, text in example.file.items():
            (Path(beside) / name).write_text(text, encoding="utf-8")
        problem = parse_job(with_file_contents({**whole_job(), **example.tables}, Path(beside)))
    crank = float(sc.crank_from_stroke(_STROKE, rod=_ROD, offset=_OFFSET))
    cycle = problem.analyse([crank, _ROD, _OFFSET]).cycle(_ANGLES)
    position, force = 1e3 * cycle["slider_position_m"].to_numpy(), cycle["load_N"].to_numpy()
    outward = cycle["slider_velocity_m_s"].to_numpy() >= 0.0
    figure = new_figure(5.2, 2.2)
    axes = add_axes(figure, 0.75, 0.5, 4.25, 1.45)
    style_axes(axes, most_x_ticks=6, most_y_ticks=4)
    axes.axhline(0.0, color=INK, linewidth=0.8)
    for stroke, colour, style, name in ((outward, BLUE, "-", "outward"), (~outward, VERMILION, "--", "inward")):
        order = np.argsort(position[stroke], kind="stable")
        axes.plot(position[stroke][order], force[stroke][order], style, color=colour, label=f"{name} stroke")
    axes.margins(y=0.12)
    axes.set_xlabel("slider position, mm", fontsize=SMALL)
    axes.set_ylabel("force, N", fontsize=SMALL)
    axes.legend(
        fontsize=SMALL, frameon=False, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.98), borderaxespad=0.0
    )
    save_png(figure, file)


def _blocks(page: str, kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
