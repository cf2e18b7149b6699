"""Start from rest: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 90, "start from rest under [drive], steady running")
