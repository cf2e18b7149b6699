"""The explanation of a quantity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Picture = Literal[
    "crank",
    "rod",
    "offset",
    "stroke",
    "time ratio",
    "transmission angle",
    "torque",
    "power",
    "inertia",
    "position error",
    "wanted motion",
    "footprint",
    "pivot force",
    "crank pin force",
    "slider pin force",
    "guide force",
    "self-locking",
    "speed",
    "acceleration",
    "shaking force",
    "shaking moment",
]
"""What a picture of the linkage points out."""

MECHANICS = "derived there from plane rigid-body mechanics"


@dataclass(frozen=True, kw_only=True)
class Text:
    """What a quantity means.

    name: of the quantity. sentence: for an engineer who meets it first. advice: what is usual, or what it trades
    against; "" if there is nothing to say. formula: in plain text, its symbols those of docs/theory.md. section: of
    docs/theory.md. source: of the equations.
    """

    name: str
    sentence: str
    advice: str = ""
    formula: str
    section: str
    source: str = MECHANICS
    picture: Picture
