"""Strength of the crank and the rod: numbers, text and figure."""

from ..design_question import DesignQuestion, Premise

QUESTION = DesignQuestion(
    __name__,
    48,
    "stresses, safety factors, pins and wear of crank and rod, and the location of the greatest stress",
    title="Strength",
    premise=Premise("a material and pins", lambda _, machine: machine.strength is not None),
)
