"""Forces of the loads alone, without masses: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 10, "static forces from the loads only; mechanical advantage")
