"""Kinematic polygons: numbers, text and figure."""

from ....objectives.kinds import ANGLE
from ..design_question import DesignQuestion
from ..inputs import Input

# At 30 deg no link with common proportions is normal to the slider line.
AT = Input("crank_angle", ANGLE, "Crank angle", "Crank angle of the polygons.", "30 deg", "at")
QUESTION = DesignQuestion(
    __name__,
    80,
    "position, velocity and acceleration diagrams at --at",
    needs_job=False,
    inputs=(AT,),
    title="Vector diagrams",
)
