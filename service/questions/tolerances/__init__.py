"""Position error from tolerances: numbers, text and figure."""

from ....objectives.kinds import LENGTH
from ..design_question import DesignQuestion
from ..inputs import Input

LIMIT = Input(
    "limit",
    LENGTH,
    "Maximum position error",
    "Allowable position error of a machine; gives the yield.",
    sign="positive",
    drawn=False,
)
QUESTION = DesignQuestion(
    __name__,
    50,
    "position error: exact worst case, simulated machines, yield, contributions",
    inputs=(LIMIT,),
)
