"""Answers for people: blocks whose numbers keep their kind, and what turns them into text in a system of units."""
