"""Questions about one design: each folder has its `QUESTION` and the numbers, text and figure of the answer."""
