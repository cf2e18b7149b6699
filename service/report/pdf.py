"""A report as PDF on A4, by matplotlib: text that can be searched, figures as lines."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from matplotlib.backends.backend_mixed import MixedModeRenderer
from matplotlib.backends.backend_pdf import Op, PdfFile, RendererPdf
from matplotlib.figure import Figure

from ..figures.style import new_figure, place
from .document import Report
from .pages import HEIGHT, WIDTH, Page, pages

_DOTS = 72  # of a PDF, an inch
_SHARP = 220  # dots an inch of what is drawn as points


def pdf_file(report: Report) -> bytes:
    """Return the report as the content of a PDF file."""
    out = io.BytesIO()
    # No date of its own: the report says when it was made.
    metadata = {"Title": report.title, "Subject": report.subtitle, "Creator": "slidercrank", "CreationDate": None}
    file: Any = PdfFile(out, metadata=metadata)  # type: ignore[no-untyped-call]
    for page in pages(report):
        _write(file, page)
    file.finalize()
    file.close()
    return out.getvalue()


def _write(file: Any, page: Page) -> None:
    """Write a page: its texts and lines, then its figures, each scaled to its place."""
    file.newPage(WIDTH, HEIGHT)
    _draw(file, page.figure, _SHARP)
    for inset in page.insets:
        file.output(Op.gsave)
        place = (inset.scale, 0, 0, inset.scale, inset.left * _DOTS, inset.bottom * _DOTS)
        file.output(*place, Op.concat_matrix)
        _draw(file, _photograph(inset.figure, inset.scale) if inset.raster else inset.figure, _SHARP)
        file.output(Op.grestore)


def _photograph(figure: Figure, scale: float) -> Figure:
    """Return a figure that shows another one as points: thousands of marks as lines would take half a minute."""
    width, height = figure.get_size_inches()
    figure.set_dpi(round(_SHARP * scale))
    canvas: Any = figure.canvas
    canvas.draw()
    found = new_figure(width, height)
    axes = place(found, 0.0, 0.0, width, height)
    axes.axis("off")
    axes.imshow(np.asarray(canvas.buffer_rgba()), aspect="auto", interpolation="none")
    return found


def _draw(file: Any, figure: Figure, dots: int) -> None:
    """Draw a figure into the page that is open."""
    width, height = figure.get_size_inches()
    before, page = figure.dpi, (file.width, file.height)
    figure.dpi = _DOTS
    # The backend leaves out what is beyond the size of the file's page, in the coordinates of the figure: it does not
    # know that a figure wider than the page is scaled to fit.
    file.width, file.height = width, height
    try:
        vectors: Any = RendererPdf(file, dots, height, width)  # type: ignore[no-untyped-call]
        renderer: Any = MixedModeRenderer(figure, width, height, dots, vectors)  # type: ignore[no-untyped-call]
        figure.draw(renderer)
        renderer.finalize()
    finally:
        figure.dpi = before
        file.width, file.height = page
