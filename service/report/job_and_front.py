"""Sections of a report on the job, and on the search for its front."""

from collections.abc import Mapping
from functools import partial

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import unit_text
from ...optimise.search.checkpoints import version_of
from ..designs.columns import find_column
from ..designs.judged_requirements import front_violations_in_words
from ..figures.parallel_coordinates import parallel_coordinates
from ..figures.scatter_matrix import scatter_matrix
from ..render.numerals import format_cell, format_cell_with_unit, format_number
from ..text.job_in_words import freedom_in_words, problem_in_words
from .document import Block, Facts, Paragraph, Picture, Section, Table
from .subject import Subject

_DREW = ("slidercrank", "numpy", "matplotlib", "pandas")


def job_section(subject: Subject) -> Section:
    """Return the section on the job in words, as `slidercrank check` prints it."""
    words = problem_in_words(subject.problem)
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
        "Time of the search": f"{format_number(result.seconds, 2)} s",
        "Designs": f"{len(result.designs)} on the front, none of which is better than another in all objectives",
        "Hypervolume": f"{result.hypervolume:.6f} of the box from the best values of the front to 1.1 times its range",
        "Outcome": f"{result.status}: {result.message}",
        "Stationary designs": f"{stationary} of {len(result.designs)}",
        "Computed by": _versions_in_words(subject.versions) or "not recorded",
        "Report drawn by": f"{_versions_in_words({name: version_of(name) for name in _DREW})}; {created}",
    }
    facts = Facts({title: [line] for title, line in rows.items()})
    return Section("How the front was found", (facts, *_certificate_blocks(subject)))


def _versions_in_words(versions: Mapping[str, str]) -> str:
    return ", ".join(f"{name} {number}" for name, number in versions.items())


def _certificate_blocks(subject: Subject) -> tuple[Block, ...]:
    certificate = subject.certificate
    if certificate is None:
        remedy = " (slidercrank certify does that)" if subject.design.mechanism.lever is None else ""
        text = f"No certificate: how far the front is from the true one was not proven{remedy}."
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
            lines.append(f"{title}: {format_cell(float(value))}")
    lines += [
        f"{certificate['boxes']} boxes, {certificate['open_boxes']} open, "
        f"{format_number(float(certificate['seconds']), 2)} s"
    ]
    return (Facts({"Certificate": lines, **({"Notes": certificate["notes"]} if certificate["notes"] else {})}),)


_MANY = 400
"""Number of designs from which figures of the front are drawn as raster images."""


def front_section(subject: Subject) -> Section:
    """Return the ranges of the objectives, the marked designs, and the figures of the front."""
    result = subject.result
    lines = map(unit_text, front_violations_in_words(result))
    violations = (Paragraph(f"Beyond the allowable value: {line}.", "bad") for line in lines)
    blocks: list[Block] = [*violations, _objective_range_table(subject), _comparison_table(subject)]
    raster = len(result.designs) > _MANY
    if len(result.designs) > 1:
        if len(result.objectives) > 1:
            title = "Every pair of objectives"
            blocks.append(Picture(title, partial(scatter_matrix, subject.front, subject.system), raster, tallest=5.2))
        title = "Dimensions and objectives of every design"
        blocks.append(Picture(title, partial(parallel_coordinates, subject.front, subject.system), raster))
    else:
        blocks.append(Paragraph("The front consists of this one design.", "note"))
    return Section("The front", tuple(blocks))


def _objective_range_table(subject: Subject) -> Table:
    rows = []
    for objective in subject.result.objectives:
        ranked = sorted(subject.result.designs, key=objective.minimised_value)
        best, worst = ranked[0][objective.column], ranked[-1][objective.column]
        value = subject.row[objective.column]
        place = 1 + sum(objective.minimised_value(row) < objective.minimised_value(subject.row) for row in ranked)
        rank = f"{place} of {len(ranked) + (subject.changed is not None)}"
        numbers = (format_cell(value), format_cell(best), format_cell(worst), unit_text(objective.unit), rank)
        sense = (
            objective.sense
            if objective.target is None
            else f"target {format_cell_with_unit(objective.target, objective.unit)}"
        )
        rows.append((objective.title, sense, *numbers))
    return Table(
        f"Objectives within the front: {subject.label}",
        ("objective", "wanted", "this design", "best", "worst", "unit", "rank"),
        tuple(rows),
        (0.29, 0.13, 0.13, 0.12, 0.12, 0.08, 0.13),
        frozenset({2, 3, 4, 6}),
    )


def _comparison_table(subject: Subject) -> Table:
    """Return this design beside the best in each objective and the knee."""
    result = subject.result
    titles = {objective.quantity: objective.title for objective in result.objectives}
    labels: dict[int, list[str]] = {subject.number - 1: ["this design" if subject.changed is None else "unchanged"]}
    for name, place in result.extremes.items():
        labels.setdefault(place, []).append(f"best {titles[name]}")
    if result.knee is not None and len(result.objectives) > 1:
        labels.setdefault(result.knee, []).append("knee")
    names = list(subject.row)
    keys = [find_column(name, names).key for name in DIMENSIONS] + [objective.column for objective in result.objectives]
    keys += ["slow_stroke"] if result.strokes_differ else []
    columns = [find_column(key, list(subject.row)) for key in dict.fromkeys(keys)]
    rows = tuple(
        (
            str(place + 1),
            ", ".join(words),
            *(subject.format_cell(column.key, result.designs[place][column.key]) for column in columns),
        )
        for place, words in labels.items()
    )
    if subject.changed is not None:
        rows = (
            ("", "this design", *(subject.format_cell(column.key, subject.row[column.key]) for column in columns)),
            *rows,
        )
    heads = tuple(f"{column.title}, {unit_text(column.unit)}" if column.unit else column.title for column in columns)
    lengths, label_width = 0.104, 0.15  # headings of objectives contain the longest words: "transmission"
    share = (0.95 - label_width - lengths * len(DIMENSIONS)) / (len(columns) - len(DIMENSIONS))
    return Table(
        "Marked designs",
        ("no.", "what it is", *heads),
        rows,
        (0.05, label_width, *(lengths for _ in DIMENSIONS), *(share for _ in columns[len(DIMENSIONS) :])),
        frozenset({0, *range(2, 2 + len(columns))}),
        bold=frozenset({0}),
        small=len(columns) > 5,
    )
