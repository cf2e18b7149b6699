"""Sections of crank and rod of least mass: numbers and text."""

from ..question import Command, Question

QUESTION = Question(
    __name__,
    3,
    shows="crank and rod as bars of least mass within the limits of stress",
    command=Command(
        help="""Size crank and rod of one design as rectangular bars of least mass.

    They keep the stress, fatigue, buckling and bearing limits of the job's [sections] under the forces that the machine
    puts on them, their own mass included. What JOB says of the links' masses is not used. Dimensions that JOB fixes
    need not be repeated.""",
        endpoint="size_sections",
        job="A job file with a table [sections].",
        sizes=True,
    ),
)
