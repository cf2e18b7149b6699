"""Web page: the files that a browser runs, unchanged, and the code that serves them."""
