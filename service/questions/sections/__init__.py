"""Minimum-mass sections of the crank and the rod: numbers and text."""

from ..design_question import DesignQuestion, Premise, QuestionCommand

QUESTION = DesignQuestion(
    __name__,
    3,
    shows="crank and rod as bars with the least mass within the stress limits",
    command=QuestionCommand(
        help="""Size crank and rod of one design as rectangular bars with least mass.

    The bars satisfy the stress, fatigue, buckling and bearing limits in the job's [sections] under all forces of the
    machine, including those from their own mass. Link masses in JOB are ignored. Dimensions that JOB fixes need not be
    repeated.""",
        endpoint="size_sections",
        job="Job file with a table [sections].",
        sizes=True,
    ),
    title="Lightest bars",
    premise=Premise(
        "limits for bars, and no friction",
        lambda problem, machine: (
            problem.sections is not None and machine.strength is not None and not machine.friction.acts
        ),
    ),
)
