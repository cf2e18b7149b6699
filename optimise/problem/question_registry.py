"""Questions by name; installed packages register their own, and this package registers those of `service`.

The questions of interfaces belong to a layer above the problem, which therefore cannot import them. Entry points in the
group `slidercrank.questions` invert the dependency, as those in `slidercrank.quantities` do: each is a mapping from
names to questions.

A `Remark` is a sentence that points out a possible mistake in a job, with the change that corrects it, if there is one.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol

from ...model.errors import InputError

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism


@dataclass(frozen=True)
class Change:
    """A change to a job. path: key in its tables, such as "load #1.force". label: its effect, as an instruction.

    value: new value at the key, as a job file writes it; None removes the key.
    """

    path: str
    value: Any
    label: str


class Remark(str):
    """A sentence that points out a possible mistake in a job, and the change that corrects it, if there is one."""

    change: Change | None

    def __new__(cls, sentence: str, change: Change | None = None) -> Remark:
        """Return a sentence with its change."""
        remark = super().__new__(cls, sentence)
        remark.change = change
        return remark


def changes_of(sentences: Iterable[str]) -> list[dict[str, Any]]:
    """Return the changes that the sentences propose, each with its sentence, path, value and label."""
    remarks = [sentence for sentence in sentences if isinstance(sentence, Remark)]
    return [{"sentence": str(remark), **vars(remark.change)} for remark in remarks if remark.change is not None]


GROUP = "slidercrank.questions"
SUBJECTS = {"design": "a design", "front": "a front", "runs": "several runs", "job": "a job"}
"""Possible subjects of a question, as named in messages."""
_REMEDIES = {
    "front": "write it like front.ask(question)",
    "job": "write it like problem.ask(question)",
    "runs": "use the command of that name, or a client of a service",
}


class DesignQuestion(Protocol):
    """Question about a design. A question with a `subject`, "front" or "job", is a `FrontOrJobQuestion`."""

    def answer(
        self, mechanism: Mechanism, linkage: Linkage, problem: Any, inputs: Mapping[str, object]
    ) -> dict[str, Any]:
        """Return the answer as JSON data, in the metric units that its keys end with.

        mechanism, linkage: machine and lengths of the design, which need not rotate fully. problem: the `Problem` that
        it solves, if any. inputs: inputs by name, in SI or as text with a unit; None for the defaults. Raises
        `InputError` for anything that the design lacks, and for unknown inputs.
        """


class FrontOrJobQuestion(Protocol):
    """A question about a front or a job."""

    def answer_of(self, subject: Any, row: int | None, inputs: Mapping[str, object]) -> dict[str, Any]:
        """Return the answer as JSON data, in the metric units that its keys end with.

        subject: the `ParetoFront` or the `Problem`. row: row of the design that the question is about, if any. inputs:
        inputs by name; None for the defaults. Raises `InputError` as `Question.answer` does.
        """


@cache
def questions() -> dict[str, Any]:
    """Return the questions of all installed packages by name.

    Raises `InputError` if two packages register the same name.
    """
    from importlib.metadata import entry_points

    found: dict[str, Any] = {}
    for entry in entry_points(group=GROUP):
        more = entry.load()
        both = sorted(found.keys() & more.keys())
        if both:
            raise InputError(f"the question {both[0]} must come from one installed package; got two; remove one")
        found |= more
    return found


def subject_of_question(name: str) -> str:
    """Return the subject of a question: "design", "front", "runs" or "job".

    Raises `InputError` with the nearest name, or all, for an unknown question.
    """
    known = questions()
    if name not in known:
        near = difflib.get_close_matches(str(name), known, n=1)
        every = f"choose from {', '.join(known)}" if known else "no installed package has one; reinstall slidercrank"
        hint = f"did you mean {near[0]}?" if near else every
        raise InputError(f"there is no question {name!r}; {hint}")
    return getattr(known[name], "subject", "design")


def question_about(subject: str, name: str) -> Any:
    """Return a question about a subject. Raises `InputError` as `subject_of_question`, or for another subject."""
    if (of := subject_of_question(name)) != subject:
        if of == "design":
            raise InputError(
                f"the question {name} needs one design; got none; name one, as a row of a front or lengths"
            )
        raise InputError(f"the question {name} needs {SUBJECTS[of]}; got a {subject}; {_REMEDIES[of]}")
    return questions()[name]
