"""Proof of how far a front can be from the true one: numbers and text."""

from ..plain_input import Plain
from ..wider import WiderQuestion

QUESTION = WiderQuestion(
    package=__name__,
    subject="front",
    place=1000,
    path="jobs/{number}/certificate",
    key="certificate",
    help="""Prove how far the front of a run can be from the true front.

    Searches the whole design box and adds designs where the front has gaps. No feasible design then beats all of them
    by more than epsilon.""",
    inputs=(
        Plain(
            "epsilon",
            help="Distance to prove, as a fraction of each objective's range over the front.",
            usual="0.01",
            limits={"gt": 0.0, "lt": 1.0},
        ),
        Plain("seconds", help="Time limit; reports what is proven so far.", usual="60.0", limits={"gt": 0.0}),
    ),
)
