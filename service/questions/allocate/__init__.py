"""Tolerances of least cost within a limit of the position error: numbers, text and figure."""

from ....objectives.kinds import LENGTH
from ....optimise.sizing.words import Kind
from ..inputs import Input
from ..question import Command, Question

QUESTION = Question(
    __name__,
    1,
    shows="tolerances of least cost within a limit of the position error",
    inputs=(
        Input(
            "limit",
            LENGTH,
            "Position error allowed",
            "Position error that is allowed.",
            sign="positive",
            example="0.1 mm",
            required=True,
        ),
        Input(
            "kind",
            title="Errors add up as",
            help='How errors add up: "worst case" or "rss" (root-sum-square).',
            usual="worst case",
            words=Kind,
            loose=True,
        ),
    ),
    command=Command(
        help="""Find the tolerances of least manufacturing cost that keep the position error within a limit.

    At every crank angle of the part of the stroke that [tolerances] counts. What has no cost in [costs] keeps its
    tolerance, and takes its part of the limit; so do the clearances.""",
        endpoint="allocate_tolerances",
        job="A job file with [costs].",
        sizes=True,
        figure=("allocation", "error and costs"),
    ),
)
