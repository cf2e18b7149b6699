"""Figures of the PDF as another program draws them: nothing of a figure is missing on paper."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from matplotlib.collections import PathCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from slidercrank.service.figures.style import BLUE, INK
from slidercrank.service.report.design_report import design_report
from slidercrank.service.report.document import Picture
from slidercrank.service.report.pdf import pdf_file
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import result_of
from tests.service import fronts
from tests.service.report.paper import A4, Inset, pages_as_pictures, paper

Image = NDArray[np.uint8]
Shares = NDArray[np.float64]

DOTS = 144  # an inch
_BLOCK = 8  # dots: text and lines of two programs differ by less
_FINER = 6  # a screen rounds small letters to whole dots


@cache
def figures() -> dict[str, tuple[Figure, Inset, Image]]:
    """Return each figure of a report with its place and its picture on paper (h, w, 3)."""
    front = fronts.front(designs=20)
    result = result_of(front, "kept")
    report = design_report(Subject(front.problem, result, 3, run="kept", versions={}), created=0.0)
    content = pdf_file(report)
    pictures = [block for section in report.sections for block in section.blocks if isinstance(block, Picture)]
    places = [(page.number, inset) for page in paper(content) for inset in page.insets]
    sheets = pages_as_pictures(content, DOTS)
    found: dict[str, tuple[Figure, Inset, Image]] = {}
    for number, inset in places:
        # Pictures stand where there is room for them: one is told by the title above it.
        picture = next(each for each in pictures if each.title == _title(content, number, inset, pictures))
        figure = picture.draw()
        width, height = (inset.scale * size for size in figure.get_size_inches())
        left, top = inset.left / 72, A4[1] / 72 - inset.bottom / 72 - height
        rows, columns = (
            slice(round(at * DOTS), round((at + size) * DOTS)) for at, size in ((top, height), (left, width))
        )
        found[picture.title] = figure, inset, sheets[number][rows, columns]
    assert set(found) == {picture.title for picture in pictures}
    return found


def _title(content: bytes, number: int, inset: Inset, pictures: list[Picture]) -> str:
    """Return the title that is the nearest above a picture."""
    titles = {picture.title for picture in pictures}
    above = [(box[1], text) for text, box in paper(content)[number].texts if text in titles and box[1] > inset.bottom]
    return min(above)[1]


def screen(figure: Figure, scale: float) -> Image:
    """Return a figure as matplotlib draws it on a screen, (h, w, 4). Its dots are a sixth as large as the paper's."""
    figure.set_dpi(_FINER * DOTS * scale)
    figure.canvas.draw()
    dots: Image = np.asarray(figure.canvas.buffer_rgba())  # type: ignore[attr-defined]
    return dots


def ink(picture: Image, block: int) -> Shares:
    """Return the share of ink in square blocks of a picture, `block` dots wide."""
    rows, columns = (size // block for size in picture.shape[:2])
    whole = picture[: rows * block, : columns * block]
    # Whole numbers, rows first: a picture of 25 million dots as floating-point numbers takes seconds.
    light = whole.reshape(rows, block, -1).sum(axis=1, dtype=np.uint32).reshape(rows, columns, block, -1)
    return np.asarray(1.0 - light[..., :3].sum(axis=(2, 3)) / (255.0 * 3 * block**2))


def around(blocks: Shares) -> Shares:
    """Return the most of each block and its neighbours."""
    padded = np.pad(blocks, 1)
    rows, columns = blocks.shape
    shifted = [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    return np.asarray(np.max(shifted, axis=0))


def is_colour_on_paper(
    figure: Figure, inset: Inset, picture: Image, axes: int, x: float, y: float, colour: str
) -> bool:
    """Return whether a colour is on paper within two dots of a point of the axes of a figure."""
    figure.set_dpi(DOTS * inset.scale)
    across, up = figure.axes[axes].transData.transform((x, y))
    row, column = round(picture.shape[0] - up), round(across)
    near = picture[row - 2 : row + 3, column - 2 : column + 3]
    return bool((np.abs(near / 255.0 - to_rgb(colour)).max(axis=2) < 0.3).any())


@pytest.mark.slow
def test_all_that_a_figure_draws_is_on_paper() -> None:
    for title, (figure, inset, picture) in figures().items():
        asked, got = ink(screen(figure, inset.scale), _FINER * _BLOCK), ink(picture, _BLOCK)
        rows, columns = (min(one, other) for one, other in zip(asked.shape, got.shape, strict=True))
        missing = (asked[:rows, :columns] > 0.04) & (around(got[:rows, :columns]) < 0.4 * asked[:rows, :columns])
        assert not missing.any(), (title, np.argwhere(missing)[:5])


def test_curves_over_the_cycle_reach_their_end() -> None:
    figure, inset, picture = figures()["The design over a turn of the crank"]
    curves = [
        (place, line)
        for place, axes in enumerate(figure.axes)
        for line in axes.lines
        if len(line.get_xdata()) > 100 and line.get_color() == BLUE  # type: ignore[arg-type]
    ]
    assert len(curves) == 5
    for place, line in curves:
        assert isinstance(line, Line2D)
        x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        for angle in (100.0, 200.0, 350.0):
            assert is_colour_on_paper(figure, inset, picture, place, angle, float(np.interp(angle, x, y)), BLUE), angle


def test_every_design_is_a_point_in_every_panel_of_the_scatter_matrix() -> None:
    figure, inset, picture = figures()["Every pair of objectives"]
    clouds = [
        (place, points)
        for place, axes in enumerate(figure.axes)
        for points in axes.collections
        if isinstance(points, PathCollection)
    ]
    assert len(clouds) == 6
    for place, points in clouds:
        offsets = np.asarray(points.get_offsets())
        figure.set_dpi(DOTS * inset.scale)
        transform = figure.axes[place].transData.transform
        marked = [transform(np.ravel(line.get_xydata())) for line in figure.axes[place].lines]
        bare = [point for point in offsets if np.hypot(*(transform(point) - marked).T).min() > 12.0]
        assert len(offsets) == 20
        assert len(bare) >= 10
        for x, y in bare:
            assert is_colour_on_paper(figure, inset, picture, place, x, y, INK), (place, x, y)
