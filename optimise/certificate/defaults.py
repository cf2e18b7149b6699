"""Default accuracy and time limit for a certificate."""

EPSILON, SECONDS = 0.01, 60.0
"""Fraction of each objective's range over the front; time in s."""
