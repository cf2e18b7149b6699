"""Options of the command line that are quantities: a number with its unit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...model.errors import InputError
from ...model.extras import required
from ...objectives.kinds import System

if TYPE_CHECKING:
    from ...optimise.problem.problem import Problem


def drawable(folder: Path | None) -> Path | None:
    """Refuse to draw before anything is computed, where figures cannot be drawn."""
    if folder is not None:
        required("matplotlib", "figures need")
    return folder


Units = Annotated[
    System,
    typer.Option(
        "--units",
        envvar="SLIDERCRANK_UNITS",
        show_envvar=False,
        help="Units of what is shown and written: metric, or inch for in, lbf, lbf in, lb, hp and psi. Values that are "
        "given name their own unit.  [env: SLIDERCRANK_UNITS]",
    ),
]


Crank = Annotated[
    str | None, typer.Option("--crank", metavar="LENGTH", help='Crank, such as "40 mm", unless JOB fixes it.')
]
Rod = Annotated[str | None, typer.Option("--rod", metavar="LENGTH", help="Connecting rod, likewise.")]
Offset = Annotated[
    str | None,
    typer.Option("--offset", metavar="LENGTH", help='Offset of the slider line, such as "-20 mm", likewise.'),
]


def lengths_of(problem: Problem | None, crank: str | None, rod: str | None, offset: str | None) -> list[float]:
    """Return crank, rod and offset, m, each as `length_option` gives it."""
    return [length_option(name, text, problem) for name, text in (("crank", crank), ("rod", rod), ("offset", offset))]


def length_option(name: str, text: str | None, problem: Problem | None) -> float:
    """Return a dimension, m: as given, else what the job fixes, else (offset, without a job) zero."""
    from ...objectives.kinds import LENGTH

    if text is not None:
        return value_option(f"--{name}", text, LENGTH, sign="any" if name == "offset" else "positive")
    bounds = getattr(problem, name, None)
    if bounds is not None and bounds.fixed:
        return float(bounds.lower)
    if name == "offset" and problem is None:
        return 0.0
    raise InputError(f'--{name} is needed; write it like --{name} "40 mm"')


def speed_option(text: str) -> float:
    """Return the crank speed, rad/s."""
    from ...objectives.kinds import ANGULAR_SPEED

    return value_option("--speed", text, ANGULAR_SPEED)


def value_option(option: str, text: str, kind: Any, *, sign: Any = "any") -> float:
    """Return an option's value in SI. Raises `InputError` that names the option; a unit is always needed."""
    from ...optimise.job.units import shown, to_si

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
