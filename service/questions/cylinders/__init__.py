"""Several cylinders on one crankshaft: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 42, "several cylinders on one crankshaft: total torque and shaking")
