"""Strength of crank and rod: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 48, "stresses, safeties, pins and wear of crank and rod, and where the stress is greatest")
