"""A crank that swings between two angles or places of the slider, and what drives it."""

from ....model.swing.words import Driver, Law, Side
from ....objectives.kinds import ANGLE, LENGTH, TIME
from ..inputs import Input
from ..question import Command, Question

QUESTION = Question(
    __name__,
    shows="swing of the crank between two angles, or two slider positions",
    inputs=(
        Input("start", ANGLE, help="Crank angle at which the way forth starts.", option="from", example="30 deg"),
        Input("end", ANGLE, help="Crank angle at which it ends; less is clockwise.", option="to", example="90 deg"),
        Input(
            "slider_start",
            LENGTH,
            help="Slider position at which the way forth starts, instead of crank angles.",
            option="slider_from",
            example="3.1 m",
        ),
        Input("slider_end", LENGTH, help="Slider position at which it ends.", option="slider_to"),
        Input(
            "crank_side",
            help="With slider positions: side of the line from crank pivot to slider pin, looking along it, that the "
            "crank pin is on; left if not said.",
            words=Side,
        ),
        Input("driver", help="What is driven: the crank by a torque, or the slider by a force.", words=Driver),
        Input("law", help="How the driver moves over time; slow is without inertia.", words=Law),
        Input("duration", TIME, help="Time of one way, for a law other than slow.", sign="positive", example="4 s"),
        Input(
            "actuator_tolerance",
            LENGTH,
            help="How far the driven slider may be off: adds to the crank's error.",
            sign="zero or more",
        ),
    ),
    command=Command(
        help="""Analyse a swing of the crank between two angles, or two slider positions, forth and back.

    The linkage need not turn through: it must close over the whole swing, and may not pass a dead point where the
    slider drives. Drive forces and torques are along +x and counter-clockwise; peaks are of the continuous crank
    angle. Loads that act on the slider are those of the job; its speed does not matter. What is not given is as in
    [motion] of the job; without it the crank drives, slowly.""",
        endpoint="analyse_swing",
        job="A job file: what masses, loads, friction and tolerances come from, and the swing of its [motion]. A run "
        "with --design.",
        alone="Without JOB nothing has mass.",
        curves="the curves of both ways",
    ),
)
