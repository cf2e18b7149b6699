"""Mean effective pressure: indicated work per displacement volume."""

from .gas_quantity import GasQuantity
from .kinds import PRESSURE
from .needs import CYLINDER
from .quantity import Group

MEAN_EFFECTIVE_PRESSURE = GasQuantity(
    name="mean_effective_pressure",
    title="mean effective pressure",
    kind=PRESSURE,
    of=lambda gas: gas.work / gas.swept,
    place=440,
    group=Group.DRIVE,
    sentence="The constant pressure that would do the indicated work in one stroke; negative where the gas takes work.",
    advice="It compares cylinders of different size. With fixed pressures it follows from the clearance ratio alone.",
    formula="indicated work / sum of A S",
    section="7. Loads",
    picture="cylinder",
    example="-2.4 bar",
    better="high",
    signed=True,
    plain=True,
    needs=(CYLINDER,),
)
