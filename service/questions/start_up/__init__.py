"""Start from rest: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 90, "start from rest under [drive], steady running")
