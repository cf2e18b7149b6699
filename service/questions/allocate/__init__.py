"""Least-cost tolerances within a position error limit: numbers, text and figure."""

from ....objectives.kinds import LENGTH
from ....optimise.sizing.input_words import Kind
from ..design_question import DesignQuestion, Premise, QuestionCommand
from ..inputs import Input

QUESTION = DesignQuestion(
    __name__,
    1,
    shows="least-cost tolerances within a limit on the position error",
    inputs=(
        Input(
            "limit",
            LENGTH,
            "Position error allowed",
            "Allowable position error.",
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
    command=QuestionCommand(
        help="""Find the cheapest tolerances that keep the position error within a limit.

    The limit applies at every crank angle in the part of the stroke selected in [tolerances]. Dimensions without a
    cost in [costs] keep their tolerances, which use up part of the limit, as clearances do.""",
        endpoint="allocate_tolerances",
        job="Job file with a table [costs].",
        sizes=True,
        figure=("allocation", "error and costs"),
    ),
    title="Cheapest tolerances",
    premise=Premise("costs of tolerances", lambda problem, _: problem.costs is not None),
)
