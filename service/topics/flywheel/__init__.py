"""Flywheel for a speed fluctuation: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 100, "flywheel for a speed --fluctuation")
