"""Question about one design: a topic, which `analyse --show` can add, or a separate command."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_type_hints

from ..designs.rotating_crank import require_rotating_crank
from ..runs.result import json_ready
from .inputs import Input, read_inputs

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...objectives.kinds import System
    from ...optimise.problem.problem import Problem
    from ..figures.panel_drawing import FigureSource
    from ..render.blocks import Block


@dataclass(frozen=True, kw_only=True)
class QuestionCommand:
    """Declaration of a question that is a command with its own endpoint instead of a topic of `analyse --show`.

    help: description, with the first sentence as a separate paragraph. endpoint: name of the endpoint. job: help text
    for JOB. alone: help text for use without JOB. curves: output that the command can write and draw, by functions
    `curves` and `figure` with the parameters of `numbers` and `units`.

    sizes: whether the question sizes a part of a rotating machine: it then needs a job, optional libraries, and several
    seconds. called: name of such a command, if it differs from that of the question. figure: name of the file drawn by
    a function `figure`, and its content.
    """

    help: str
    endpoint: str
    job: str
    alone: str = ""
    curves: str = ""
    sizes: bool = False
    called: str = ""
    figure: tuple[str, str] | None = None


@dataclass(frozen=True)
class Premise:
    """A need of a question that not every machine meets. words: without article or verb, "a motor"."""

    words: str
    is_met: Callable[[Problem, Mechanism], bool]


@dataclass(frozen=True)
class DesignQuestion:
    """Question declared by its folder, whose module `analysis` has the functions `numbers`, `blocks` and `figure`.

    The return type of `numbers` is the answer type, see `record_types`; its JSON Schema follows from it.

    package: package of the folder; its last part is the name. place: position among the questions, in ascending order.
    title: heading on the page; by default the name. premise: what it needs, if only some machines have it.
    shows: description for the help. needs_job: whether it needs masses, loads or tolerances. explained_columns: columns
    that it shows, which the table of a design therefore omits. inputs: accepted inputs. An optional function
    `compute_shared_options` in the module derives further options for numbers and figure from the given ones. An
    optional function `in_units` converts the numbers to a unit system.

    command: declaration as a separate command. Its numbers also accept `words`, the interface's names for the inputs,
    and `swing`, the swing in the job, or `problem` if the question sizes parts; the design need not rotate fully. The
    keys `note` or `notes` in them explain undefined values; an optional function `notes` of the module reports unproven
    optima.
    """

    package: str
    place: int = 0
    shows: str = ""
    needs_job: bool = True
    explained_columns: tuple[str, ...] = ()
    inputs: tuple[Input, ...] = ()
    command: QuestionCommand | None = None
    title: str = ""
    premise: Premise | None = None

    @property
    def analysis_module(self) -> Any:
        """Module of the folder with the functions."""
        return import_module(f"{self.package}.analysis")

    @property
    def record_type(self) -> Any:
        """Type of the numbers; see `record_types`."""
        return get_type_hints(self.analysis_module.numbers, include_extras=True)["return"]

    @property
    def name(self) -> str:
        """Name in `--show`, in JSON and of the figure's file."""
        return self.package.rpartition(".")[2]

    def bind_to_problem(
        self,
        mechanism: Mechanism,
        linkage: Linkage,
        problem: Problem | None,
        inputs: Mapping[str, object],
        words: Mapping[str, str] | None = None,
    ) -> BoundQuestion:
        """Return the question for a design.

        problem: problem of the design. inputs: by name, in SI or as text with a unit.

        words: the interface's names for the inputs, if different. Raises `InputError` for a swing problem unless the
        question accepts it, and for inputs that it does not accept.
        """
        swing = None if problem is None else problem.motion
        if self.command is None:
            require_rotating_crank(swing, f"the topic {self.name}")
            return self.bind_to_design(
                mechanism, linkage, read_inputs(self.inputs, inputs, f"the topic {self.name}", words)
            )
        context: dict[str, object] = {"swing": swing}
        if self.command.sizes:
            require_rotating_crank(swing, self.command.called or self.name)
            context = {"problem": problem}
        return self.bind_to_design(
            mechanism, linkage, {**context, "words": words, **read_inputs(self.inputs, inputs, self.name, words)}
        )

    def answer(
        self, mechanism: Mechanism, linkage: Linkage, problem: Problem | None, inputs: Mapping[str, object]
    ) -> dict[str, Any]:
        """Return the numbers as JSON, metric; called by `optimise.problem.question_registry`."""
        from ...model.linkage.require_single_linkage import require_single_rotating_linkage

        bound = self.bind_to_problem(mechanism, linkage, problem, inputs)
        if self.command is None:
            require_single_rotating_linkage(mechanism, linkage)
        record: dict[str, Any] = json_ready(bound.numbers())
        return record

    def bind_to_design(
        self, mechanism: Mechanism, linkage: Linkage, options: dict[str, Any] | None = None
    ) -> BoundQuestion:
        """Return the question for one design. options: options of its `numbers`."""
        return BoundQuestion(self, mechanism, linkage, dict(options or {}))


