"""Measured curves compared with the computed ones of one design: numbers, text and figure."""

from ..design_question import DesignQuestion

MEASURED = DesignQuestion(__name__, 88, "comparison of measured and computed curves", needs_job=False)
"""Shown where there are samples, and so none of the topics that are asked for by name."""
