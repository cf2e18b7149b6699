"""The counterweight of least shaking: numbers, text and figure."""
