"""Quantities over one or two parameters: numbers, text and figure."""

from ....objectives.kinds import LENGTH
from ..front_or_job_question import FrontOrJobQuestion
from ..inputs import Input, PlainInput

QUESTION = FrontOrJobQuestion(
    package=__name__,
    subject="job",
    place=1006,
    help="""Sweep quantities over one or two of crank, rod, offset and speed.

    Where the linkage cannot rotate fully, or friction locks it, there is no value; the reason is shown instead.""",
    inputs=(
        PlainInput(
            "over",
            type=list[str],
            help='Parameter to sweep: "offset=0 mm..20 mm:5" (5 values). Give it twice for a grid.',
            example='"offset=0 mm..20 mm:5"',
            metavar="RANGE",
            required=True,
        ),
        PlainInput(
            "of",
            type=list[str],
            help='Quantity or formula to compute, such as peak_torque or "crank + rod". May be repeated.',
            example='"crank + rod"',
            metavar="QUANTITY",
            required=True,
        ),
        Input("crank", LENGTH, help='Crank, such as "40 mm", unless JOB fixes it.', sign="positive"),
        Input("rod", LENGTH, help="Connecting rod, likewise.", sign="positive"),
        Input("offset", LENGTH, help='Offset of the slider line, such as "-20 mm", likewise.'),
    ),
)
