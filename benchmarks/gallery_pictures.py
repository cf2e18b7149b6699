"""The pictures of docs/gallery.md for the machines whose job stands in the page: the design at the knee."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from slidercrank.optimise.job import parse_job
from slidercrank.service.figures.style import save_png

PAGE = Path(__file__).parents[1] / "docs" / "gallery.md"


@dataclass(frozen=True)
class Machine:
    """A machine of the page. knee: its numbers as printed, mm, with those of further variables behind."""

    job: dict[str, Any]
    knee: list[str]
    picture: str


def machines() -> Iterator[Machine]:
    """Yield the machines of the page that have their job there."""
    for part in PAGE.read_text(encoding="utf-8").split("\n## ")[1:]:
        block = re.search(r"^```toml\n(.*?)^```$", part, re.MULTILINE | re.DOTALL)
        if block:
            knee = re.search(
                r"^Knee: crank (\S+) mm, rod (\S+) mm, offset (\S+) mm(?:, \w+ (\S+) kg)?\.$", part, re.MULTILINE
            )
            picture = re.search(r"\]\((gallery_\w+\.png)\)", part)
            assert knee, part
            assert picture, part
            yield Machine(tomllib.loads(block[1]), [number for number in knee.groups() if number], picture[1])


def draw(machine: Machine, folder: Path) -> None:
    """Write the picture of a machine."""
    numbers = [float(number) for number in machine.knee]
    design = [*(1e-3 * length for length in numbers[:3]), *numbers[3:]]
    save_png(parse_job(machine.job).analyse(design).plot(), folder / machine.picture)


def drawers() -> dict[str, partial[None]]:
    """Return what draws each picture, by its file."""
    return {machine.picture: partial(draw, machine) for machine in machines()}
