"""The optimal design that comes nearest to what is wished: numbers and text."""

from ..plain_input import Plain
from ..wider import WiderQuestion

_EXAMPLE = {"time_ratio": "1.2", "transmission_angle": "45 deg"}
QUESTION = WiderQuestion(
    package=__name__,
    subject="front",
    row="may",
    place=1004,
    path="jobs/{number}/wish",
    posted=True,
    help="""Find the optimal design that comes nearest to wished values of the objectives, solved anew.

    Where all of it can be had, the design is better in all of it; otherwise what binds gives way by the same share of
    its range over the front. Objectives that are not named are free.""",
    inputs=(
        Plain(
            "at",
            type=dict[str, str | float],
            help='An objective, =, and a value, which is no bound, such as "peak_torque=110 N m"; or one of improve, '
            'keep, "may worsen to 120 N m" and free. May be repeated.',
            example='"peak_torque=110 N m"',
            form="an objective, =, and a value or a class",
            metavar="WISH",
            limits={"max_length": 100},
            sent=_EXAMPLE,
            required=True,
        ),
    ),
)
