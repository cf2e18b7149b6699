"""Friction of one design: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 20, "efficiency, self-locking", tells=("self_locking_margin_deg",))
