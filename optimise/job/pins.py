"""Pins that no bar of a job has room for: an eye without a net section carries nothing."""

from __future__ import annotations

from ...model.errors import InfeasibleError
from ...model.machine.mechanism import Mechanism
from ...model.machine.varying import number_at
from ...objectives.bars import LINKS, NEAR
from ...objectives.link_strength import LinkStress
from ..problem.problem import Problem


def require_eyes_wider_than_pins(problem: Problem) -> None:
    """Raise `InfeasibleError` if stresses are requested and no choice has eyes wider than their pins."""
    names = {*(item.quantity for item in problem.constraints), *(item.quantity for item in problem.objectives)}
    stresses = [item for item in map(problem.quantity, names) if isinstance(item, LinkStress)]
    if not stresses:
        return
    refused = []
    for part in problem.parts():
        links = {link for item in stresses for link in item.bars(part.mechanism)}
        reasons = [reason for link in sorted(links) for reason in _too_thick(part.mechanism, link)]
        if not reasons:
            return
        refused.append(reasons[0])
    raise InfeasibleError(refused[0])


def _too_thick(mechanism: Mechanism, link: str) -> list[str]:
    """Return why the eyes of a link have no net section, whatever the numbers that vary."""
    width = max(_number_range(mechanism, f"{link}.width"))
    return [
        f"mechanism.{link}.width: a bar must be wider than the pins in its eyes; got "
        f"{1e3 * width:.6g} mm at most and sections.pins.{pin} of {1e3 * least:.6g} mm at least; widen the bar or take "
        "a thinner pin"
        for pin in (NEAR, LINKS[link].far)
        if (least := min(_number_range(mechanism, f"strength.{pin}"))) >= width
    ]


def _number_range(mechanism: Mechanism, path: str) -> tuple[float, ...]:
    """Return the ends between which a number of a machine may vary, or its only value."""
    for item in mechanism.varying:
        for set_path, factor in item.sets:
            if set_path == path:
                return factor * item.lower, factor * item.upper
    value = number_at(mechanism.nominal, path)
    assert value is not None
    return (value,)
