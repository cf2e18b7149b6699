"""Quantities over one or two parameters: text and figure."""
