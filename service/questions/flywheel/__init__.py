"""Flywheel for a speed fluctuation: numbers, text and figure."""

from ....objectives.kinds import RATIO
from ..design_question import DesignQuestion
from ..inputs import Input

FLUCTUATION = Input(
    "fluctuation",
    RATIO,
    "Maximum speed fluctuation",
    "Speed fluctuation that the flywheel must not exceed.",
    "0.02",  # pumps and machine tools: 1/30 to 1/50 in textbooks
    sign="positive",
    upper_limit=1.0,
)
QUESTION = DesignQuestion(
    __name__,
    100,
    "flywheel that limits the speed --fluctuation",
    inputs=(FLUCTUATION,),
    title="Flywheel size",
)
