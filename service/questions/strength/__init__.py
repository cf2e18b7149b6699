"""Strength of crank and rod: numbers, text and figure."""

from ..question import Question

QUESTION = Question(
    __name__, 48, "stresses, safety factors, pins and wear of crank and rod, and the place of greatest stress"
)
