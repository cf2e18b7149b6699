"""Pages of a PDF as another program reads them: texts with their places, pictures with theirs, and what is drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pypdfium2
import pypdfium2.raw as pdfium
from numpy.typing import NDArray

Image = NDArray[np.uint8]
Box = tuple[float, float, float, float]  # left, bottom, right, top; points

A4 = (595.28, 841.89)  # points
_TYPES = [pdfium.FPDF_PAGEOBJ_FORM, pdfium.FPDF_PAGEOBJ_IMAGE]


@dataclass(frozen=True)
class Inset:
    """A picture on a page, by the matrix that puts it there. scale: of its own size, in points."""

    left: float
    bottom: float
    scale: float


@dataclass(frozen=True)
class Page:
    """A page. texts: pieces of lines outside of pictures, with their boxes. whole: every word in one."""

    number: int
    texts: list[tuple[str, Box]]
    insets: list[Inset]
    whole: str


def paper(content: bytes) -> list[Page]:
    """Return the pages of a PDF, pictures from the top down."""
    return [_page(number, page) for number, page in enumerate(pypdfium2.PdfDocument(content))]


def pages_as_pictures(content: bytes, dots: float) -> list[Image]:
    """Return the pages of a PDF as pictures (h, w, 3) with so many dots an inch."""
    document = pypdfium2.PdfDocument(content)
    return [page.render(scale=dots / 72, rev_byteorder=True).to_numpy()[:, :, :3] for page in document]


def _page(number: int, page: Any) -> Page:
    objects = list(page.get_objects(filter=_TYPES, max_depth=1))
    matrices = [each.get_matrix().get() for each in objects]
    insets = [Inset(left, bottom, scale) for scale, _, _, _, left, bottom in matrices]
    boxes = [each.get_bounds() for each in objects]
    text = page.get_textpage()
    pieces = [text.get_rect(index) for index in range(text.count_rects())]
    outside = [box for box in pieces if not any(_centre_is_within(box, other) for other in boxes)]
    texts = [(text.get_text_bounded(*box).strip(), box) for box in outside]
    ordered = sorted(insets, key=lambda inset: -inset.bottom)
    return Page(number, [(words, box) for words, box in texts if words], ordered, text.get_text_range())


def _centre_is_within(box: Box, other: Box) -> bool:
    across, up = 0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3])
    return other[0] <= across <= other[2] and other[1] <= up <= other[3]
