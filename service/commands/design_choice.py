"""Options that name one design of a run: by its number, or as the one that `front` would choose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from ...model.errors import InputError
from ..designs.picking_options import picked_row, require_alone
from ..designs.selection import chosen_rows, none_meets
from ..runs.result import Result
from ..text.screen import say
from .optimise import NOTHING_FEASIBLE

Design = Annotated[int | None, typer.Option(metavar="NO", help="The design: its number in `slidercrank front RUN`.")]
Knee = Annotated[bool, typer.Option("--knee", help="The design nearest to the ideal, objectives by their range.")]
Topsis = Annotated[
    str | None,
    typer.Option(metavar="WEIGHTS", help="The design that weights of the objectives choose, as in `front`."),
]
Lexicographic = Annotated[
    str | None, typer.Option(metavar="RANKING", help="The design that ranked objectives choose, as in `front`.")
]
Where = Annotated[
    list[str] | None,
    typer.Option(metavar="CONDITION", help="Choose among the designs that meet it, as in `front`. May be repeated."),
]


def chosen_design(
    result: Result,
    run: str,
    *,
    design: int | None,
    knee: bool,
    topsis: str | None,
    lexicographic: str | None,
    where: Sequence[str] | None = None,
) -> int:
    """Return the number of the design that the options name, counted from 1.

    Exits with 3 where there is none: an empty front, or conditions that none meets. Raises `InputError` for a number
    that the run does not have, and for no choice or two.
    """
    if not result.designs:
        say(f"slidercrank: {result.message}")
        raise typer.Exit(NOTHING_FEASIBLE)
    picking = knee or topsis is not None or lexicographic is not None
    if design is None and not picking:
        raise InputError("a design is named by --design NO, --knee, --topsis or --lexicographic; got none; give one")
    if design is not None:
        require_alone(design, result, run, others=bool(picking or where))
        return design
    rows = chosen_rows(result, where or [])
    row = picked_row(result, rows, knee=knee, topsis=topsis, lexicographic=lexicographic)
    if row is None:
        say(f"slidercrank: {none_meets(result, where or [])}")
        raise typer.Exit(NOTHING_FEASIBLE)
    return row + 1
