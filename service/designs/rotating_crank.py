"""Requirement of a rotating crank, for analyses over a full revolution."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...model.errors import InputError

if TYPE_CHECKING:
    from ...model.swing.swing import Swing


def require_rotating_crank(swing: Swing | None, subject: str) -> None:
    """Raise an error for a swinging crank. subject: analysis over a full revolution, the subject of the message."""
    if swing is not None and swing.of_full_turn:
        from ...model.linkage.require_single_linkage import SEE_DESIGNS

        raise InputError(
            f"{subject} needs a crank with rod and slider; the crank of this job turns a cylinder or an arm; "
            f"{SEE_DESIGNS}"
        )
    if swing is not None:
        crank, command = ("lever", "lever") if swing.driver == "cylinder" else ("crank", "swing")
        raise InputError(
            f"{subject} needs a rotating crank; the {crank} of this job swings; use {command} to analyse its designs"
        )
