"""Types of a swing's options: driven link, law of motion, and statement of its ends."""

from __future__ import annotations

from typing import Literal

Driver = Literal["crank", "slider"]
Stated = Literal["crank", "slider"]
"""Of what both ends are: crank angles, or slider positions."""
Side = Literal["left", "right"]
"""Of the line from crank pivot to slider pin, looking along it, where the crank pin is."""
Law = Literal["slow", "constant", "trapezoid", "harmonic", "cycloidal", "polynomial", "table"]
"""slow: without inertia, at constant speed. constant: with a jump of the speed at both ends, of which the forces are
left out. trapezoid: of the speed, ramps of a third of the time each. harmonic: a cosine. cycloidal: a sine added to a
constant speed. polynomial: 3-4-5. table: a spline through given points."""
