"""The shipped jobs, as a form can start from them."""
