"""Proven bound on the distance of a front from the true one: numbers and text."""

from ....optimise.certificate.defaults import EPSILON, SECONDS
from ..front_or_job_question import FrontOrJobQuestion
from ..inputs import PlainInput

QUESTION = FrontOrJobQuestion(
    package=__name__,
    subject="front",
    place=1000,
    path="jobs/{number}/certificate",
    key="certificate",
    help="""Prove how far the front of a run can be from the true front.

    Searches the whole design box and adds designs where the front has gaps. No feasible design then beats all of them
    by more than epsilon.""",
    inputs=(
        PlainInput(
            "epsilon",
            title="Largest gap, as a fraction of each objective's range",
            help="Distance to prove, as a fraction of each objective's range over the front.",
            usual=str(EPSILON),
            limits={"gt": 0.0, "lt": 1.0},
        ),
        PlainInput(
            "seconds",
            title="Time limit in seconds",
            help="Time limit; then reports what is proven so far.",
            usual=str(SECONDS),
            served="10.0",
            limits={"gt": 0.0, "le": 20.0},
        ),
    ),
    title="Proof of the front",
)
