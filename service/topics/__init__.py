"""Analyses: each folder has the numbers, the text and the figure of one; `analyse` finds those with a `TOPIC`."""
