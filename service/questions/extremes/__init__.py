"""Extremes of every curve of one design: numbers, text and figure."""

from ..question import Question

QUESTION = Question(
    __name__, 85, "minimum and maximum of every curve, with their crank angles, and both strokes", needs_job=False
)
