"""Forces of the loads alone, without masses: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 10, "forces of the loads alone, mechanical advantage")
