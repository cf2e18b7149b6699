"""Default accuracy and time limit of a certificate."""

EPSILON, SECONDS = 0.01, 60.0
"""Fraction of each objective's range over the front, and s."""
