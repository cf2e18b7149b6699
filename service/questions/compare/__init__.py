"""Fronts of several runs compared with each other: numbers and text."""

from ..front_or_job_question import FrontOrJobQuestion
from ..inputs import PlainInput

QUESTION = FrontOrJobQuestion(
    package=__name__,
    subject="runs",
    place=1005,
    path="comparison",
    posted=False,
    key="comparison",
    help="""Compare the fronts of several runs: hypervolume, coverage, epsilon, dominance, effort.

    The runs must have the same objectives; their constraints and machines may differ. Also reports
    where each run is better, and how the jobs differ.""",
    inputs=(
        PlainInput(
            "tolerance",
            help="Fraction of an objective's range within which values count as equal.",
            usual="1e-06",
            least=0.0,
            limits={"ge": 0.0, "allow_inf_nan": False},
        ),
    ),
)
