"""Several cylinders on one crankshaft: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(__name__, 42, "several cylinders on one crankshaft: total torque and shaking")
