"""The report of a design for a review: job, front, design, evidence, as HTML and as PDF."""
