"""Minimum drive effort on each stroke of a limited swing: whether the linkage overruns, or is self-locking."""

from functools import partial

from .kinds import FORCE, TORQUE
from .quantity import Group
from .swing_quantity import SwingLeast

_least = partial(SwingLeast, signed=True, better="high", group=Group.DRIVE, picture="torque")
_ADVICE = "Below zero, the loads push and the drive holds back. A linkage above zero on both strokes is self-locking."

LEAST_FORCE_FORWARD = _least(
    name="least_force_forth",
    title="least actuator force, forward stroke",
    kind=FORCE,
    back=False,
    driver="slider",
    instead="least_torque_forth",
    place=322,
    sentence="The least force along its motion that the actuator needs on a slow forward stroke.",
    advice=_ADVICE,
    formula="min over the forward stroke of P sgn(x' w)",
    example="0 N",
)
LEAST_FORCE_BACK = _least(
    name="least_force_back",
    title="least actuator force, return stroke",
    kind=FORCE,
    back=True,
    driver="slider",
    instead="least_torque_back",
    place=323,
    sentence="The least force along its motion that the actuator needs on a slow return stroke.",
    advice=_ADVICE,
    formula="min over the return stroke of P sgn(x' w)",
    example="0 N",
)
LEAST_TORQUE_FORWARD = _least(
    name="least_torque_forth",
    title="least torque, forward stroke",
    kind=TORQUE,
    back=False,
    driver="crank",
    instead="least_force_forth",
    place=324,
    sentence="The least torque along its motion that the crank needs on a slow forward stroke.",
    advice=_ADVICE,
    formula="min over the forward stroke of T sgn(w)",
    example="0 N m",
)
LEAST_TORQUE_BACK = _least(
    name="least_torque_back",
    title="least torque, return stroke",
    kind=TORQUE,
    back=True,
    driver="crank",
    instead="least_force_back",
    place=325,
    sentence="The least torque along its motion that the crank needs on a slow return stroke.",
    advice=_ADVICE,
    formula="min over the return stroke of T sgn(w)",
    example="0 N m",
)
