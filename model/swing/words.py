"""Words of a swing: what is driven, and by which law of motion."""

from __future__ import annotations

from typing import Literal

Driver = Literal["crank", "slider"]
Law = Literal["slow", "constant", "trapezoid", "harmonic", "cycloidal", "polynomial"]
"""slow: without inertia, at constant speed. constant: with a jump of the speed at both ends, of which the forces are
left out. trapezoid: of the speed, ramps of a third of the time each. harmonic: a cosine. cycloidal: a sine added to a
constant speed. polynomial: 3-4-5."""
