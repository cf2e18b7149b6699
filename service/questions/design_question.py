"""A question to one design: a topic, which `analyse --show` can add, or a command of its own."""

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
    from ..figures.panels import FigureSource
    from ..render.blocks import Block


@dataclass(frozen=True, kw_only=True)
class QuestionCommand:
    """Declaration of a question that is a command with its own endpoint instead of a topic of `analyse --show`.

    help: what it answers, the first sentence in a paragraph of its own. endpoint: name of the endpoint. job, alone:
    help on JOB, and on what holds without. curves: what the command can write and draw, by functions `curves` and
    `figure` that take what `numbers` takes and `units`.

    sizes: whether the question sizes a part of a machine that turns: it needs a job, libraries that are not always
    there, and seconds. called: name of such a command, if it is not the question's. figure: name of the file that it
    draws by a function `figure`, and what that shows.
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
class DesignQuestion:
    """A question, declared by its folder, whose module `analysis` has the functions `numbers`, `blocks` and `figure`.

    What `numbers` returns is the type of the answer (`answers`), from which its JSON Schema follows.

    package: the folder's; its last part is the name. place: where it stands among the others, in ascending order.
    shows: for the help. needs_job: whether it needs masses, loads or tolerances. tells: columns that it shows, which
    the table of a design therefore leaves out. inputs: what it may be asked with. A function `prepare` of that module,
    if it has one, gives further options for numbers and figure, from those that there are. A function `in_units`, if it
    has one, gives the numbers in a system of units.

    command: if it is one of its own. Its numbers also take `words`, what the door calls the inputs, and `swing`, that
    the crank makes in its job, or `problem` if it sizes; the design need not turn fully. `note` or `notes` among them
    say what is undefined; a function `notes` of the module, if it has one, what is not proven.
    """

    package: str
    place: int = 0
    shows: str = ""
    needs_job: bool = True
    tells: tuple[str, ...] = ()
    inputs: tuple[Input, ...] = ()
    command: QuestionCommand | None = None

    @property
    def analysis(self) -> Any:
        """The folder's module with the functions."""
        return import_module(f"{self.package}.analysis")

    @property
    def answer_type(self) -> Any:
        """Type of the numbers, a record of `answers`."""
        return get_type_hints(self.analysis.numbers, include_extras=True)["return"]

    @property
    def name(self) -> str:
        """Name in `--show`, in JSON and of the figure's file."""
        return self.package.rpartition(".")[2]

    def for_problem(
        self,
        mechanism: Mechanism,
        linkage: Linkage,
        problem: Problem | None,
        inputs: Mapping[str, object],
        words: Mapping[str, str] | None = None,
    ) -> BoundQuestion:
        """Return the question to a design. problem: that it answers. inputs: by name, in SI or as text with a unit.

        words: what the door calls the inputs, if not by their names. Raises `InputError` for a problem that swings,
        unless the question takes it, and for inputs that it does not take.
        """
        swing = None if problem is None else problem.motion
        if self.command is None:
            require_rotating_crank(swing, f"the topic {self.name}")
            return self.for_design(
                mechanism, linkage, read_inputs(self.inputs, inputs, f"the topic {self.name}", words)
            )
        context: dict[str, object] = {"swing": swing}
        if self.command.sizes:
            require_rotating_crank(swing, self.command.called or self.name)
            context = {"problem": problem}
        return self.for_design(
            mechanism, linkage, {**context, "words": words, **read_inputs(self.inputs, inputs, self.name, words)}
        )

    def answer(
        self, mechanism: Mechanism, linkage: Linkage, problem: Problem | None, inputs: Mapping[str, object]
    ) -> dict[str, Any]:
        """Return the numbers as JSON has them, metric: a question of `optimise.problem.questions`."""
        from ...model.linkage.single import single

        bound = self.for_problem(mechanism, linkage, problem, inputs)
        if self.command is None:
            single(mechanism, linkage)
        record: dict[str, Any] = json_ready(bound.numbers())
        return record

    def for_design(
        self, mechanism: Mechanism, linkage: Linkage, options: dict[str, Any] | None = None
    ) -> BoundQuestion:
        """Return the question to one design. options: of its `numbers`."""
        return BoundQuestion(self, mechanism, linkage, dict(options or {}))


@dataclass(frozen=True)
class BoundQuestion:
    """A question to one design, with its options."""

    question: DesignQuestion
    mechanism: Mechanism
    linkage: Linkage
    options: dict[str, Any]

    @property
    def name(self) -> str:
        """Name of the question."""
        return self.question.name

    def numbers(self, cancelled: Callable[[], bool] = lambda: False) -> dict[str, Any]:
        """Return the numbers, ready for JSON. Raises `InputError` where the design has none."""
        self._prepare(cancelled)
        record: dict[str, Any] = self._analysis.numbers(self.mechanism, self.linkage, **self.options)
        return record

    def numbers_in(self, numbers: dict[str, Any], units: System) -> dict[str, Any]:
        """Return the numbers, metric as they are, in a system of units, for JSON."""
        from ..designs.display_units import record_in

        converted: dict[str, Any] = getattr(self._analysis, "in_units", record_in)(numbers, units)
        return converted

    def blocks(self, numbers: dict[str, Any]) -> list[Block]:
        """Return the numbers, metric as they are, for people."""
        shown_blocks: list[Block] = self._analysis.blocks(numbers)
        return shown_blocks

    def notes(self, numbers: dict[str, Any]) -> list[str]:
        """Return notes on the numbers: values that are undefined, or an optimum that is not proven."""
        if hasattr(self._analysis, "notes"):
            remarks: list[str] = self._analysis.notes(numbers)
            return remarks
        return [note for note in numbers.get("notes", [numbers.get("note")]) if note]

    def written(self, name: str, units: System) -> Any:
        """Return the output of a function of the module by its name: rows of `curves`, or a `figure`."""
        return getattr(self._analysis, name)(self.mechanism, self.linkage, units=units, **self.options)

    def draw(self, folder: Path, units: System = "metric") -> Path:
        """Write the figure into a folder, after its numbers; return the file."""
        from ..figures.panels import save_figure

        file = folder / f"{self.name}.png"
        save_figure(self._drawn(), file, units)
        return file

    def figure(self, cancelled: Callable[[], bool], units: System = "metric") -> Figure:
        """Return the figure, its numbers not asked for before. Raises `InputError` where there is none."""
        from ..figures.panels import figure_of

        self._prepare(cancelled)
        return figure_of(self._drawn(), units)

    def _prepare(self, cancelled: Callable[[], bool]) -> None:
        if hasattr(self._analysis, "prepare"):
            self.options.update(
                self._analysis.prepare(self.mechanism, self.linkage, **{**self.options, "cancelled": cancelled})
            )

    def _drawn(self) -> FigureSource:
        hidden = {item.name for item in self.question.inputs if not item.drawn}
        options = {name: value for name, value in self.options.items() if name not in hidden}
        source: FigureSource = self._analysis.figure(self.mechanism, self.linkage, **options)
        return source

    @property
    def _analysis(self) -> Any:
        return self.question.analysis
