"""Several cylinders on one crankshaft: numbers, text and figure."""

from ..design_question import DesignQuestion, Premise

QUESTION = DesignQuestion(
    __name__,
    42,
    "several cylinders on one crankshaft: total torque and shaking",
    title="Several cylinders",
    premise=Premise("several cylinders", lambda _, machine: machine.arrangement is not None),
)
