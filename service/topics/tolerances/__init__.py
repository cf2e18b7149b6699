"""Position error from tolerances: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(
    __name__,
    50,
    "position error: exact worst case, simulated machines, yield, what it comes from",
    of_numbers_only=("limit",),
)
