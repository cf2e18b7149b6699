"""Indicator diagram of the cylinders: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 45, "cylinder pressure over volume and crank angle, valve events")
