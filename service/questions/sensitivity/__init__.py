"""Sensitivity to the dimensions: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(__name__, 60, "sensitivity of every quantity to every dimension")
