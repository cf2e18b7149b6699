"""The counterweight, and a rod balance, of least shaking: numbers, text and figure."""

from ....objectives.kinds import LENGTH, MASS
from ....optimise.sizing.words import Measure
from ..inputs import Input
from ..question import Command, Question

QUESTION = Question(
    __name__,
    2,
    shows="counterweight, and a balance mass on the rod, of least shaking force",
    inputs=(
        Input(
            "measure",
            title="To be least",
            help='What is to be least over the cycle: "peak" or "rms".',
            usual="peak",
            words=Measure,
            loose=True,
        ),
        Input(
            "radius",
            LENGTH,
            "Radius of the counterweight",
            "Place of the counterweight's centre.  [default: as in JOB, or the crank]",
            sign="positive",
        ),
        Input(
            "mass", MASS, "Counterweight, at most", "Greatest mass of the counterweight, such as 2 kg.", sign="positive"
        ),
        Input(
            "rod_radius",
            LENGTH,
            "Space for a mass on the rod",
            "Space around the crank pin for a balance mass on the rod.",
            sign="positive",
        ),
        Input("rod_mass", MASS, "Mass on the rod, at most", "Greatest mass of it.", sign="positive"),
        Input(
            "arm",
            LENGTH,
            "Moment counts, divided by",
            "Count the shaking moment too, as moment / arm; needs a rod balance.",
            sign="positive",
        ),
    ),
    command=Command(
        help="""Find the counterweight, instead of that of JOB, of least shaking force, and a balance mass on the rod.

    Inertia forces at constant crank speed, over all crank angles; gravity and load are left out.""",
        endpoint="balance_by_counterweight",
        job="A job file: speed and masses come from it.",
        sizes=True,
        called="balance",
        figure=("balance", "the hodograph before and after"),
    ),
)
