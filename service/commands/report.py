"""`slidercrank report`: a design of a run as a document for a review."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from ...model.errors import InputError
from ..runs.run_folder import slug, write_file
from ..text.options import File, Run, Runs, Units, require_ending
from ..text.screen import print_message, show_activity
from .run_choice import Choice, Where, run_of


def report(
    run: Run,
    *,
    choice: Choice,
    where: Where = None,
    out: Annotated[
        File,
        "File to write: HTML, or PDF if its name ends in .pdf. [default: <run>-design-<NO>.html in the current folder]",
    ] = None,
    pdf: Annotated[bool, "Write PDF instead of HTML."] = False,
    measured: Annotated[File, "CSV file of measured curves to compare with, as for `analyse`."] = None,
    runs: Runs = None,
    units: Units = "metric",
) -> None:
    """Write a design review report: job, front, the design with all its values, tolerances, versions.

    The HTML report is one self-contained file without scripts, to view and print in a browser.
    """
    if out is not None and pdf and out.suffix.lower() in (".html", ".htm"):
        raise InputError(f"with --pdf the file name must end in .pdf; got --out {out}; rename it, or leave --pdf out")
    require_ending("--out", out, ".html", ".htm", ".pdf")
    folder, result = run_of(run, runs)
    number = choice.number(result, run, where)
    pdf = pdf or (out is not None and out.suffix.lower() == ".pdf")
    ending = "pdf" if pdf else "html"
    file = out if out is not None else Path(f"{slug(folder.name)}-design-{number}.{ending}")
    with show_activity("writing the report"):
        from ..designs.measured_file import measured_text
        from ..report.run_report import run_report

        text = None if measured is None else measured_text(measured)
        content = run_report(folder, result, number, pdf=pdf, units=units, measured=text)
    write_file(file, content)
    print_message(f"report: {file}")
