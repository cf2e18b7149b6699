"""Sections of a report on the job, and on the search for its front."""

from __future__ import annotations

from collections.abc import Mapping

from ...objectives.kinds import unit_text
from ...optimise.search.fingerprint import version_of
from ..render.numerals import rounded
from ..text.job_in_words import freedom_in_words, summarise
from .document import Block, Facts, Paragraph, Section
from .subject import Subject

_DREW = ("slidercrank", "numpy", "matplotlib", "pandas")


def job_section(subject: Subject) -> Section:
    """Return the section on the job in words, as `slidercrank check` prints it."""
    words = summarise(subject.problem)
    parts = {
        **{"Given": words["given"], "Tolerances": words["tolerances"], "Costs": words["costs"]},
        **{"May vary": words["variables"], "Requirements": words["rules"], "Objectives": words["objectives"]},
        "Freedom": [freedom_in_words(subject.problem)],
    }
    rows = {title: [unit_text(str(line)) for line in lines] for title, lines in parts.items() if lines}
    warned = tuple(Paragraph(f"Warning: {sentence}.", "bad") for sentence in subject.result.warnings)
    return Section("The job", (Facts(rows), *warned))


def search_section(subject: Subject, created: str) -> Section:
    """Return the section on the search: its outcome, its proven quality, its software. created: date of the report."""
    result, settings = subject.result, subject.problem.settings
    stationary = sum(row.get("status") == "stationary" for row in result.designs)
    rows = {
        "Run": subject.run,
        "Method": settings.method,
        "Seed": f"{result.seed}: the same job and seed give the same front, bit for bit",
        "Evaluations": f"{result.evaluations}",
        "Time of the search": f"{rounded(result.seconds)} s",
        "Designs": f"{len(result.designs)} on the front, none of which is better than another in all objectives",
        "Hypervolume": f"{result.hypervolume:.6f} of the box from the best values of the front to 1.1 times its range",
        "Outcome": f"{result.status}: {result.message}",
        "Stationary designs": f"{stationary} of {len(result.designs)}",
        "Computed by": _versions_in_words(subject.versions) or "not recorded",
        "Report drawn by": f"{_versions_in_words({name: version_of(name) for name in _DREW})}; {created}",
    }
    facts = Facts({title: [line] for title, line in rows.items()})
    return Section("How the front was found", (facts, *_certificate(subject)))


def _versions_in_words(versions: Mapping[str, str]) -> str:
    return ", ".join(f"{name} {number}" for name, number in versions.items())


def _certificate(subject: Subject) -> tuple[Block, ...]:
    certificate = subject.certificate
    if certificate is None:
        text = "No certificate: how far the front is from the true one was not proven (slidercrank certify does that)."
        return (Paragraph(text, "note"),)
    lines = [f"{certificate['status']}: {certificate['message']}"]
    for key, title in (
        ("epsilon", "epsilon proven, with the added designs"),
        ("epsilon_of_delivered", "epsilon proven, for this front alone"),
        ("gap_of_delivered", "gap of this front, certain"),
        ("hypervolume_gap", "hypervolume missed, at most"),
    ):
        value = certificate.get(key)
        if value is not None:
            lines.append(f"{title}: {rounded(float(value))}")
    lines += [
        f"{certificate['boxes']} boxes, {certificate['open_boxes']} open, {rounded(float(certificate['seconds']))} s"
    ]
    return (Facts({"Certificate": lines, **({"Notes": certificate["notes"]} if certificate["notes"] else {})}),)
