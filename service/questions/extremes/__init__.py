"""Extremes of every curve of one design: numbers, text and figure."""

from ..question import Question

QUESTION = Question(
    __name__, 85, "least and greatest value of every curve, where they are, both strokes", needs_job=False
)
