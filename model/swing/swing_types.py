"""Types of a swing's options: driven link, law of motion, and statement of its ends."""

from typing import Literal

Driver = Literal["crank", "slider"]
SwingDriver = Literal[Driver, "cylinder", "turning crank"]
"""Driver of a swing. Only a machine with `lever` has the last two: its cylinder, or its crank that rotates fully."""
Stated = Literal["crank", "slider"]
"""Kind of both ends: crank angles, or slider positions."""
Side = Literal["left", "right"]
"""Side of the crank pin, seen along the line from crank pivot to slider pin."""
LeverLaw = Literal["slow", "constant", "trapezoid", "harmonic", "cycloidal", "polynomial"]
"""Names of the laws that need no points."""
Law = Literal[LeverLaw, "table"]
"""slow: without inertia, at constant speed. constant: with a jump in speed at both ends, whose forces are ignored.
trapezoid: trapezoidal speed, with each ramp a third of the time. harmonic: a cosine. cycloidal: a sine added to a
constant speed. polynomial: 3-4-5. table: a spline through given points."""
