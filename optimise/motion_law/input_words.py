"""Words and numbers shared by requests for a motion law and their inputs."""

from typing import Literal

LawObjective = Literal["peak torque", "rms torque", "cycle time"]
Timing = Literal["equal", "at most"]

RANGE = 5.0
"""Default ratio of greatest to mean crank speed, and of mean to least."""
