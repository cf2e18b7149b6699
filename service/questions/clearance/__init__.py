"""Impacts in a loose joint: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(__name__, 110, "impacts in the joint with clearance, from [clearance]")
