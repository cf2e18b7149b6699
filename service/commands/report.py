"""`slidercrank report`: a design of a run as a document for a review."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

from ...model.errors import InputError, RunError
from ..designs.turning import require_turning
from ..runs.run_folder import slug, write_file
from ..runs.stored_runs import problem_of
from ..text.options import File, Run, Runs, Units, require_ending
from ..text.screen import say, waiting
from .run_choice import Choice, Where, run_of


def report(
    run: Run,
    *,
    choice: Choice,
    where: Where = None,
    out: Annotated[
        File, "Where to write it: HTML, or PDF for a name that ends in .pdf.  [default: <run>-design-<NO>.html here]"
    ] = None,
    pdf: Annotated[bool, "Write PDF instead of HTML."] = False,
    measured: Annotated[File, "A CSV file of measured curves to compare, as for `analyse`."] = None,
    runs: Runs = None,
    units: Units = "metric",
) -> None:
    """Write a report of one design for a review: job, front, design with all its numbers, tolerances, versions.

    HTML is one file without script that a browser shows and prints; nothing in it is fetched from elsewhere.
    """
    if out is not None and pdf and out.suffix.lower() in (".html", ".htm"):
        raise InputError(f"--pdf writes PDF; got --out {out}; name it .pdf, or leave --pdf out")
    require_ending("--out", out, ".html", ".htm", ".pdf")
    folder, result = run_of(run, runs)
    number = choice.number(result, run, where)
    pdf = pdf or (out is not None and out.suffix.lower() == ".pdf")
    ending = "pdf" if pdf else "html"
    file = out if out is not None else Path(f"{slug(folder.name)}-design-{number}.{ending}")
    with waiting("writing the report"):
        from ..designs.measured_file import measured_text, read_measured
        from ..report.design_report import design_report
        from ..report.html import html_file
        from ..report.pdf import pdf_file
        from ..report.subject import Subject

        versions, certificate = _kept(folder / "versions.json") or {}, _kept(folder / "certificate.json")
        kept: dict[str, Any] = {"versions": versions, "certificate": certificate, "system": units}
        subject = Subject(problem_of(folder, result), result, number, run=folder.name, **kept)
        if measured is not None:
            design = subject.design
            require_turning(design.part.motion, "what --measured compares")
            samples = read_measured(measured_text(measured), design.mechanism, design.linkage)
            subject = replace(subject, measured=samples)
        made = design_report(subject)
        content = pdf_file(made) if pdf else html_file(made)
    write_file(file, content)
    say(f"report: {file}")


def _kept(file: Path) -> dict[str, Any] | None:
    """Return the content of a JSON file of a run, None if there is none. Raises `RunError` for a damaged one."""
    if not file.is_file():
        return None
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RunError(f"{file} is damaged: {error}; run the command that wrote it again") from error
    return found if isinstance(found, dict) else None
