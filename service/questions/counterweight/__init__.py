"""Counterweight and rod balance for minimum shaking: numbers, text and figure."""

from ....objectives.kinds import LENGTH, MASS
from ....optimise.sizing.input_words import Measure
from ..design_question import DesignQuestion, QuestionCommand
from ..inputs import Input

QUESTION = DesignQuestion(
    __name__,
    2,
    shows="counterweight, and balance mass on the rod, for the least shaking force",
    inputs=(
        Input(
            "measure",
            title="To be least",
            help='Measure of shaking to minimise over the cycle: "peak" or "rms".',
            usual="peak",
            words=Measure,
            loose=True,
        ),
        Input(
            "radius",
            LENGTH,
            "Radius of the counterweight",
            "Distance of the counterweight's mass centre from the crank pivot. [default: as in JOB, else the crank "
            "length]",
            sign="positive",
        ),
        Input(
            "mass",
            MASS,
            "Counterweight, at most",
            'Maximum mass of the counterweight, such as "2 kg".',
            sign="positive",
        ),
        Input(
            "rod_radius",
            LENGTH,
            "Space for a mass on the rod",
            "Space around the crank pin for a balance mass on the rod.",
            sign="positive",
        ),
        Input(
            "rod_mass",
            MASS,
            "Mass on the rod, at most",
            "Maximum mass of the balance mass on the rod.",
            sign="positive",
        ),
        Input(
            "arm",
            LENGTH,
            "Include the moment, divided by",
            "Also minimise the shaking moment, as moment / arm; needs a balance mass on the rod.",
            sign="positive",
        ),
    ),
    command=QuestionCommand(
        help="""Find the counterweight, and a balance mass on the rod, that minimise the shaking force.

    The counterweight replaces the one in JOB. Considers inertia forces at constant crank speed over all crank
    angles, without gravity and loads.""",
        endpoint="balance_by_counterweight",
        job="Job file that supplies speed and masses.",
        sizes=True,
        called="balance",
        figure=("balance", "the hodograph before and after"),
    ),
    title="Counterweight",
)
