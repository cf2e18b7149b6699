"""Words and numbers that requests for a motion law and their inputs share."""

from typing import Literal

LawObjective = Literal["peak torque", "rms torque", "cycle time"]
Timing = Literal["equal", "at most"]

RANGE = 5.0
"""Greatest crank speed over the mean one, and mean over least, unless limits say otherwise."""
