"""Command-line options that several commands share: numbers with their unit, filters and choices of designs."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, fields, is_dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_type_hints

import typer

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.optional_packages import import_extra
from ...objectives.kinds import ANGULAR_SPEED, LENGTH, Kind, System
from ..designs.design_selection_options import chosen_row
from ..designs.selection import parse_value, rows_meeting_conditions
from ..runs.result import Result

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...optimise.problem.problem import Problem


def require_matplotlib(folder: Path | None) -> Path | None:
    """Raise an error before any computation if figures cannot be drawn."""
    if folder is not None:
        import_extra("matplotlib", "figures need")
    return folder


JobFile = Annotated[Path, typer.Argument(metavar="JOB")]
File = Annotated[Path | None, typer.Option(metavar="FILE")]
Figures = Annotated[Path | None, typer.Option(metavar="DIR", callback=require_matplotlib)]
Output = Annotated[str | None, typer.Option(metavar="FILE")]
"""File name, or - for standard output."""
Angle = Annotated[str | None, typer.Option(metavar="ANGLE")]
Length = Annotated[str | None, typer.Option(metavar="LENGTH")]
Speed = Annotated[str | None, typer.Option(metavar="SPEED")]
Number = Annotated[int, typer.Argument(metavar="NO", help="The design: its number in `slidercrank front RUN`.")]
JobOrRun = Annotated[Path | None, typer.Argument(metavar="JOB")]
Units = Annotated[
    System,
    typer.Option(
        "--units",
        envvar="SLIDERCRANK_UNITS",
        show_envvar=False,
        help="Units of all output: metric, or inch for in, lbf, lbf in, lb, hp and psi. Values that you enter have "
        "their own units. [env: SLIDERCRANK_UNITS]",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print only JSON on standard output.")]
DesignOfRun = Annotated[
    int | None, typer.Option(metavar="NO", help="A design of a run: its number in `slidercrank front RUN`.")
]
Runs = Annotated[Path | None, typer.Option(help="Folder of runs. [default: SLIDERCRANK_RUNS, else ./runs]")]
Run = Annotated[
    str,
    typer.Argument(
        metavar="RUN",
        help='The run: its folder, its name in the folder of runs, the start of the name, or "latest".',
    ),
]

Rows = Annotated[int, typer.Option(min=0), "Show at most N designs; 0 shows all."]
AllowQuantity = Annotated[
    list[str] | None,
    typer.Option(metavar="MODULE:FUNCTION"),
    "Function that jobs may use as a custom quantity. May be repeated.",
]


def typer_command(command: Callable[..., None]) -> Callable[..., None]:
    """Return a typer command from a function whose parameters have their help as text in `Annotated`.

    A parameter whose type is a dataclass of options stands for the fields of the dataclass. A parameter with several
    `inspect.Parameter` in `Annotated` stands for these and receives a dict. Flags are off by default.
    """
    hints = get_type_hints(command, include_extras=True)
    groups: dict[str, Any] = {name: hint for name, hint in hints.items() if is_dataclass(hint)}
    dicts = {name: parts for name, hint in hints.items() for parts in get_args(hint)[1:] if isinstance(parts, tuple)}
    options: list[inspect.Parameter] = []
    for name, parameter in inspect.signature(command).parameters.items():
        options += dicts.get(name, ())
        if name in dicts:
            continue
        field_options = [(name, parameter.default, hints[name])]
        if name in groups:
            types = get_type_hints(groups[name], include_extras=True)
            field_options = [(field.name, field.default, types[field.name]) for field in fields(groups[name])]
        options += [
            inspect.Parameter(
                option, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=_option_with_help(option, hint)
            )
            for option, default, hint in field_options
        ]

    @wraps(command)
    def run(**given: Any) -> None:
        for name, group in groups.items():
            given[name] = group(**{field.name: given.pop(field.name) for field in fields(group)})
        for name, parameters in dicts.items():
            given[name] = {parameter.name: given.pop(parameter.name) for parameter in parameters}
        command(**given)

    run.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    run.__annotations__ = {option.name: option.annotation for option in options}
    return run


def _option_with_help(name: str, hint: Any) -> Any:
    """Return the annotation of an option for typer, with its help in the option."""
    kind, *options = get_args(hint)
    if not isinstance(options[-1], str):
        return hint
    *options, text = options
    flag = [f"--{name.replace('_', '-')}"] if kind is bool else []
    option = copy(options[0]) if options else typer.Option(*flag)
    option.help = text
    return Annotated[kind, option]


def _flag(name: str) -> str:
    return f"--{name}"


@dataclass(frozen=True)
class Dimensions:
    """Crank, rod and offset as given."""

    crank: Annotated[Length, 'Crank length, such as "40 mm", unless JOB fixes it.'] = None
    rod: Annotated[Length, "Length of the connecting rod, unless JOB fixes it."] = None
    offset: Annotated[Length, 'Offset of the slider line, such as "-20 mm", unless JOB fixes it.'] = None

    def lengths(self, problem: Problem | None, word: Callable[[str], str] = _flag) -> list[float]:
        """Return crank, rod and offset, m, each from `length_option`."""
        return [length_option(name, getattr(self, name), problem, word) for name in DIMENSIONS]

    def linkage(self, problem: Problem, word: Callable[[str], str] = _flag) -> Linkage:
        """Return the linkage on a job's branch. word: function that returns the interface's name for a dimension."""
        from ...model.linkage.linkage import Linkage

        crank, rod, offset = self.lengths(problem, word)
        return Linkage(crank, rod, offset, problem.mechanism.branch)


def length_option(name: str, text: str | None, problem: Problem | None, word: Callable[[str], str] = _flag) -> float:
    """Return a dimension, m: as given, or as fixed by the job, or zero (offset, without a job).

    word: function that returns the interface's name for it.
    """
    if text is not None:
        return parse_value(word(name), text, LENGTH, sign="any" if name == "offset" else "positive")
    bounds = getattr(problem, name, None)
    if bounds is not None and bounds.fixed:
        return float(bounds.lower)
    if name == "offset" and problem is None:
        return 0.0
    raise InputError(f'{word(name)} is needed; write it like {word(name)} "40 mm"')


def speed_option(text: str, word: str = "--speed") -> float:
    """Return the crank speed, rad/s. word: the interface's name for it."""
    return parse_value(word, text, ANGULAR_SPEED)


def require_ending(option: str, file: Path | None, *endings: str) -> None:
    """Raise an error for an output file with a wrong ending, a directory, or standard output.

    endings: allowed file endings, with their dots; a name may have none.
    """
    if file is None:
        return
    if str(file) == "-":
        raise InputError(f"{option} must name a file; got -; name one")
    if file.is_dir() or file.suffix.lower() not in ("", *endings):
        name = file / f"name{endings[0]}" if file.is_dir() else file.with_suffix(endings[0])
        raise InputError(f"the file of {option} must end with {' or '.join(endings)}; got {file}; name it {name}")


def option_value(option: str, text: str | None, kind: Kind, *, sign: Any = "any") -> float | None:
    """Return an option's value as `parse_value` does, or None if the option is omitted."""
    return None if text is None else parse_value(option, text, kind, sign=sign)


@dataclass(frozen=True)
class SettingOptions:
    """Optimiser settings that replace those of the job."""

    designs: Annotated[int | None, typer.Option(min=1, max=10_000), "Return at most N designs."] = None
    seed: Annotated[int | None, typer.Option(min=0), "Random seed."] = None

    @property
    def stated_settings(self) -> dict[str, Any]:
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
        return rows_meeting_conditions(result, self.where or [], sort=self.sort, reverse=self.reverse)


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
