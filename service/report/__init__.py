"""Report on a design for a review: job, front, design, evidence, as HTML and PDF."""

from ...model.optional_packages import import_extra

import_extra("matplotlib", "reports need")
