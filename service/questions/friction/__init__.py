"""Friction of one design: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(
    __name__,
    20,
    "efficiency, self-locking",
    explained_columns=("self_locking_margin_deg",),
    title="Friction",
)
