"""Capability of a press before a dead centre: numbers, text and figure."""

from ....objectives.kinds import LENGTH, TORQUE
from ..design_question import DesignQuestion, Premise
from ..inputs import Input

TOUCH = Input(
    "touch_distance",
    LENGTH,
    "Touch distance before the dead centre",
    "Distance before the dead centre at which the press touches the workpiece. [default: from the job's slider]",
    sign="positive",
)
DWELL = Input(
    "dwell_distance",
    LENGTH,
    "Dwell distance",
    "Distance from the dead centre within which the press dwells. [default: from the job's slider]",
    sign="positive",
    drawn=False,
)
RATED = Input(
    "rated_torque",
    TORQUE,
    "Rated torque",
    "Torque that the clutch or motor can deliver at the crank. [default: peak torque of the design]",
    sign="positive",
)
QUESTION = DesignQuestion(
    __name__,
    46,
    "force, speed and work of a press before a dead centre; dwell",
    needs_job=False,  # if touch distance and rated torque are given
    inputs=(TOUCH, DWELL, RATED),
    title="Press force",
    premise=Premise("a touch distance of the slider", lambda _, machine: machine.slider.touch is not None),
)
