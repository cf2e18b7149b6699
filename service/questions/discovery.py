"""Questions found in their folders, and the requested topics."""

from collections.abc import Iterable
from importlib import import_module
from pkgutil import iter_modules

from ...model.errors import InputError
from .design_question import DesignQuestion
from .front_or_job_question import FrontOrJobQuestion

ALL = "all"


def _discover_questions() -> dict[str, DesignQuestion | FrontOrJobQuestion]:
    package = __name__.rpartition(".")[0]
    folders = [item.name for item in iter_modules(import_module(package).__path__) if item.ispkg]
    declared = [getattr(import_module(f"{package}.{folder}"), "QUESTION", None) for folder in folders]
    return {
        question.name: question
        for question in sorted(
            (question for question in declared if question is not None), key=lambda question: question.place
        )
    }


QUESTIONS = _discover_questions()
"""All questions, by name."""
DESIGN_QUESTIONS = {name: one for name, one in QUESTIONS.items() if isinstance(one, DesignQuestion)}
"""All questions about one design, by name."""
FRONT_OR_JOB_QUESTIONS = {name: one for name, one in QUESTIONS.items() if isinstance(one, FrontOrJobQuestion)}
"""All questions about a front, several runs or a job, by name."""
QUESTION_COMMANDS = {name: one.command for name, one in DESIGN_QUESTIONS.items() if one.command is not None}
"""Questions that are separate commands."""
TOPICS = {name: one for name, one in DESIGN_QUESTIONS.items() if name not in QUESTION_COMMANDS}
"""Questions that `analyse --show` adds, in order."""
TOPIC_COLUMNS = tuple(key for topic in TOPICS.values() for key in topic.explained_columns)
"""Columns shown by topics, which the table of a design omits."""


INPUTS = {given.name: given for topic in TOPICS.values() for given in topic.inputs}
"""Inputs of the topics, by name; no two topics share an input name."""
TOPIC_OF_INPUT = {given.name: topic.name for topic in TOPICS.values() for given in topic.inputs}
"""Name of the topic for each input."""


def chosen_topics(names: Iterable[str], *, job: bool, word: str = "--show") -> tuple[str, ...]:
    """Return the requested topics without duplicates.

    Raises `InputError` for unknown topics and for those that need a missing job.

    word: the interface's name for the option.
    """
    import difflib

    requested = [name.strip().replace("-", "_") for text in names for name in text.split(",")]
    possible = tuple(name for name, topic in TOPICS.items() if job or not topic.needs_job)
    for name in requested:
        if name not in TOPICS and name != ALL:
            near = difflib.get_close_matches(name, TOPICS, n=1)
            hint = f"did you mean {near[0]}?" if near else f"choose from {', '.join(TOPICS)}, {ALL}"
            raise InputError(f"{word} must name a topic; got {name!r}; {hint}")
        if name not in (*possible, ALL):
            raise InputError(
                f"--show {name} needs masses, loads or tolerances; no job file was given; give one: analyse JOB "
                f"--show {name}"
            )
    return possible if ALL in requested else tuple(dict.fromkeys(requested))
