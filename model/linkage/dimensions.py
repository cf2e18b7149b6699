"""Names of a linkage's dimensions."""

DIMENSIONS = ("crank", "rod", "offset")
"""Names of the three dimensions, in the order of a design's numbers."""
