"""A crank speed that varies over the turn: numbers, text and figure."""

from ..topic import Topic

TOPIC = Topic(__name__, 92, "torque, forces and shaking at the speed profile of the job")
