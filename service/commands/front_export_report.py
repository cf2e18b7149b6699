"""`slidercrank front`, `export` and `report`: the designs of a run, on screen and as files."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ...model.errors import InputError
from ...objectives.kinds import ANGLE, column_key_in_system, count_with_noun
from ..designs.columns import find_columns
from ..designs.selection import no_match_message, numbered_rows, result_with_rows
from ..motion.design_file import ENDINGS, design_file
from ..runs.result import csv_text, json_text
from ..runs.run_folder import slug, write_file
from ..runs.runs_on_disk import problem_of
from ..text.options import Angle, File, Json, Output, Rows, Run, Runs, Selection, Units, option_value, require_ending
from ..text.screen import console, print_message, print_output, show_activity
from ..text.tables import ROWS, show_design, show_front, show_result, show_violated
from .design_of_job_or_run import Choice, Where, folder_and_result, result_in_units
from .exit_and_interruption import NoDesigns, exit_without_design
from .optimise import show_files


def front(
    run: Run,
    *,
    selection: Selection,
    columns: Annotated[
        str | None, typer.Option(metavar="NAMES"), "Quantities or columns to show, separated by commas."
    ] = None,
    rows: Rows = ROWS,
    choice: Choice,
    runs: Runs = None,
    units: Units = "metric",
    json: Json = False,
) -> None:
    """Show the front of a run, part of it, or one selected design.

    --knee, --topsis and --lexicographic select among the designs that meet --where; --design names one.
    """
    folder, result = folder_and_result(run, runs)
    if not result.designs:
        raise NoDesigns(result)
    chosen_columns = find_columns(columns, list(result.designs[0])) if columns else None
    chosen, conditions = selection.rows(result), selection.where
    picked = (
        choice.row(result, chosen)
        if choice.design is None
        else choice.selected_design_number(result, run, conditions) - 1
    )
    if picked is not None:
        chosen = [picked]
    shows_trade_offs = not conditions and (
        json or not (selection.sorts or columns or picked is not None or rows != ROWS)
    )
    result = result_in_units(result, units, folder if shows_trade_offs else None)
    listed_columns = names = None
    if chosen_columns is not None:
        listed_columns = find_columns(
            ",".join(column_key_in_system(column.key, units)[0] for column in chosen_columns), list(result.designs[0])
        )
        names = [column.key for column in listed_columns]
    if json:
        record = result_with_rows(result, chosen).record(names)
        print_output(json_text(record if picked is None else {**record, "number": picked + 1}))
    elif picked is not None:
        screen = console()
        screen.print(f"{result.name}: design {picked + 1} of {len(result.designs)}", style="bold", soft_wrap=True)
        show_design(screen, result.designs[picked], only=names)
        of_one = {key: excess[picked] for key, excess in result.violated.items() if excess[picked] > 0.0}
        show_violated(screen, of_one, result.designs[picked])
    elif not (conditions or selection.sorts or columns or rows != ROWS):
        show_result(console(), result)
        show_files(folder)
    elif chosen:
        screen = console()
        count = "" if len(chosen) == len(result.designs) else f"{len(chosen)} of "
        screen.print(
            f"{result.name}: {count}{count_with_noun(len(result.designs), 'design')}", style="bold", soft_wrap=True
        )
        show_front(screen, result, chosen, columns=listed_columns, limit=rows)
    if not chosen:
        exit_without_design(no_match_message(result, conditions or []))


_FILES = {f"--{name}": endings for name, endings in ENDINGS.items()}
"""Options that write one design, and the allowed file endings."""


@dataclass(frozen=True)
class Tables:
    """Files with all designs."""

    csv: Annotated[Output, "Write the designs as CSV; - is standard output."] = None
    json: Annotated[Output, "Write the whole run as JSON; - is standard output."] = None

    @property
    def is_any_requested(self) -> bool:
        """Whether any file is requested."""
        return self.csv is not None or self.json is not None


@dataclass(frozen=True)
class DesignFiles:
    """Files with one design; see `_FILES`."""

    dxf: Annotated[File, "Write the linkage of one design as DXF, at true scale."] = None
    svg: Annotated[File, "Write the same drawing as SVG."] = None
    motion: Annotated[File, "Write its motion as a self-contained HTML file."] = None
    gif: Annotated[File, "Write its motion as an animated GIF."] = None
    cycle: Annotated[File, "Write its motion, forces and torque over the cycle as CSV."] = None


@dataclass(frozen=True)
class TableSelection(Selection):
    """Designs to write in a table, which are also the candidates for a selection."""

    where: Where = None
    sort: Annotated[
        str | None, typer.Option(metavar="NAME"), "Sort the designs of --csv and --json, as in `front`."
    ] = None


def export(
    run: Run,
    *,
    tables: Tables,
    choice: Choice,
    of_design: DesignFiles,
    selection: TableSelection,
    at: Annotated[
        Angle, 'Crank angle of the drawing. [default: "60 deg", or the middle of a swing; an arm: 90 deg to the frame]'
    ] = None,
    runs: Runs = None,
    units: Units = "metric",
) -> None:
    """Write the designs of a run to a file, or one design as a CAD drawing or an animation.

    Select one design by its number, or with --knee, --topsis or --lexicographic. --where restricts the designs, both
    for the table and for the selection.
    """
    from ..designs.stored_designs import stored_design

    files = {f"--{name}": file for name, file in vars(of_design).items() if file is not None}
    csv, json, conditions = tables.csv, tables.json, selection.where
    if (choice.design is not None or choice.chooses_by_value) and not files:
        raise InputError(f"one design needs at least one of {', '.join(_FILES)}; got none; add one")
    if not tables.is_any_requested and not files:
        raise InputError(
            f"nothing to export; give --csv FILE, --json FILE, or for one design {', '.join(_FILES)}, each with a FILE"
        )
    if csv == json == "-":
        raise InputError("only one of --csv and --json may go to standard output; name a file for the other")
    if at is not None and not files.keys() & {"--dxf", "--svg"}:
        raise InputError("--at needs --dxf or --svg; got neither; add one, or leave --at out")
    if selection.sorts and not tables.is_any_requested:
        raise InputError("--sort and --reverse need --csv or --json; got neither; add one, or leave them out")
    angle = option_value("--at", at, ANGLE)
    for option, file in files.items():
        require_ending(option, file, *_FILES[option])
    for option, name in (("--csv", csv), ("--json", json)):
        require_ending(option, None if name in (None, "-") else Path(str(name)), option.replace("--", "."))
    folder, result = folder_and_result(run, runs)
    contents: dict[Path, bytes] = {}
    if files:
        of_table = choice.design is not None and tables.is_any_requested
        number = choice.selected_design_number(result, run, None if of_table else conditions)
        stored = stored_design(problem_of(folder, result), result, number)
        named = {"name": result.name, "design": f"design {number}"}
        with show_activity("drawing"):
            contents = {file: design_file(option[2:], stored, angle, units, **named) for option, file in files.items()}
    chosen = selection.rows(result) if result.designs else []
    if conditions and not chosen:
        exit_without_design(no_match_message(result, conditions))
    run_in_units = result_in_units(result, units, None if json is None else folder)
    has_every_design = chosen == list(range(len(result.designs)))
    record = (run_in_units if has_every_design else result_with_rows(run_in_units, chosen)).record()
    if not has_every_design:
        record["numbers"] = [row + 1 for row in chosen]
    for target, text in ((csv, csv_text(numbered_rows(run_in_units.designs, chosen))), (json, json_text(record))):
        if target == "-":
            print_output(text)
        elif target is not None:
            write_file(Path(target), text)
            print_message(f"{target}: {count_with_noun(len(chosen), 'design')}")
    for file, content in contents.items():
        write_file(file, content)
        print_message(f"{file}: design {number}")


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
    """Write a design-review report: job, front, the design with all its values, tolerances, versions.

    The HTML report is one self-contained file without scripts, for viewing and printing in a browser.
    """
    if out is not None and pdf and out.suffix.lower() in (".html", ".htm"):
        raise InputError(f"with --pdf the file name must end in .pdf; got --out {out}; rename it, or leave --pdf out")
    require_ending("--out", out, ".html", ".htm", ".pdf")
    folder, result = folder_and_result(run, runs)
    number = choice.selected_design_number(result, run, where)
    pdf = pdf or (out is not None and out.suffix.lower() == ".pdf")
    ending = "pdf" if pdf else "html"
    file = out if out is not None else Path(f"{slug(folder.name)}-design-{number}.{ending}")
    with show_activity("writing the report"):
        from ..designs.measured_curves_file import text_of_measured_file
        from ..report.run_report import run_report

        text = None if measured is None else text_of_measured_file(measured)
        content = run_report(folder, result, number, pdf=pdf, units=units, measured=text)
    write_file(file, content)
    print_message(f"report: {file}")
