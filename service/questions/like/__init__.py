"""Design nearest to one on a front that also meets further conditions: numbers and text."""

from ..front_or_job_question import FrontOrJobQuestion
from ..inputs import PlainInput

QUESTION = FrontOrJobQuestion(
    package=__name__,
    subject="front",
    row="must",
    place=1002,
    path="jobs/{number}/designs/{design}/like",
    posted=True,
    key="like",
    help="""Find the design closest to a given one that also meets further conditions.

    It is the nearest of the designs that are Pareto-optimal for the run's job with the conditions added. Distance is
    measured in the objectives, each relative to its range over the run's front. Nothing is saved.""",
    inputs=(
        PlainInput(
            "where",
            title="Conditions, separated by semicolons",
            type=list[str],
            help="Condition to meet as well: a quantity, a dimension or a formula, then >=, <= or =, then a value, "
            'such as "crank = 40 mm". May be repeated.',
            example='"transmission_angle >= 45 deg"',
            metavar="CONDITION",
            required=True,
            limits={"min_length": 1, "max_length": 50},
            sent=["rod <= 300 mm"],
        ),
    ),
    title="Nearest with conditions",
)
