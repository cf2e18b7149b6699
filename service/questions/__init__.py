"""Questions to one design: each folder has its `QUESTION` and the numbers, the text and the figure of the answer."""
