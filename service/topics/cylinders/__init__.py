"""Several cylinders on one crankshaft: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 42, "several cylinders on one crankshaft: torque and shaking of the whole")
