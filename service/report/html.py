"""Report as one HTML file with embedded style and figures, without scripts or downloads, for screen and print."""

import base64
import re
from html import escape
from pathlib import Path
from string import Template

from ..figures.style import figure_bytes
from .document import Block, Facts, Paragraph, Picture, Report, Section, Table

_PAGE = Path(__file__).parent / "page"


def html_file(report: Report) -> bytes:
    """Return the report as the content of an HTML file."""
    parts = []
    for place, section in enumerate(report.sections):
        parts += _section_html(section, place)
        if place == 0:
            boxes = "".join(f"<div>{escape(name)} by, date</div>" for name in report.signatures)
            parts.append(f'<div class="signatures">{boxes}</div>')
    page = Template((_PAGE / "report.html").read_text(encoding="utf-8")).substitute(
        title=escape(report.title),
        subtitle=escape(report.subtitle),
        made=escape(report.date),
        style=(_PAGE / "report.css").read_text(encoding="utf-8"),
        sections="\n".join(parts),
    )
    return page.encode()


def _section_html(section: Section, place: int) -> list[str]:
    parts = [f'<section aria-labelledby="part-{place}">', f'<h2 id="part-{place}">{escape(section.title)}</h2>']
    for index, block in enumerate(section.blocks):
        parts += _block_html(block, f"p{place}-{index}")
    return [*parts, "</section>"]


def _block_html(block: Block, name: str) -> list[str]:
    if isinstance(block, Paragraph):
        kind = "" if block.tone == "plain" else f' class="{block.tone}"'
        return [f"<p{kind}>{escape(block.text)}</p>"]
    if isinstance(block, Facts):
        rows = (
            f"<dt>{escape(name)}</dt><dd>{'<br>'.join(map(escape, lines))}</dd>" for name, lines in block.rows.items()
        )
        return [f'<dl class="facts">{"".join(rows)}</dl>']
    if isinstance(block, Table):
        return _table_html(block)
    return [f"<figure><figcaption>{escape(block.title)}</figcaption>", _picture_html(block, name), "</figure>"]


def _table_html(table: Table) -> list[str]:
    def kind(place: int) -> str:
        return ' class="right"' if place in table.right else ""

    parts = [f"<h3>{escape(table.title)}</h3>"] if table.title else []
    label = f' aria-label="{escape(table.title, quote=True)}"' if table.title else ' aria-label="numbers"'
    # Makes content that may scroll sideways accessible by keyboard.
    parts.append(f'<div class="scroll" tabindex="0" role="region"{label}>')
    parts.append('<table class="small">' if table.small else "<table>")
    heads = "".join(f'<th scope="col"{kind(place)}>{escape(head)}</th>' for place, head in enumerate(table.heads))
    parts.append(f"<thead><tr>{heads}</tr></thead><tbody>")
    for index, row in enumerate(table.rows):
        first = f'<th scope="row"{kind(0)}>{escape(row[0])}</th>'
        rest = "".join(f"<td{kind(place)}>{escape(cell)}</td>" for place, cell in enumerate(row) if place)
        parts.append(f'<tr class="bold">{first}{rest}</tr>' if index in table.bold else f"<tr>{first}{rest}</tr>")
    return [*parts, "</tbody></table></div>"]


def _picture_html(picture: Picture, name: str) -> str:
    label = escape(picture.title, quote=True)
    figure = picture.draw()
    if picture.raster:
        content = base64.b64encode(figure_bytes(figure, "png")).decode()
        return f'<img alt="{label}" src="data:image/png;base64,{content}">'
    return _inline_svg(figure_bytes(figure, "svg").decode(), label, name)


def _inline_svg(text: str, label: str, name: str) -> str:
    """Return an SVG file as an element of a page, without its header and style, and with prefixed ids."""
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r"<style[^>]*>.*?</style>", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="([^"]+)"', rf'id="{name}-\1"', text)
    text = re.sub(r'(href="#|url\(#)', rf"\1{name}-", text)
    head, rest = text.split(">", 1)
    head = re.sub(r' (width|height|xmlns:xlink|version)="[^"]*"', "", head)
    rest = rest.replace("xlink:href", "href")
    return f'{head} role="img" aria-label="{label}" stroke-linejoin="round" stroke-linecap="butt">{rest}'
