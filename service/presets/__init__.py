"""The shipped jobs as starting points for a form."""
