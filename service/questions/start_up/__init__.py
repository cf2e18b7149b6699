"""Start from rest: numbers, text and figure."""

from ..design_question import DesignQuestion, Premise

QUESTION = DesignQuestion(
    __name__,
    90,
    "start from rest under [drive], steady running",
    title="Start from rest",
    premise=Premise("a motor", lambda _, machine: machine.drive is not None),
)
