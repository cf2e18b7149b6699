"""A linkage that moves: a page of its own for a browser, and an animated picture."""
