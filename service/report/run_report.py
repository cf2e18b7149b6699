"""Report on a design of a run on disk."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...model.errors import RunError
from ...objectives.kinds import System
from ..designs.measured_curves_file import parse_measured_curves
from ..designs.rotating_crank import require_rotating_crank
from ..runs.result import Result
from ..runs.runs_on_disk import problem_of
from .design_report import design_report
from .subject import Subject, alternatives_of, bookmarks_of_run


def run_report(
    folder: Path, result: Result, number: int, *, pdf: bool, units: System, measured: str | None = None
) -> bytes:
    """Return the report on a design of a run, by its number, counted from 1: HTML, or PDF.

    measured: CSV text of measured curves for comparison.
    """
    versions, certificate = _load_json(folder / "versions.json") or {}, _load_json(folder / "certificate.json")
    records: dict[str, Any] = {"versions": versions, "certificate": certificate, "system": units}
    problem, bookmarks = problem_of(folder, result), bookmarks_of_run(folder)
    alternatives = alternatives_of(bookmarks, problem, result)
    subject = Subject(problem, result, number, run=folder.name, alternatives=alternatives, **records)
    if measured is not None:
        design = subject.design
        require_rotating_crank(design.part.motion, "a comparison with measured curves")
        subject = replace(subject, measured=parse_measured_curves(measured, design.mechanism, design.linkage))
    report = design_report(subject)
    if pdf:
        from .pdf import pdf_file

        return pdf_file(report)
    from .html import html_file

    return html_file(report)


def _load_json(file: Path) -> dict[str, Any] | None:
    """Return the content of a JSON file of a run, or None if there is none. Raises `RunError` for a damaged file."""
    if not file.is_file():
        return None
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RunError(f"{file} is damaged: {error}; run the command that wrote it again") from error
    return content if isinstance(content, dict) else None
