"""`slidercrank cases`: published mechanisms, with printed and exact values."""

from typing import Annotated

import typer

from ..runs.result import json_text
from ..runs.run_folder import translate_disk_errors
from ..text.options import Figures, Json
from ..text.screen import console, print_message, print_output


def cases(
    case: Annotated[
        int | None, typer.Option("--case", min=1, max=5, metavar="N"), "Show only case N, 1 to 5, in full."
    ] = None,
    figures: Annotated[Figures, "Redraw the published figures as PNG files in this folder."] = None,
    json: Json = False,
) -> None:
    """Show published mechanisms with printed values, exact values and a verdict.

    Where they disagree, both are shown with the reason. A printed value agrees if it differs from the exact one by at
    most one unit in its last digit.
    """
    from dataclasses import asdict

    from ..cases.case_table import collect_cases, show_case, verdict_counts_text
    from ..cases.printed_values import CASES

    chosen = CASES if case is None else (case,)
    tables = collect_cases(chosen)
    rows = [row for case_table in tables for row in case_table.rows]
    if json:
        print_output(json_text({"cases": [asdict(case_table) for case_table in tables]}))
    else:
        screen = console()
        for case_table in tables:
            show_case(screen, case_table, full=case is not None)
        screen.print(f"{len(rows)} numbers: {verdict_counts_text(rows)}", style="bold", soft_wrap=True)
    if figures is not None:
        from ..cases.figures import draw_cases

        with translate_disk_errors(figures):
            for path in draw_cases(chosen, figures):
                print_message(f"figure: {path}")
