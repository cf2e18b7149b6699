"""Impacts in a loose joint: numbers, text and figure."""

from ..design_question import DesignQuestion, Premise

QUESTION = DesignQuestion(
    __name__,
    110,
    "impacts in the joint with clearance, from [clearance]",
    title="Loose joint",
    premise=Premise("a joint with clearance", lambda _, machine: machine.clearance is not None),
)
