"""Human-readable answers: blocks whose numbers keep their kind, and their rendering as text in a unit system."""
