"""Extremes of every curve of one design: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(
    __name__, 85, "minimum and maximum of every curve, with their crank angles, and both strokes", needs_job=False
)
