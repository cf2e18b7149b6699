"""`slidercrank analyse`: all numbers of one design, and its figures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..model.errors import InputError
from .result import Row, json_text, rows_of
from .run_folder import disk
from .screen import console, give, say
from .tables import show_design

if TYPE_CHECKING:
    from ..model.mechanism import Mechanism
    from ..optimise.problem import Problem

_NEEDS_MASSES = ("torque", "_force_N", "_power_W", "reflected_inertia", "shaking", "self_locking")
_NEEDS_TOLERANCES = ("position_error",)
_NEEDS_SPEED = ("peak_slider_speed", "peak_slider_acceleration")


def analyse(
    job: Annotated[
        Path | None,
        typer.Argument(metavar="JOB", help="A job file: what masses, loads, tolerances and speed come from."),
    ] = None,
    crank: Annotated[str | None, typer.Option(metavar="LENGTH", help='Crank, such as "40 mm".')] = None,
    rod: Annotated[str | None, typer.Option(metavar="LENGTH", help="Connecting rod.")] = None,
    offset: Annotated[
        str | None, typer.Option(metavar="LENGTH", help='Offset of the slider line, such as "-20 mm".')
    ] = None,
    speed: Annotated[
        str | None,
        typer.Option(metavar="SPEED", help='Crank speed, such as "300 rpm"; negative is clockwise.'),
    ] = None,
    figures: Annotated[Path | None, typer.Option(metavar="DIR", help="Draw the design into design.png there.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print only JSON on standard output.")] = False,
) -> None:
    """Analyse one design.

    Without JOB it has no masses, loads and tolerances: motion and proportions only. Without --speed, nothing that
    depends on the speed is given then, and the offset is zero unless given. Dimensions that JOB fixes need not be
    repeated.
    """
    import numpy as np

    from ..model.linkage import Linkage
    from ..model.mechanism import Mechanism
    from ..objectives.analysis import analyse as all_numbers

    problem = _load(job)
    mechanism = Mechanism() if problem is None else problem.mechanism
    if speed is not None:
        mechanism = replace(mechanism, speed=_speed(speed))
    lengths = [_length(name, text, problem) for name, text in (("crank", crank), ("rod", rod), ("offset", offset))]
    row = rows_of(all_numbers(mechanism, np.array([lengths])).to_dict("list"))[0]
    notes = _leave_out(row, mechanism, alone=problem is None)
    if json:
        give(json_text(row))
    else:
        show_design(console(), row)
    for note in notes:
        say(note)
    if figures is not None:
        from .figures import draw_design

        title = "Design" if problem is None else problem.name
        with disk(figures):
            linkage = Linkage(lengths[0], lengths[1], lengths[2], mechanism.branch)
            file = draw_design(mechanism, linkage, row, figures, title=title, torque=problem is not None)
        say(f"figure: {file}")


def _load(job: Path | None) -> Problem | None:
    if job is None:
        return None
    from ..optimise.job import load_job

    return load_job(job)


def _leave_out(row: Row, mechanism: Mechanism, *, alone: bool) -> list[str]:
    """Take out what is not defined without a job or a speed; return why, in words."""
    notes = []

    def drop(parts: tuple[str, ...]) -> None:
        for key in row:
            if any(part in key for part in parts):
                row[key] = None

    if alone:
        drop(_NEEDS_MASSES + _NEEDS_TOLERANCES)
        notes.append("torque, forces and position error need masses, loads and tolerances: give a JOB")
        if not mechanism.speed:
            drop(_NEEDS_SPEED)
            notes.append("slider speed and acceleration need a crank speed: give --speed")
    return notes


def _length(name: str, text: str | None, problem: Problem | None) -> float:
    from ..optimise.units import LENGTH

    if text is not None:
        return _value(f"--{name}", text, LENGTH, sign="any" if name == "offset" else "positive")
    bounds = getattr(problem, name, None)
    if bounds is not None and bounds.fixed:
        return float(bounds.lower)
    if name == "offset" and problem is None:
        return 0.0
    raise InputError(f'--{name} is needed; write it like --{name} "40 mm"')


def _speed(text: str) -> float:
    from ..optimise.units import ANGULAR_SPEED

    return _value("--speed", text, ANGULAR_SPEED)


def _value(option: str, text: str, kind: Any, *, sign: Any = "any") -> float:
    """Return an option's value in SI. Raises `InputError` that names the option; a unit is always needed."""
    from ..optimise.units import shown, to_si

    try:
        float(text)
    except ValueError:
        pass
    else:
        raise InputError(
            f'{option} must be {kind.name} with its unit; got {shown(text)}; write it like "{kind.example}"'
        )
    try:
        return to_si(text, kind, sign=sign)
    except InputError as error:
        raise InputError(f"{option} {error}") from None
