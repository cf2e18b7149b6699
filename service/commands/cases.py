"""`slidercrank cases`: the published mechanisms, what their authors printed, and what is exact."""

from __future__ import annotations

from typing import Annotated

import typer

from ..runs.result import json_text
from ..runs.run_folder import disk
from ..text.options import Figures, Json
from ..text.screen import console, give, say


def cases(
    case: Annotated[
        int | None, typer.Option("--case", min=1, max=5, metavar="N"), "Show only case N, 1 to 5, in full."
    ] = None,
    figures: Annotated[Figures, "Redraw the published figures as PNG files in this folder."] = None,
    json: Json = False,
) -> None:
    """Show published mechanisms: printed values, exact values and a verdict.

    Where they disagree, both are shown, with the reason. A printed value agrees if it differs from the exact one by at
    most one unit in its last digit.
    """
    from dataclasses import asdict

    from ..cases.published import CASES
    from ..cases.table import collect, counted, show_case

    chosen = CASES if case is None else (case,)
    found = collect(chosen)
    rows = [row for one in found for row in one.rows]
    if json:
        give(json_text({"cases": [asdict(one) for one in found]}))
    else:
        screen = console()
        for one in found:
            show_case(screen, one, full=case is not None)
        screen.print(f"{len(rows)} numbers: {counted(rows)}", style="bold", soft_wrap=True)
    if figures is not None:
        from ..cases.figures import draw_cases

        with disk(figures):
            for path in draw_cases(chosen, figures):
                say(f"figure: {path}")
