"""Animations of a linkage: a self-contained page for a browser, and a GIF."""
