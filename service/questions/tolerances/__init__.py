"""Position error from tolerances: numbers, text and figure."""

from ....objectives.kinds import LENGTH
from ..inputs import Input
from ..question import Question

LIMIT = Input(
    "limit",
    LENGTH,
    "Maximum position error",
    "Allowable position error of a machine; gives the yield.",
    sign="positive",
    drawn=False,
)
QUESTION = Question(
    __name__,
    50,
    "position error: exact worst case, simulated machines, yield, contributions",
    inputs=(LIMIT,),
)
