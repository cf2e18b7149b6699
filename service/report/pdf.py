"""Report as tagged PDF on A4 pages, typeset by typst, with searchable text and vector figures."""

import json
import re
import shutil
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib

from ...model.optional_packages import import_extra
from ...objectives.kinds import DISPLAYED_KINDS, unit_text
from ..figures.style import figure_bytes
from .document import Block, Facts, Paragraph, Picture, Report, Table

typst = import_extra("typst", "reports as PDF need")

_TEMPLATE = Path(__file__).parent / "page" / "report.typ"
_FONTS = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
"""Fonts of the figures, so that pages look the same everywhere; other fonts supply missing characters."""
_ACROSS = 6.77  # inches
_SHARP = 220  # dots per inch for raster images
_UNITS = sorted({unit_text(unit.symbol) for of in DISPLAYED_KINDS for unit in (of.metric, of.inch) if unit}, key=len)[
    ::-1
]
_UNIT = "|".join(map(re.escape, [*_UNITS, "%"]))
_OF_NUMBER = re.compile(rf"(?<=\d) (?:{_UNIT})(?![\w/])|(?<=,) (?:{_UNIT})$|^(?:{_UNIT})$")
"""Matches a unit after a number, at the end of a heading, or alone."""
_NO_BREAK = "\u00a0"  # non-breaking space


def pdf_file(report: Report) -> bytes:
    """Return the report as the content of a PDF file. Raises `MissingExtra` if typst is not installed."""
    with TemporaryDirectory(prefix="slidercrank-") as name:
        folder = Path(name)
        shutil.copy(_TEMPLATE, folder)
        sections = [
            {"title": section.title, "blocks": _template_blocks(section.blocks, folder, number)}
            for number, section in enumerate(report.sections)
        ]
        header = {"title": report.title, "subtitle": report.subtitle, "made": report.date}
        content = header | {"signatures": report.signatures, "sections": sections}
        (folder / "report.json").write_text(json.dumps(content), encoding="utf-8")
        pdf = typst.compile(folder / _TEMPLATE.name, font_paths=[_FONTS])
    return bytes(pdf)


def _template_blocks(blocks: Sequence[Block], folder: Path, section: int) -> list[dict[str, Any]]:
    """Return the blocks of a section in the form of the template; pictures are drawn into the folder."""
    contents = []
    for number, (block, after) in enumerate(zip(blocks, (*blocks, None)[1:], strict=True)):
        if isinstance(block, Picture):
            content = _draw_picture(block, folder / f"{section}-{number}")
        elif isinstance(block, Paragraph):  # a note on a table stays with it
            content = {"tone": block.tone, "text": _unbreakable_text(block.text), "stays": isinstance(after, Table)}
        elif isinstance(block, Facts):
            content = {"rows": {name: list(map(_unbreakable_text, lines)) for name, lines in block.rows.items()}}
        else:
            cells = [list(map(_unbreakable_text, row)) for row in block.rows]
            places = {"right": sorted(block.right), "bold": sorted(block.bold)}
            content = asdict(block) | places | {"heads": list(map(_unbreakable_text, block.heads)), "rows": cells}
        contents.append({"kind": type(block).__name__} | content)
    return contents


def _draw_picture(picture: Picture, file: Path) -> dict[str, Any]:
    """Draw a picture, and return its title, its file and its size, inches."""
    figure = picture.draw()
    width, height = map(float, figure.get_size_inches())
    scale = min(_ACROSS / width, picture.tallest / height, 1.0)
    file = file.with_suffix(".png" if picture.raster else ".pdf")
    if picture.raster:
        figure.set_dpi(round(_SHARP * scale))
        file.write_bytes(figure_bytes(figure, "png"))
    else:
        figure.savefig(file, metadata={"CreationDate": None})
    return {"title": picture.title, "file": file.name, "width": scale * width, "height": scale * height}


def _unbreakable_text(text: str) -> str:
    """Return a text without line breaks within a unit, or between a number and its unit."""
    return _OF_NUMBER.sub(lambda found: found[0].replace(" ", _NO_BREAK), text)
