"""Impacts in a loose joint: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 110, "impacts in the joint that [clearance] makes loose")
