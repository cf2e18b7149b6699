"""Position error from tolerances: numbers, text and figure."""

from ....objectives.kinds import LENGTH
from ..inputs import Input
from ..question import Question

LIMIT = Input(
    "limit",
    LENGTH,
    "Position error, at most",
    "Position error that a machine may have: gives the yield.",
    sign="positive",
    drawn=False,
)
QUESTION = Question(
    __name__,
    50,
    "position error: exact worst case, simulated machines, yield, what it comes from",
    inputs=(LIMIT,),
)
