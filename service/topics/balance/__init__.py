"""Shaking of the frame: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(
    __name__,
    40,
    "shaking force and moment",
    tells=("peak_shaking_force_N", "rms_shaking_force_N", "peak_shaking_moment_Nm", "rms_shaking_moment_Nm"),
)
