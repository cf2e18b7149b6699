"""Impacts in a loose joint: numbers, text and figure."""

from ..question import Question

QUESTION = Question(__name__, 110, "impacts in the joint with clearance, from [clearance]")
