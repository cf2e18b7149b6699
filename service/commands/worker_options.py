"""Options that `slidercrank serve` and `slidercrank worker` have in common: what their workers may do."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer


class LogFormat(StrEnum):
    """Format of logs."""

    text = "text"
    json = "json"


Logs = Annotated[
    LogFormat, typer.Option("--log-format", help="Log format on standard error: for people, or one JSON object a line.")
]
Lease = Annotated[
    float, typer.Option(min=1.0, max=3600.0, help="Seconds until a job whose worker is gone goes to another one.")
]
Grace = Annotated[
    float, typer.Option(min=0.0, max=600.0, help="Seconds that a round has to end once the worker is to stop.")
]
AllowQuantity = Annotated[
    list[str] | None,
    typer.Option(metavar="MODULE:FUNCTION", help="Function that jobs may name as a quantity of their own. Repeatable."),
]
MostRunning = Annotated[
    int | None, typer.Option(min=1, help="Let at most so many jobs of the store be solved at a time.")
]
MostSeconds = Annotated[
    float | None, typer.Option(help="End the search of every job after so long, with what it found.")
]
MostEvaluations = Annotated[
    int | None, typer.Option(help="End the search of every job after so many designs, with what it found.")
]
MostMemory = Annotated[
    str | None,
    typer.Option(metavar="SIZE", help='Let a job fail if its worker takes more memory, such as "2 GB".'),
]
