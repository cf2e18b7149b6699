"""Crank speed that varies over the revolution: numbers, text and figure."""

from ..design_question import DesignQuestion, Premise

QUESTION = DesignQuestion(
    __name__,
    92,
    "torque, forces and shaking with the job's speed profile",
    title="Uneven speed",
    premise=Premise("a speed profile", lambda _, machine: machine.speed_profile is not None),
)
