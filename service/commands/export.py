"""`slidercrank export`: the designs of a run as a table, and one of them as a drawing or in motion."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError
from ...objectives.kinds import System
from ..designs.selection import chosen_rows, none_meets, numbered, part_of
from ..jobs.find_run import find_run
from ..runs.result import Result, csv_text, json_text
from ..runs.run_folder import runs_place, write_file
from ..runs.stored_runs import problem_of, read_run
from ..text.options import Units, value_option
from ..text.screen import give, say, waiting
from .design_choice import Design, Knee, Lexicographic, Topsis, Where, chosen_design
from .optimise import NOTHING_FEASIBLE, Runs
from .runs import Run, shown_result

if TYPE_CHECKING:
    from ..designs.stored_designs import StoredDesign

_FILES = ("--dxf", "--svg", "--motion", "--gif", "--cycle")


def export(
    run: Run,
    csv: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the designs as CSV; - is standard output.")
    ] = None,
    json: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write all of it as JSON; - is standard output.")
    ] = None,
    design: Design = None,
    knee: Knee = False,
    topsis: Topsis = None,
    lexicographic: Lexicographic = None,
    dxf: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the linkage of one design at true scale as DXF.")
    ] = None,
    svg: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the same drawing as SVG.")] = None,
    motion: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write its motion as an HTML file that needs nothing else.")
    ] = None,
    gif: Annotated[Path | None, typer.Option(metavar="FILE", help="Write its motion as an animated GIF.")] = None,
    cycle: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write its motion, forces and torque over the cycle as CSV.")
    ] = None,
    where: Where = None,
    sort: Annotated[
        str | None, typer.Option(metavar="NAME", help="Sort the designs of --csv and --json, as in `front`.")
    ] = None,
    reverse: Annotated[bool, typer.Option("--reverse", help="Turn the order round.")] = False,
    at: Annotated[
        str | None, typer.Option(metavar="ANGLE", help='Crank angle of the drawing.  [default: "60 deg"]')
    ] = None,
    runs: Runs = None,
    units: Units = "metric",
) -> None:
    """Write the designs of a run to a file, or one design as a drawing for CAD, or in motion.

    One design is named by its number, or chosen by --knee, --topsis or --lexicographic. --where takes part of the
    designs, for the table and for the choice.
    """
    files = dict(zip(_FILES, (dxf, svg, motion, gif, cycle), strict=True))
    of_one = any(file is not None for file in files.values())
    picked = design is not None or knee or topsis is not None or lexicographic is not None
    if picked and not of_one:
        raise InputError(f"a design is written with {', '.join(_FILES)}; got none of them; give one")
    _require_something(csv, json, of_one=of_one)
    if at is not None and dxf is None and svg is None:
        raise InputError("--at is for --dxf and --svg, which are not asked for; add one or leave --at out")
    if (sort is not None or reverse) and csv is None and json is None:
        raise InputError(
            "--sort and --reverse are for --csv and --json, which are not asked for; add one or leave them out"
        )
    angle = _angle(at)
    for option, file in files.items():
        if file is not None and str(file) == "-":
            raise InputError(f"{option} writes a file; got -; name one")
    folder = find_run(run, runs_place(runs))
    result = read_run(folder)
    made: dict[Path, bytes] = {}
    if of_one:
        of_table = csv is not None or json is not None
        number = chosen_design(
            result,
            run,
            design=design,
            knee=knee,
            topsis=topsis,
            lexicographic=lexicographic,
            where=None if design is not None and of_table else where,
        )
        with waiting("drawing"):
            made = _made(result, folder, number, files, angle, units)
    chosen = chosen_rows(result, where or [], sort=sort, reverse=reverse) if result.designs else []
    if where and not chosen:
        say(f"slidercrank: {none_meets(result, where)}")
        raise typer.Exit(NOTHING_FEASIBLE)
    shown = shown_result(result, units, None if json is None else folder)
    whole = chosen == list(range(len(result.designs)))
    record = (shown if whole else part_of(shown, chosen)).record()
    if not whole:
        record["numbers"] = [row + 1 for row in chosen]
    for target, text in ((csv, csv_text(numbered(shown.designs, chosen))), (json, json_text(record))):
        if target == "-":
            give(text)
        elif target is not None:
            write_file(Path(target), text)
            say(f"{target}: {len(chosen)} designs")
    for file, content in made.items():
        write_file(file, content)
        say(f"{file}: design {number}")


def _require_something(csv: str | None, json: str | None, *, of_one: bool) -> None:
    if csv is None and json is None and not of_one:
        raise InputError(
            f"say what to export: --csv FILE, --json FILE, or of one design {', '.join(_FILES)}, each with a FILE"
        )
    if csv == json == "-":
        raise InputError("only one of --csv and --json can go to standard output; name a file for the other")


def _angle(at: str | None) -> float:
    from ..drawings.linkage_drawing import CRANK_ANGLE

    if at is None:
        return CRANK_ANGLE
    from ...objectives.kinds import ANGLE

    return value_option("--at", at, ANGLE)


def _made(
    result: Result, folder: Path, number: int, files: dict[str, Path | None], angle: float, units: System
) -> dict[Path, bytes]:
    """Return the contents of the files that are asked for of one design."""
    from ..designs.cycle_table import cycle_csv
    from ..designs.stored_designs import stored_design

    found = stored_design(problem_of(folder, result), result, number)
    makers: dict[str, Callable[[], bytes]] = {
        "--dxf": lambda: _dxf(found, result.name, number, angle),
        "--svg": lambda: _svg(found, result.name, number, angle),
        "--motion": lambda: _motion(found, result.name, number),
        "--gif": lambda: _gif(found, result.name, number),
        "--cycle": lambda: cycle_csv(found.mechanism, found.linkage, units).encode(),
    }
    return {file: makers[option]() for option, file in files.items() if file is not None}


def _dxf(found: StoredDesign, name: str, number: int, angle: float) -> bytes:
    from ..drawings.dxf import dxf_file
    from ..drawings.linkage_drawing import linkage_drawing

    return dxf_file(
        linkage_drawing(found.mechanism, found.linkage, name=name, design=f"design {number}", crank_angle=angle)
    )


def _svg(found: StoredDesign, name: str, number: int, angle: float) -> bytes:
    from ..drawings.linkage_drawing import linkage_drawing
    from ..drawings.svg import svg_file

    return svg_file(
        linkage_drawing(found.mechanism, found.linkage, name=name, design=f"design {number}", crank_angle=angle)
    )


def _motion(found: StoredDesign, name: str, number: int) -> bytes:
    from ..motion.player_page import player_page

    return player_page(found.mechanism, found.linkage, name=name, design=f"design {number}")


def _gif(found: StoredDesign, name: str, number: int) -> bytes:
    from ..motion.animated_gif import animated_gif

    return animated_gif(found.mechanism, found.linkage, name=name, design=f"design {number}")
