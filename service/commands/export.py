"""`slidercrank export`: the designs of a run as a table, and one of them as a drawing or an animation."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ...model.errors import InputError
from ...objectives.count_text import counted
from ...objectives.kinds import ANGLE
from ..designs.selection import no_match_message, numbered_rows, result_part
from ..motion.design_file import ENDINGS, design_file
from ..runs.result import csv_text, json_text
from ..runs.run_folder import write_file
from ..runs.stored_runs import problem_of
from ..text.design_options import Selection
from ..text.options import Angle, File, Output, Run, Runs, Units, option_value, require_ending
from ..text.screen import print_message, print_output, show_activity
from .ending import end_without_design
from .run_choice import Choice, Where, result_in_units, run_of

_FILES = {f"--{name}": endings for name, endings in ENDINGS.items()}
"""Options that write one design, and how their files may end."""


@dataclass(frozen=True)
class Tables:
    """Files with all designs."""

    csv: Annotated[Output, "Write the designs as CSV; - is standard output."] = None
    json: Annotated[Output, "Write the whole run as JSON; - is standard output."] = None

    @property
    def requested(self) -> bool:
        """Whether there is one."""
        return self.csv is not None or self.json is not None


@dataclass(frozen=True)
class DesignFiles:
    """Files with one design, see `_FILES`."""

    dxf: Annotated[File, "Write the linkage of one design as DXF, at true scale."] = None
    svg: Annotated[File, "Write the same drawing as SVG."] = None
    motion: Annotated[File, "Write its motion as a self-contained HTML file."] = None
    gif: Annotated[File, "Write its motion as an animated GIF."] = None
    cycle: Annotated[File, "Write its motion, forces and torque over the cycle as CSV."] = None


@dataclass(frozen=True)
class TableSelection(Selection):
    """The designs in a table, also the candidates for a choice."""

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
    at: Annotated[Angle, 'Crank angle of the drawing. [default: "60 deg", or the middle of a swing]'] = None,
    runs: Runs = None,
    units: Units = "metric",
) -> None:
    """Write the designs of a run to a file, or one design as a CAD drawing or an animation.

    Choose one design by its number, or with --knee, --topsis or --lexicographic. --where restricts the designs, both
    for the table and for the choice.
    """
    from ..designs.stored_designs import stored_design

    files = {f"--{name}": file for name, file in vars(of_design).items() if file is not None}
    csv, json, conditions = tables.csv, tables.json, selection.where
    if (choice.design is not None or choice.chooses_by_value) and not files:
        raise InputError(f"one design needs at least one of {', '.join(_FILES)}; got none; add one")
    if not tables.requested and not files:
        raise InputError(
            f"nothing to export; give --csv FILE, --json FILE, or for one design {', '.join(_FILES)}, each with a FILE"
        )
    if csv == json == "-":
        raise InputError("only one of --csv and --json may go to standard output; name a file for the other")
    if at is not None and not files.keys() & {"--dxf", "--svg"}:
        raise InputError("--at needs --dxf or --svg; got neither; add one, or leave --at out")
    if selection.sorts and not tables.requested:
        raise InputError("--sort and --reverse need --csv or --json; got neither; add one, or leave them out")
    angle = option_value("--at", at, ANGLE)
    for option, file in files.items():
        require_ending(option, file, *_FILES[option])
    for option, name in (("--csv", csv), ("--json", json)):
        require_ending(option, None if name in (None, "-") else Path(str(name)), option.replace("--", "."))
    folder, result = run_of(run, runs)
    contents: dict[Path, bytes] = {}
    if files:
        of_table = choice.design is not None and tables.requested
        number = choice.number(result, run, None if of_table else conditions)
        stored = stored_design(problem_of(folder, result), result, number)
        named = {"name": result.name, "design": f"design {number}"}
        with show_activity("drawing"):
            contents = {file: design_file(option[2:], stored, angle, units, **named) for option, file in files.items()}
    chosen = selection.rows(result) if result.designs else []
    if conditions and not chosen:
        end_without_design(no_match_message(result, conditions))
    run_in_units = result_in_units(result, units, None if json is None else folder)
    has_every_design = chosen == list(range(len(result.designs)))
    record = (run_in_units if has_every_design else result_part(run_in_units, chosen)).record()
    if not has_every_design:
        record["numbers"] = [row + 1 for row in chosen]
    for target, text in ((csv, csv_text(numbered_rows(run_in_units.designs, chosen))), (json, json_text(record))):
        if target == "-":
            print_output(text)
        elif target is not None:
            write_file(Path(target), text)
            print_message(f"{target}: {counted(len(chosen), 'design')}")
    for file, content in contents.items():
        write_file(file, content)
        print_message(f"{file}: design {number}")
