"""Textbook approximations: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 70, "how wrong lumped masses and series are")
