"""What a press can do before a dead centre: numbers, text and figure."""

from ....objectives.kinds import LENGTH, TORQUE
from ..inputs import Input
from ..question import Question

TOUCH = Input(
    "touch_distance",
    LENGTH,
    "Touches its work, before the dead centre",
    "Distance before the dead centre at which a press touches its work.  [default: of the job's slider]",
    sign="positive",
)
DWELL = Input(
    "dwell_distance",
    LENGTH,
    "Dwells within",
    "Distance from the dead centre within which a press dwells.  [default: of the job's slider]",
    sign="positive",
    drawn=False,
)
RATED = Input(
    "rated_torque",
    TORQUE,
    "Rated torque",
    "Torque that clutch or motor may give at the crank.  [default: peak torque of the design]",
    sign="positive",
)
QUESTION = Question(
    __name__,
    46,
    "force, speed and work of a press before a dead centre, dwell",
    needs_job=False,  # with a touch distance and a rated torque
    inputs=(TOUCH, DWELL, RATED),
)
