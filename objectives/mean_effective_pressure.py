"""Mean effective pressure: work of a cycle per displacement volume."""

from .gas_quantity import GasQuantity
from .kinds import PRESSURE
from .needs import CYLINDER
from .quantity import Group

MEAN_EFFECTIVE_PRESSURE = GasQuantity(
    name="mean_effective_pressure",
    title="mean effective pressure",
    kind=PRESSURE,
    of=lambda gas: gas.cycle_work / gas.swept,
    place=440,
    group=Group.DRIVE,
    sentence="The constant pressure that would do the work of a cycle in one stroke; negative where gas takes work.",
    advice="It compares cylinders of different size. With fixed pressures it follows from the clearance ratio alone.",
    formula="work of the cycles, of two turns for four strokes / sum of A S",
    section="7. Loads",
    picture="cylinder",
    example="-2.4 bar",
    better="high",
    signed=True,
    plain=True,
    needs=(CYLINDER,),
)
