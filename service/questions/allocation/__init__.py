"""Tolerances of least cost: numbers, text and figure."""
