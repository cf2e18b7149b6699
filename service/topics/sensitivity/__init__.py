"""Sensitivity to the dimensions: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 60, "change of every quantity with every dimension")
