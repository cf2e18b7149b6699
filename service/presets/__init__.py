"""Included jobs as starting points for a form."""
