"""Clearance ratio: the volume left at the top over the swept one."""

from .gas_quantity import GasQuantity
from .kinds import RATIO
from .needs import CYLINDER
from .quantity import Group

CLEARANCE_RATIO = GasQuantity(
    name="clearance_ratio",
    title="clearance ratio",
    kind=RATIO,
    of=lambda gas: gas.clearance / gas.swept,
    place=420,
    group=Group.DRIVE,
    sentence="The volume that is left with the piston at its top, over the volume that it sweeps.",
    advice="0.03 to 0.1 are usual for compressors: what is left expands again and takes the place of fresh gas.",
    formula="sum of V_c / sum of A S",
    section="7. Loads",
    picture="cylinder",
    example=0.05,
    plain=True,
    needs=(CYLINDER,),
)
