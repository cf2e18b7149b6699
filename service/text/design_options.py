"""Options that filter the designs of a run or select one, and search settings."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import typer

from ..designs.design_selection_options import chosen_row
from ..designs.selection import chosen_rows
from ..runs.result import Result
from .options import DesignOfRun


@dataclass(frozen=True)
class SettingOptions:
    """Optimiser settings that replace those of the job."""

    designs: Annotated[int | None, typer.Option(min=1, max=10_000), "Return at most N designs."] = None
    seed: Annotated[int | None, typer.Option(min=0), "Random seed."] = None

    @property
    def overrides(self) -> dict[str, Any]:
        """Settings given on the command line."""
        return {name: value for name, value in vars(self).items() if value is not None}


@dataclass(frozen=True)
class Selection:
    """Options that filter and sort the designs of a run."""

    where: Annotated[
        list[str] | None,
        typer.Option(metavar="CONDITION"),
        'Show only designs that meet this condition, such as "transmission_angle >= 40 deg" or "slow_stroke = '
        'inward". May be repeated.',
    ] = None
    sort: Annotated[
        str | None,
        typer.Option(metavar="NAME"),
        "Sort by a quantity or column: best first for an objective, else smallest first.",
    ] = None
    reverse: Annotated[bool, "Reverse the order."] = False

    @property
    def sorts(self) -> bool:
        """Whether the order differs from that of the run."""
        return self.sort is not None or self.reverse

    def rows(self, result: Result) -> list[int]:
        """Return the rows of the designs, in order."""
        return chosen_rows(result, self.where or [], sort=self.sort, reverse=self.reverse)


@dataclass(frozen=True)
class Pick:
    """Options that name one design of a run, or select it by its values."""

    design: DesignOfRun = None
    knee: Annotated[bool, "Choose the design nearest to the ideal, with objectives relative to their ranges."] = False
    topsis: Annotated[
        str | None,
        typer.Option(metavar="WEIGHTS"),
        'Choose one design by weights of the objectives, such as "peak_torque=2, transmission_angle=1".',
    ] = None
    lexicographic: Annotated[
        str | None,
        typer.Option(metavar="RANKING"),
        "Choose one design by ranked objectives, each with the amount it may give up for the next, such as "
        '"peak_torque: 5 %, time_ratio: 0.02, transmission_angle"; % refers to its range.',
    ] = None

    @property
    def chooses_by_value(self) -> bool:
        """Whether a design is selected by its values."""
        return self.knee or self.topsis is not None or self.lexicographic is not None

    def row(self, result: Result, rows: Sequence[int]) -> int | None:
        """Return the index of the row selected by its values, or None if there is no option or no row."""
        return chosen_row(result, rows, knee=self.knee, topsis=self.topsis, lexicographic=self.lexicographic)
