"""Sensitivity to the dimensions: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 60, "sensitivity of every quantity to every dimension")
