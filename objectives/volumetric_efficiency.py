"""Volumetric efficiency of a compressor with ideal valves: volume taken in over volume swept."""

from .gas_quantity import GasQuantity
from .kinds import RATIO
from .needs import COMPRESSOR
from .quantity import Domain, Group

VOLUMETRIC_EFFICIENCY = GasQuantity(
    name="volumetric_efficiency",
    title="volumetric efficiency",
    kind=RATIO,
    of=lambda gas: gas.delivers,
    place=450,
    group=Group.DRIVE,
    sentence="The volume of gas that a compressor takes in during a stroke, over the volume that its piston sweeps.",
    advice="What is left in the clearance expands first. Zero or less: nothing is delivered. Valves are ideal here.",
    formula="1 - (V_c / (A S)) ((p_h / p_l)^(1/n_e) - 1); 1 for a liquid",
    section="7. Loads",
    picture="cylinder",
    example=0.8,
    better="high",
    domain=Domain(
        lower=0.0,
        upper=1.0,
        open=False,
        rule="the volumetric efficiency lies between 0 and 1",
        remedy="0.6 to 0.9 are usual",
    ),
    floor=0.05,  # towards zero the machine runs for nothing
    needs=(COMPRESSOR,),
)
