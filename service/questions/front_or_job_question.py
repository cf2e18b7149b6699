"""Questions about a front or a job."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal

from ...model.errors import InputError
from ...objectives.kinds import System
from ..render.blocks import Block
from ..runs.result import json_ready
from .inputs import Input, read_inputs


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Answer to a question. record: numbers for JSON, by unit system. blocks: human-readable. message: its summary.

    is_satisfied: whether the request was met. search_result: result of the search, for further use by a command.
    """

    record: Callable[[System], dict[str, Any]]
    blocks: Sequence[Block]
    is_satisfied: bool = True
    message: str = ""
    notes: Sequence[str] = ()
    search_result: Any = None


@dataclass(frozen=True, kw_only=True)
class SearchListener:
    """Search listener. cancelled: polled; whether to stop. report: receives the progress in words."""

    cancelled: Callable[[], bool] = lambda: False
    report: Callable[[str], None] = lambda _: None


@dataclass(frozen=True, kw_only=True)
class FrontOrJobQuestion:
    """Declaration of a question about a front or a job. The module `analysis` in its folder has the function `analyse`.

    `analyse` takes the subject, for a front also `row`, then `watch`, `words` (names of the inputs in the interface)
    and the inputs by name; it returns an `Answer`. package: package of the folder; its last part is the name. subject:
    kind of object that the question is about. help: description, with the first sentence as a separate paragraph. row:
    whether the question is about one design on the front. path: path of the endpoint, with names in braces. posted:
    whether the inputs are in the body of the request instead of its address. key: key of the numbers in the answer, ""
    if they are the whole answer. title: heading on the page; by default the name.
    """

    package: str
    subject: Literal["front", "runs", "job"]
    help: str
    inputs: tuple[Input, ...]
    row: Literal["none", "may", "must"] = "none"
    place: int = 0
    path: str = ""
    posted: bool = False
    key: str = ""
    title: str = ""

    @property
    def name(self) -> str:
        """Name of the command and of its JSON object."""
        return self.package.rpartition(".")[2]

    @property
    def shows(self) -> str:
        """Subject of the question, in words."""
        return self.help.partition(".")[0]

    @property
    def flags(self) -> dict[str, str]:
        """Command-line options for the inputs, by name."""
        return {item.name: item.flag for item in self.inputs}

    def read(
        self, inputs: Mapping[str, object], row: int | None, words: Mapping[str, str] | None = None
    ) -> dict[str, Any]:
        """Return the inputs in the form that the answer needs.

        Raises `InputError` for unknown inputs, and for a design number that is missing or not accepted.
        """
        if (row is None and self.row == "must") or (row is not None and self.row == "none"):
            if row is None:
                raise InputError(f"{self.name} needs one design on the front; got none; name it")
            raise InputError(f"{self.name} applies to the whole front; got one design; leave it out")
        return read_inputs(self.inputs, inputs, self.name, words)

    def ask(
        self,
        subject: object,
        inputs: Mapping[str, object],
        *,
        row: int | None = None,
        words: Mapping[str, str] | None = None,
        listener: SearchListener | None = None,
    ) -> Answer:
        """Return the answer. inputs: by name. row: row of a front. words: the interface's names for the inputs.

        Raises the errors of `read` and of the answer.
        """
        values = self.read(inputs, row, words)
        options: dict[str, Any] = {"row": row} if self.row != "none" else {}
        labels = {item.name: item.name for item in self.inputs} | dict(words or {})
        result: Answer = import_module(f"{self.package}.analysis").analyse(
            subject, **options, words=labels, watch=listener or SearchListener(), **values
        )
        return result

    def answer_of(self, subject: object, row: int | None, inputs: Mapping[str, object]) -> dict[str, Any]:
        """Return the numbers as JSON, metric; called by `optimise.problem.question_registry`."""
        record: dict[str, Any] = json_ready(self.ask(subject, inputs, row=row).record("metric"))
        return record
