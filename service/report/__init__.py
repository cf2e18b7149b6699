"""Report on a design for a review: job, front, design, evidence, as HTML and PDF."""

from ...model.extras import required

required("matplotlib", "reports need")
