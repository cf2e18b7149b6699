"""Textbook approximations: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 70, "errors of lumped-mass and series approximations")
