"""Crank angles, speeds and accelerations that move the slider as given."""

from ....objectives.kinds import ACCELERATION, LENGTH, SPEED
from ..inputs import Input
from ..question import Command, Question

QUESTION = Question(
    __name__,
    shows="crank angles that put the slider at a position",
    inputs=(
        Input(
            "slider_position",
            LENGTH,
            help="Slider position from the crank pivot along the slider line.",
            example="240 mm",
            required=True,
        ),
        Input(
            "slider_velocity",
            SPEED,
            help="Slider velocity along the slider line: gives the crank speed.",
            example="-1 m/s",
        ),
        Input(
            "slider_acceleration",
            ACCELERATION,
            help="Slider acceleration: gives the crank acceleration. Needs the velocity.",
            example="3 m/s^2",
        ),
    ),
    command=Command(
        help="""Find every crank angle that puts the slider at a position.

    Most positions have two, one on each stroke, named as for a crank that turns counter-clockwise. With the
    slider's velocity and acceleration, each has the crank speed and the crank acceleration that give them. Crank
    angle, speed and acceleration are positive counter-clockwise. Linkages that do not turn fully are accepted;
    of a job whose crank swings, the crank angles are those of its swing.""",
        endpoint="find_crank_angles",
        job="A job file: what the branch and fixed dimensions come from. A run with --design.",
        alone="Without JOB the branch is the open one. Dimensions that JOB fixes need not be repeated. With --design, "
        "a run stands in place of JOB, and the design has its dimensions.",
    ),
)
