"""Indicator diagram of the cylinders: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(__name__, 45, "cylinder pressure against volume and crank angle, valve events")
