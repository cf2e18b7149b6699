"""Friction of one design: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 20, "efficiency, self-locking", tells=("self_locking_margin_deg",))
