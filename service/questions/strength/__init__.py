"""Strength of crank and rod: numbers, text and figure."""

from ..question import Question

QUESTION = Question(
    __name__, 48, "stresses, safeties, pins and wear of crank and rod, and where the stress is greatest"
)
