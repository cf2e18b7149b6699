"""Forces of the loads alone, without masses: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 10, "forces of the loads alone, mechanical advantage")
