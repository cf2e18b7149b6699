"""Hooks for the documentation site: generated pages, links that lead out of docs/, formulas as MathML."""

from __future__ import annotations

import html
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from docs.site.api_reference import api_reference
from docs.site.job_reference import job_reference
from docs.site.notebooks import notebook_files, notebook_page, notebook_pictures
from docs.site.python_reference import folder_reference, front_door_reference
from docs.site.quantity_reference import quantity_reference

ROOT = Path(__file__).resolve().parents[2]
_MOVED = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}
"""Pages at the top of the repository, by their place in the site."""
_REPLACED = {"commands.md#quantities": "reference/quantities.md"}
"""Links that the site replaces with its reference pages, which the repository does not have."""
_FOLDERS = ("model", "objectives", "optimise")
_LINK = re.compile(r"\[([^\]]*)\]\((?!https?://|#)([^)\s#]+)(#[^)\s]*)?\)")
_FORMULA = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.DOTALL)


def pages() -> dict[str, Callable[[], str]]:
    """Return the function that makes each page that is not in docs/, by its place in the site."""
    return {
        **{place: partial(_at_the_top, name) for name, place in _MOVED.items()},
        **{f"notebooks/{file.stem}.md": partial(notebook_page, file) for file in notebook_files()},
        "reference/quantities.md": quantity_reference,
        "reference/job-file.md": job_reference,
        "reference/http-api.md": api_reference,
        "reference/python.md": front_door_reference,
        **{f"reference/{top}.md": partial(folder_reference, top) for top in _FOLDERS},
    }


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages and the pictures in the notebooks."""
    for place, made in pages().items():
        files.append(File.generated(config, place, content=made()))
    for notebook in notebook_files():
        for name, picture in notebook_pictures(notebook).items():
            files.append(File.generated(config, f"notebooks/{name}", content=picture))
    return files


def on_page_markdown(markdown: str, **_: object) -> str:
    """Return the text of a page in which links to source files point to the reference of the module."""
    return _LINK.sub(_inside, markdown)


def on_page_content(content: str, **_: object) -> str:
    """Return the HTML of a page with its formulas as MathML, which browsers show without a script."""

    def formula(found: re.Match[str]) -> str:
        return convert(html.unescape(found[3]).strip(), display="inline" if found[2] == "(" else "block")

    return _FORMULA.sub(formula, content)


def _at_the_top(name: str) -> str:
    """Return a page from the top of the repository with links relative to docs/."""
    text = (ROOT / name).read_text(encoding="utf-8")
    return _LINK.sub(lambda found: f"[{found[1]}]({_from_docs(found[2])}{found[3] or ''})", text)


def _from_docs(target: str) -> str:
    return target.removeprefix("docs/") if target.startswith("docs/") else _MOVED.get(target, f"../{target}")


def _inside(found: re.Match[str]) -> str:
    """Return a link to the site's reference or to another page of the site, or its text if there is no such page."""
    text, target, place = found.groups()
    if reference := _REPLACED.get(target + (place or "")):
        return f"[{text}]({reference})"
    if not target.startswith("../"):
        return found[0]
    name = target.removeprefix("../")
    if (ROOT / "docs" / name).is_file():  # from a page of the reference
        return found[0]
    if name in _MOVED:
        return f"[{text}]({_MOVED[name]}{place or ''})"
    if name.endswith(".py") and name.split("/")[0] in _FOLDERS:
        module = name.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
        return f"[{text}][slidercrank.{module}]"
    return str(text)
