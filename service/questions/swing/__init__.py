"""Crank that swings between two angles or slider positions, and its drive."""

from ....model.swing.swing_types import Driver, Law, Side
from ....objectives.kinds import ANGLE, LENGTH, TIME
from ..design_question import DesignQuestion, Premise, QuestionCommand
from ..inputs import Input

QUESTION = DesignQuestion(
    __name__,
    shows="swing of the crank between two angles, or two slider positions",
    inputs=(
        Input("start", ANGLE, help="Crank angle at the start of the forward stroke.", option="from", example="30 deg"),
        Input(
            "end", ANGLE, help="Crank angle at its end; a smaller angle means clockwise.", option="to", example="90 deg"
        ),
        Input(
            "slider_start",
            LENGTH,
            help="Slider position at the start of the forward stroke, instead of crank angles.",
            option="slider_from",
            example="3.1 m",
        ),
        Input("slider_end", LENGTH, help="Slider position at its end.", option="slider_to"),
        Input(
            "crank_side",
            help="With slider positions: the side of the crank pin, looking along the line from crank pivot to slider "
            "pin. [default: left]",
            words=Side,
        ),
        Input("driver", help="Driven body: the crank by a torque, or the slider by a force.", words=Driver),
        Input("law", help="Motion law of the driver; slow ignores inertia.", words=Law),
        Input(
            "duration", TIME, help="Duration of one stroke, for a law other than slow.", sign="positive", example="4 s"
        ),
        Input(
            "actuator_tolerance",
            LENGTH,
            help="Position tolerance of the driven slider; adds to the error of the crank angle.",
            sign="zero or more",
        ),
    ),
    command=QuestionCommand(
        help="""Analyse a swing of the crank between two angles, or two slider positions, and back.

    The linkage need not rotate fully, but it must close over the whole swing and, if the slider drives, must not pass
    a dead point. Drive forces are positive along +x, drive torques counter-clockwise; peaks are found over the
    continuous crank angle. Loads on the slider come from the job; its crank speed is ignored. Inputs that are not
    given are taken from [motion] in the job; if it has none, the crank drives slowly.""",
        endpoint="analyse_swing",
        job="Job file that supplies masses, loads, friction, tolerances and the swing in [motion]; with --design, a "
        "run.",
        alone="Without JOB, all bodies are massless.",
        curves="the curves of both strokes",
    ),
    premise=Premise("a crank that swings", lambda problem, _: problem.motion is not None),
)
