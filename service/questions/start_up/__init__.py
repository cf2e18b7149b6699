"""Start from rest: numbers, text and figure."""

from ..design_question import DesignQuestion

QUESTION = DesignQuestion(__name__, 90, "start from rest under [drive], steady running")
