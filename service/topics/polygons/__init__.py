"""Kinematic polygons: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 80, "position, velocity and acceleration diagrams at --at", needs_job=False)
