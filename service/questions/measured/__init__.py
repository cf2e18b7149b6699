"""Measured curves compared with the computed ones of one design: numbers, text and figure."""

from ..design_question import DesignQuestion

MEASURED = DesignQuestion(__name__, 88, "comparison of measured and computed curves", needs_job=False)
"""Shown if there are samples, so not one of the topics that are requested by name."""
