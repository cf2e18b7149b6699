"""A report as one HTML file with style and figures inside, no script, nothing fetched; for screen and print."""

from __future__ import annotations

import base64
import re
from html import escape

from ..figures.style import image
from .document import Block, Facts, Paragraph, Picture, Report, Section, Table

_POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
_STYLE = """
:root { --ink: #1a1a1a; --muted: #5c5c5c; --line: #d0d0d0; --blue: #00588a; --good: #1c6b30; --bad: #a8321f; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: var(--ink); font: 15px/1.45 system-ui, "Segoe UI", Arial, sans-serif; }
main { max-width: 64rem; margin: 0 auto; padding: 1.5rem 1.2rem 3rem; }
header { border-bottom: 2px solid var(--ink); margin-bottom: 1.2rem; padding-bottom: 0.6rem; }
h1 { margin: 0; font-size: 1.6rem; line-height: 1.2; overflow-wrap: anywhere; }
header p { margin: 0.3rem 0 0; color: var(--muted); }
h2 { margin: 2rem 0 0.6rem; font-size: 1.2rem; border-bottom: 1px solid var(--line); padding-bottom: 0.2rem; }
h3 { margin: 1.1rem 0 0.35rem; font-size: 1rem; }
p { margin: 0.4rem 0; max-width: 52rem; }
.note { color: var(--muted); font-size: 0.87rem; }
.good::before { content: "\\2713\\00a0"; font-weight: 700; }
.bad::before { content: "\\2717\\00a0"; font-weight: 700; }
.good { color: var(--good); }
.bad { color: var(--bad); font-weight: 600; }
dl { display: grid; grid-template-columns: minmax(8rem, 11rem) 1fr; gap: 0.25rem 1rem; margin: 0.4rem 0; }
dt { color: var(--muted); }
dd { margin: 0; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 0.22rem 0.55rem; text-align: left; vertical-align: top; border-bottom: 1px solid #e6e6e6; }
thead th { border-bottom: 1.5px solid var(--ink); vertical-align: bottom; font-weight: 600; }
tbody th { font-weight: 400; }
.right { text-align: right; }
td.right { white-space: nowrap; }
.small { font-size: 0.83rem; }
.bold > * { font-weight: 700; }
figure { margin: 1rem 0; }
figure svg, figure img { display: block; width: 100%; height: auto; max-height: 60rem; }
figcaption { font-weight: 600; margin-bottom: 0.4rem; }
.signatures { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: 1.4rem;
  margin-top: 1rem; }
.signatures div { border-top: 1px solid var(--ink); margin-top: 2.6rem; padding-top: 0.25rem; color: var(--muted);
  font-size: 0.87rem; }
@media (max-width: 40rem) { dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: 0.5rem; } }
@media print {
  @page { size: A4; margin: 16mm 15mm 18mm; }
  body { font-size: 9.5pt; }
  main { max-width: none; padding: 0; }
  h2, h3, figcaption { break-after: avoid; }
  h2 { margin-top: 1.2rem; }
  figure, .facts, .signatures, tr { break-inside: avoid; }
  figure svg, figure img { max-height: 22cm; }
  thead { display: table-header-group; }
  .scroll { overflow: visible; }
}
"""


def html_file(report: Report) -> bytes:
    """Return the report as the content of an HTML file."""
    parts = [
        "<!doctype html>",
        '<html lang="en">',
        "<head>",
        '<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(report.title)}</title>",
        f"<style>{_STYLE}</style>",
        "</head>",
        "<body>",
        "<main>",
        f"<header><h1>{escape(report.title)}</h1><p>{escape(report.subtitle)}; {escape(report.made)}</p></header>",
    ]
    for place, section in enumerate(report.sections):
        parts += _section(section, place)
        if place == 0:
            parts.append(_signatures(report))
    return "\n".join([*parts, "</main>", "</body>", "</html>", ""]).encode()


def _signatures(report: Report) -> str:
    boxes = "".join(f"<div>{escape(name)} by, date</div>" for name in report.signatures)
    return f'<div class="signatures">{boxes}</div>'


def _section(section: Section, place: int) -> list[str]:
    parts = [f'<section aria-labelledby="part-{place}">', f'<h2 id="part-{place}">{escape(section.title)}</h2>']
    for index, block in enumerate(section.blocks):
        parts += _block(block, f"p{place}-{index}")
    return [*parts, "</section>"]


def _block(block: Block, name: str) -> list[str]:
    if isinstance(block, Paragraph):
        kind = "" if block.tone == "plain" else f' class="{block.tone}"'
        return [f"<p{kind}>{escape(block.text)}</p>"]
    if isinstance(block, Facts):
        rows = (f"<dt>{escape(title)}</dt><dd>{'<br>'.join(map(escape, lines))}</dd>" for title, lines in block.rows)
        return [f'<dl class="facts">{"".join(rows)}</dl>']
    if isinstance(block, Table):
        return _table(block)
    return [f"<figure><figcaption>{escape(block.title)}</figcaption>", _picture(block, name), "</figure>"]


def _table(table: Table) -> list[str]:
    def kind(place: int) -> str:
        return ' class="right"' if place in table.right else ""

    parts = [f"<h3>{escape(table.title)}</h3>"] if table.title else []
    label = f' aria-label="{escape(table.title, quote=True)}"' if table.title else ' aria-label="numbers"'
    # What may have to be scrolled sideways can be reached by keyboard.
    parts.append(f'<div class="scroll" tabindex="0" role="region"{label}>')
    parts.append('<table class="small">' if table.small else "<table>")
    heads = "".join(f'<th scope="col"{kind(place)}>{escape(head)}</th>' for place, head in enumerate(table.heads))
    parts.append(f"<thead><tr>{heads}</tr></thead><tbody>")
    for index, row in enumerate(table.rows):
        first = f'<th scope="row"{kind(0)}>{escape(row[0])}</th>'
        rest = "".join(f"<td{kind(place)}>{escape(cell)}</td>" for place, cell in enumerate(row) if place)
        parts.append(f'<tr class="bold">{first}{rest}</tr>' if index in table.bold else f"<tr>{first}{rest}</tr>")
    return [*parts, "</tbody></table></div>"]


def _picture(picture: Picture, name: str) -> str:
    label = escape(picture.title, quote=True)
    figure = picture.draw()
    if picture.raster:
        content = base64.b64encode(image(figure, "png")).decode()
        return f'<img alt="{label}" src="data:image/png;base64,{content}">'
    return _inline(image(figure, "svg").decode(), label, name)


def _inline(text: str, label: str, name: str) -> str:
    """Return an SVG file as an element of a page, without its head and style and with prefixed names."""
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r"<style[^>]*>.*?</style>", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="([^"]+)"', rf'id="{name}-\1"', text)
    text = re.sub(r'(href="#|url\(#)', rf"\1{name}-", text)
    head, rest = text.split(">", 1)
    head = re.sub(r' (width|height|xmlns:xlink|version)="[^"]*"', "", head)
    rest = rest.replace("xlink:href", "href")
    return f'{head} role="img" aria-label="{label}" stroke-linejoin="round" stroke-linecap="butt">{rest}'
