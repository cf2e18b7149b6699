"""Crank speed that varies over the revolution: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(__name__, 92, "torque, forces and shaking with the job's speed profile")
