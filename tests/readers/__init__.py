"""Trials of names and sentences with people who know nothing of the code.

`draw` draws what they judge; names.csv and sentences.csv have what they answered, with the better names and sentences.
"""
