"""Flywheel for a speed fluctuation: numbers, text and figure."""

from ....objectives.kinds import RATIO
from ..inputs import Input
from ..question import Question

FLUCTUATION = Input(
    "fluctuation",
    RATIO,
    "Maximum speed fluctuation",
    "Speed fluctuation that the flywheel must not exceed.",
    "0.02",  # pumps and machine tools: 1/30 to 1/50 in textbooks
    sign="positive",
    below=1.0,
)
QUESTION = Question(__name__, 100, "flywheel that limits the speed --fluctuation", inputs=(FLUCTUATION,))
