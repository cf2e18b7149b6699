"""Words that tolerances and balances of least cost are asked for with."""

from typing import Literal

Kind = Literal["worst case", "rss"]
"""How errors add up."""
Measure = Literal["peak", "rms"]
"""What shaking is judged by over the cycle."""
