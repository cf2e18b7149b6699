"""The optimal design nearest to a wish: numbers and text."""

from ..front_or_job_question import FrontOrJobQuestion
from ..inputs import PlainInput

_EXAMPLE = {"time_ratio": "1.2", "transmission_angle": "45 deg"}
QUESTION = FrontOrJobQuestion(
    package=__name__,
    subject="front",
    row="may",
    place=1004,
    path="jobs/{number}/wish",
    posted=True,
    help="""Find the optimal design nearest to desired values of the objectives, by a new search.

    If every target can be met, they are exceeded together; otherwise the conflicting ones are relaxed in equal
    proportion to their ranges over the front. Objectives that are not named are free.""",
    inputs=(
        PlainInput(
            "at",
            type=dict[str, str | float],
            help='OBJECTIVE=VALUE, a desired value rather than a bound, such as "peak_torque=110 N m"; or improve, '
            'keep, "may worsen to 120 N m" or free instead of the value. May be repeated.',
            example='"peak_torque=110 N m"',
            form="OBJECTIVE=VALUE or OBJECTIVE=CLASS",
            metavar="WISH",
            limits={"max_length": 100},
            sent=_EXAMPLE,
            required=True,
        ),
    ),
)
