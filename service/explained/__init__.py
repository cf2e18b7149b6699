"""Meaning of every quantity, for engineers: a sentence, a formula, and the place of its derivation."""
