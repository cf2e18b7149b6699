"""Indicator diagram of the cylinders: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 45, "pressure over volume and crank angle in the cylinders, valve events")
