"""Crank angles, speeds and accelerations for a given slider motion."""

from ....objectives.kinds import ACCELERATION, LENGTH, SPEED
from ..design_question import DesignQuestion, QuestionCommand
from ..inputs import Input

QUESTION = DesignQuestion(
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
            help="Slider velocity along the slider line; gives the crank speed.",
            example="-1 m/s",
        ),
        Input(
            "slider_acceleration",
            ACCELERATION,
            help="Slider acceleration; gives the crank acceleration. Needs the velocity.",
            example="3 m/s^2",
        ),
    ),
    command=QuestionCommand(
        help="""Find every crank angle that puts the slider at a position.

    Most positions have two, one on each stroke; strokes are named for counter-clockwise rotation. Given the slider's
    velocity and acceleration, each angle comes with the crank speed and crank acceleration that produce them. Crank
    angle, speed and acceleration are positive counter-clockwise. The linkage need not rotate fully. For a job with a
    swinging crank, the crank angles are those within the swing.""",
        endpoint="find_crank_angles",
        job="Job file that supplies the branch and fixed dimensions; with --design, a run.",
        alone="Without JOB, the branch is open. Dimensions that JOB fixes need not be repeated. With --design, give a "
        "run instead of JOB; the dimensions are those of the design.",
    ),
)
