"""Indicator diagram of the cylinders: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 45, "pressure over volume and crank angle in the cylinders, valve events")
