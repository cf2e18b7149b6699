"""Textbook approximations: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(
    __name__,
    70,
    "errors of lumped-mass and series approximations",
    title="Textbook formulas",
)
