"""The best designs of round numbers near one of a front: numbers and text."""

from ..plain_input import Plain
from ..wider import WiderQuestion

QUESTION = WiderQuestion(
    package=__name__,
    subject="front",
    row="must",
    place=1003,
    path="jobs/{number}/designs/{design}/rounded",
    posted=True,
    key="rounded",
    help="""Find the best designs of round numbers near one of a run, and what each costs.

    All combinations of multiples of the steps around the design are judged exactly. Listed are those that meet every
    requirement, or miss it by no more than --allow says, and that no other one beats in every objective, least loss
    first: the greatest over the objectives, each by its range over the front. If the best loses much, those that miss
    little and lose clearly less follow. Where none meets all, the nearest are listed, each with what it misses and by
    how much.""",
    inputs=(
        Plain(
            "to",
            type=list[str],
            help='Step of crank, rod and offset, such as "0.5 mm" or "1/32 in", or of one number that varies: '
            '"rod=1 mm". May be repeated.',
            example='"0.5 mm" or "rod=1 mm"',
            metavar="STEP",
            required=True,
            limits={"min_length": 1, "max_length": 50},
            sent=["0.5 mm", "rod=1 mm"],
        ),
        Plain(
            "allow",
            type=list[str],
            help='A requirement, =, and by how much designs may miss it, such as "stroke=0.1 mm". May be repeated.',
            example='"stroke=0.1 mm"',
            form="a requirement, =, and by how much it may be missed",
            metavar="MISS",
            limits={"max_length": 50},
            sent=["stroke=0.1 mm"],
        ),
        Plain(
            "count",
            type=int,
            help="Designs to list at most.",
            usual="5",
            metavar="N",
            least=1,
            limits={"ge": 1, "le": 100},
            sent=5,
        ),
    ),
)
