"""Displacement volume: swept by the pistons in a stroke."""

from .gas_quantity import GasQuantity
from .kinds import VOLUME
from .needs import CYLINDER
from .quantity import Domain, Group

DISPLACEMENT_VOLUME = GasQuantity(
    name="displacement_volume",
    title="displacement volume",
    kind=VOLUME,
    of=lambda gas: gas.swept,
    place=410,
    group=Group.DRIVE,
    sentence="The volume that the piston sweeps in a stroke; several cylinders add up.",
    advice="It sets how much a compressor or pump delivers. As a constraint it fixes the stroke for a given bore.",
    formula="sum of A S: piston area A, stroke S",
    section="7. Loads",
    picture="cylinder",
    better="high",
    domain=Domain(lower=0.0, rule="the displacement volume is positive", remedy="5 cm^3 to 5000 cm^3 are usual"),
    needs=(CYLINDER,),
)
