"""Curves of a swing of one design, both ways, and the kinds of what they show."""

from __future__ import annotations

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.forces import SwingCurves, swing_curves
from ...model.swing.swing import Swing, placed, require_swing
from ...objectives.kinds import ANGLE, FORCE, LENGTH, TORQUE, Kind

POINTS = 181
"""Of one way, in curves and figures."""


def drive_kind(swing: Swing) -> Kind:
    """Return the kind of what the driver brings: a torque or a force."""
    return TORQUE if swing.driver == "crank" else FORCE


def error_kind(swing: Swing) -> Kind:
    """Return the kind of the driven side's error: of the slider's place or of the crank's angle."""
    return LENGTH if swing.driver == "crank" else ANGLE


def driven(swing: Swing) -> str:
    """Return the side that is not the driver's."""
    return "slider" if swing.driver == "crank" else "crank"


def both_ways(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> tuple[SwingCurves, SwingCurves]:
    """Return the curves of the way forth and of the way back, at even shares of the time."""
    own, share = require_swing(mechanism, linkage, swing), np.linspace(0.0, 1.0, POINTS)
    swing = placed(mechanism, own, swing)
    return (
        swing_curves(mechanism, own, swing, share),
        swing_curves(mechanism, own, swing, share, back=True),
    )
