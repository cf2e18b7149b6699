"""The web page: the files that a browser runs, as they are, and what serves them."""
