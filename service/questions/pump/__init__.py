"""What a pump or compressor delivers: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 44, "delivered flow of pumps and compressors, its ripple, pressure torque")
