"""Indicated work: what the gas does on the pistons over a turn, positive where it drives."""

from .gas_quantity import GasQuantity
from .kinds import ENERGY
from .needs import CYLINDER
from .quantity import Group

INDICATED_WORK = GasQuantity(
    name="indicated_work",
    title="indicated work",
    kind=ENERGY,
    of=lambda gas: gas.work,
    place=430,
    group=Group.DRIVE,
    sentence=(
        "The work that the gas does on the pistons over a turn: positive for an engine, negative for a compressor or "
        "pump, which takes it."
    ),
    advice="Maximise it in either case. Friction and other loads are not in it; with them it is the delivered work.",
    formula="sum of the areas of p over V: closed integral of p dV",
    section="7. Loads",
    picture="cylinder",
    example="-60 J",
    better="high",
    signed=True,
    needs=(CYLINDER,),
)
