"""Questions that one design is asked by their names; installed packages announce them, this one for `service`.

What interfaces ask stands above the problem, which therefore cannot import it. The entry points of the group
`slidercrank.questions` invert that, as those of `slidercrank.quantities` do for quantities: each is a mapping from
names to questions.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol

from ...model.errors import InputError

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

GROUP = "slidercrank.questions"


class Question(Protocol):
    """What a design can be asked."""

    def answer(
        self, mechanism: Mechanism, linkage: Linkage, problem: Any, inputs: Mapping[str, object]
    ) -> dict[str, Any]:
        """Return the answer as JSON has it, in metric units that its keys end with.

        mechanism, linkage: of the design, which need not turn fully. problem: the `Problem` that it answers, if any.
        inputs: by name, in SI or as text with a unit; None for usual ones. Raises `InputError` for what the
        design does not have, and for inputs that the question does not take.
        """


@cache
def questions() -> dict[str, Question]:
    """Return the questions of all installed packages by name. Raises `InputError` if two have one of the same name."""
    from importlib.metadata import entry_points

    found: dict[str, Question] = {}
    for entry in entry_points(group=GROUP):
        more = entry.load()
        both = sorted(found.keys() & more.keys())
        if both:
            raise InputError(f"the question {both[0]} must come from one installed package; got two; remove one")
        found |= more
    return found


def question_named(name: str) -> Question:
    """Return a question. Raises `InputError` with the nearest name, or all, for one that there is not."""
    known = questions()
    if name not in known:
        near = difflib.get_close_matches(str(name), known, n=1)
        every = f"choose from {', '.join(known)}" if known else "no installed package has one; install slidercrank anew"
        hint = f"did you mean {near[0]}?" if near else every
        raise InputError(f"a design is asked a question by its name; got {name!r}; {hint}")
    return known[name]
