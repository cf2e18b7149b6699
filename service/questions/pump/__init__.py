"""Delivery of a pump or compressor: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(__name__, 44, "delivered flow of pumps and compressors, its ripple, pressure torque")
