"""Words for the options of tolerance allocation and balancing."""

from typing import Literal

Kind = Literal["worst case", "rss"]
"""How errors are combined."""
Measure = Literal["peak", "rms"]
"""Measure of the shaking over the cycle."""
