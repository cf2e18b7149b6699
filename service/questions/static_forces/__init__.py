"""Forces of the loads only, without masses: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(
    __name__,
    10,
    "static forces from the loads only; mechanical advantage",
    title="Forces without masses",
)
