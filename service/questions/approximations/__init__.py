"""Textbook approximations: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 70, "how wrong lumped masses and series are")