@dataclass(frozen=True)
class BoundQuestion:
    """Question about one design, with its options."""

    question: DesignQuestion
    mechanism: Mechanism
    linkage: Linkage
    options: dict[str, Any]

    @property
    def name(self) -> str:
        """Name of the question."""
        return self.question.name

    def numbers(self, cancelled: Callable[[], bool] = lambda: False) -> dict[str, Any]:
        """Return the numbers, ready for JSON. Raises `InputError` if the design has none."""
        self._add_options_shared_by_numbers_and_figure(cancelled)
        record: dict[str, Any] = self._analysis_module.numbers(self.mechanism, self.linkage, **self.options)
        return record

    def numbers_in_units(self, numbers: dict[str, Any], units: System) -> dict[str, Any]:
        """Return metric numbers converted to a unit system, for JSON."""
        from ..designs.display_units import convert_record

        converted: dict[str, Any] = getattr(self._analysis_module, "in_units", convert_record)(numbers, units)
        return converted

    def blocks(self, numbers: dict[str, Any]) -> list[Block]:
        """Return metric numbers as human-readable blocks."""
        result_blocks: list[Block] = self._analysis_module.blocks(numbers)
        return result_blocks

    def notes(self, numbers: dict[str, Any]) -> list[str]:
        """Return notes on the numbers: undefined values, or an unproven optimum."""
        if hasattr(self._analysis_module, "notes"):
            remarks: list[str] = self._analysis_module.notes(numbers)
            return remarks
        return [note for note in numbers.get("notes", [numbers.get("note")]) if note]

    def output_of(self, name: str, units: System) -> Any:
        """Return the output of a function in the module, by name: rows of `curves`, or a `figure`."""
        return getattr(self._analysis_module, name)(self.mechanism, self.linkage, units=units, **self.options)

    def draw(self, folder: Path, units: System = "metric") -> Path:
        """Draw the figure for known numbers into a folder; return the file."""
        from ..figures.panel_drawing import save_figure

        file = folder / f"{self.name}.png"
        save_figure(self._figure_source(), file, units)
        return file

    def figure(self, cancelled: Callable[[], bool], units: System = "metric") -> Figure:
        """Return the figure without computed numbers. Raises `InputError` if there is none."""
        from ..figures.panel_drawing import draw_figure

        self._add_options_shared_by_numbers_and_figure(cancelled)
        return draw_figure(self._figure_source(), units)

    def _add_options_shared_by_numbers_and_figure(self, cancelled: Callable[[], bool]) -> None:
        module = self._analysis_module
        if hasattr(module, "compute_shared_options"):
            inputs = {**self.options, "cancelled": cancelled}
            self.options.update(module.compute_shared_options(self.mechanism, self.linkage, **inputs))

    def _figure_source(self) -> FigureSource:
        hidden = {item.name for item in self.question.inputs if not item.drawn}
        options = {name: value for name, value in self.options.items() if name not in hidden}
        source: FigureSource = self._analysis_module.figure(self.mechanism, self.linkage, **options)
        return source

    @property
    def _analysis_module(self) -> Any:
        return self.question.analysis_module
