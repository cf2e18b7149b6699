"""The design most like one of a front that also meets further conditions: numbers and text."""

from ..plain_input import Plain
from ..wider import WiderQuestion

QUESTION = WiderQuestion(
    package=__name__,
    subject="front",
    row="must",
    place=1002,
    path="jobs/{number}/designs/{design}/like",
    posted=True,
    key="like",
    help="""Find the design most like one of a run that also meets further conditions.

    It is Pareto-optimal for the run's job with the conditions added, and of those designs the nearest, objectives by
    their range over the run's front. Nothing is saved.""",
    inputs=(
        Plain(
            "where",
            type=list[str],
            help="What it must also meet: a quantity, a dimension or a formula, >= <= or =, a value, such as "
            '"crank = 40 mm". May be repeated.',
            example='"transmission_angle >= 45 deg"',
            metavar="CONDITION",
            required=True,
            limits={"min_length": 1, "max_length": 50},
            sent=["rod <= 300 mm"],
        ),
    ),
)
