"""A question to more than one design: to a front, to several runs, or to a job."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal

from ...model.errors import InputError
from ..runs.result import json_ready
from .inputs import Input, read_inputs

if TYPE_CHECKING:
    from ...objectives.kinds import System
    from ..render.blocks import Block


@dataclass(frozen=True, kw_only=True)
class Answer:
    """An answer. record: numbers for JSON, by system of units. blocks: for people. met: whether it is what was asked.

    message: what was found, in short. found: what the search gives, for what a command does with it besides.
    """

    record: Callable[[System], dict[str, Any]]
    blocks: Sequence[Block]
    is_satisfied: bool = True
    message: str = ""
    notes: Sequence[str] = ()
    search_result: Any = None


@dataclass(frozen=True, kw_only=True)
class SearchListener:
    """Who waits for an answer. cancelled: asked now and then. tell: hears in words where the search is."""

    cancelled: Callable[[], bool] = lambda: False
    report: Callable[[str], None] = lambda _: None


@dataclass(frozen=True, kw_only=True)
class FrontOrJobQuestion:
    """A question, declared by its folder, whose module `analysis` has the function `answer`.

    It takes the subject, for a front also `row`, `watch`, `words`, what the door calls the inputs, and the inputs by
    name; it gives an `Answer`. package: the folder's; its last part is the name. subject: what is asked. help: what it
    answers, the first sentence in a paragraph of its own. row: whether a design of the front belongs to the question.
    path: of the endpoint, with names in braces. posted: whether the inputs are its body, not part of its address. key:
    of the numbers in its answer, "" if that is they.
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

    @property
    def name(self) -> str:
        """Name of the command and in JSON."""
        return self.package.rpartition(".")[2]

    @property
    def flags(self) -> dict[str, str]:
        """What the command line calls the inputs."""
        return {item.name: item.flag for item in self.inputs}

    def read(
        self, inputs: Mapping[str, object], row: int | None, words: Mapping[str, str] | None = None
    ) -> dict[str, Any]:
        """Return inputs as the answer takes them. Raises `InputError` for others, and for a design out of place."""
        if (row is None and self.row == "must") or (row is not None and self.row == "none"):
            rule = f"{self.name} is of {'one design' if row is None else 'a whole front'}"
            raise InputError(f"{rule}; got {'none; name it' if row is None else 'one design; leave it out'}")
        return read_inputs(self.inputs, inputs, self.name, words)

    def ask(
        self,
        subject: object,
        inputs: Mapping[str, object],
        *,
        row: int | None = None,
        words: Mapping[str, str] | None = None,
        watch: SearchListener | None = None,
    ) -> Answer:
        """Return the answer. inputs: by name. row: of a front. words: what the door calls the inputs, if not so.

        Raises as `read` does, and what the answer raises.
        """
        values = self.read(inputs, row, words)
        options: dict[str, Any] = {"row": row} if self.row != "none" else {}
        labels = {item.name: item.name for item in self.inputs} | dict(words or {})
        answer: Answer = import_module(f"{self.package}.analysis").answer(
            subject, **options, words=labels, watch=watch or SearchListener(), **values
        )
        return answer

    def answer_of(self, subject: object, row: int | None, inputs: Mapping[str, object]) -> dict[str, Any]:
        """Return the numbers as JSON has them, metric: a question of `optimise.problem.questions`."""
        record: dict[str, Any] = json_ready(self.ask(subject, inputs, row=row).record("metric"))
        return record
