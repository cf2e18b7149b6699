"""Best designs with round numbers near one on a front: numbers and text."""

from ..front_or_job_question import FrontOrJobQuestion
from ..inputs import PlainInput

QUESTION = FrontOrJobQuestion(
    package=__name__,
    subject="front",
    row="must",
    place=1003,
    path="jobs/{number}/designs/{design}/rounded",
    posted=True,
    key="rounded",
    help="""Find the best round-number designs near a given one, with the loss of each.

    Evaluates every combination of multiples of the steps around the design exactly. Lists the non-dominated designs
    that meet every requirement, or miss it by no more than --allow, smallest loss first. The loss is the greatest
    over the objectives, each relative to its range over the front. If the best design loses much, the list
    continues with designs that miss slightly but lose much less. If no design meets every requirement,
    lists the nearest ones, with each missed requirement and the amount.""",
    inputs=(
        PlainInput(
            "to",
            type=list[str],
            help='Step of crank, rod and offset, such as "0.5 mm" or "1/32 in", or of one variable: "rod=1 mm". May '
            "be repeated.",
            example='"0.5 mm" or "rod=1 mm"',
            metavar="STEP",
            required=True,
            limits={"min_length": 1, "max_length": 50},
            sent=["0.5 mm", "rod=1 mm"],
        ),
        PlainInput(
            "allow",
            type=list[str],
            help='REQUIREMENT=AMOUNT by which designs may miss the requirement, such as "stroke=0.1 mm". May be '
            "repeated.",
            example='"stroke=0.1 mm"',
            form="REQUIREMENT=AMOUNT",
            metavar="MISS",
            limits={"max_length": 50},
            sent=["stroke=0.1 mm"],
        ),
        PlainInput(
            "count",
            type=int,
            help="Maximum number of designs to list.",
            usual="5",
            metavar="N",
            least=1,
            limits={"ge": 1, "le": 100},
            sent=5,
        ),
    ),
)
