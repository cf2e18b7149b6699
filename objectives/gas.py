"""Gas cycle in a machine's cylinders: volumes, work, mean pressure, delivery of a compressor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from ..model.cycle.gas_work import GasCycle, gas_cycle_number
from ..model.machine.mechanism import Mechanism
from .energy import EFFICIENCY
from .kinds import ENERGY, PRESSURE, RATIO, VOLUME
from .machine_needs import COMPRESSOR, CYLINDER
from .quantity import Array, Domain, Group, Quantity, Values, undefined_values


@dataclass(frozen=True, kw_only=True)
class GasQuantity(Quantity):
    """A closed-form quantity of the `GasCycle`. closed_form: its function."""

    closed_form: Callable[[GasCycle], Any] = field(repr=False)

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); NaN if there is no suitable cylinder; see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        return Values(*gas_cycle_number(mechanism, dimensions, self.closed_form, gradients=gradients))


_gas = partial(GasQuantity, group=Group.DRIVE, section="7. Loads", picture="cylinder", needs=(CYLINDER,))
DISPLACEMENT_VOLUME = _gas(
    name="displacement_volume",
    kind=VOLUME,
    closed_form=lambda gas: gas.swept,
    place=410,
    sentence="The volume that the piston sweeps in a stroke, summed over the cylinders.",
    advice=(
        "It determines how much a compressor or pump delivers. As a constraint it fixes the stroke for a given bore."
    ),
    formula="sum of A S: piston area A, stroke S",
    better="high",
    domain=Domain(lower=0.0, rule="the displacement volume must be positive", remedy="5 cm^3 to 5000 cm^3 are usual"),
)
CLEARANCE_RATIO = _gas(
    name="clearance_ratio",
    kind=RATIO,
    closed_form=lambda gas: gas.clearance / gas.swept,
    place=420,
    sentence="The volume left above the piston at its top, divided by the swept volume.",
    advice="0.03 to 0.1 are usual for compressors: the remaining gas expands again and displaces fresh gas.",
    formula="sum of V_c / sum of A S",
    example=0.05,
    plain=True,
)
INDICATED_WORK = _gas(
    name="indicated_work",
    title="indicated work per cycle",
    short="indicated work",
    kind=ENERGY,
    closed_form=lambda gas: gas.work,
    place=430,
    sentence=(
        "The work that the gas does on the pistons over a cycle of one turn or two: positive for an engine, negative "
        "for a compressor or pump."
    ),
    advice="Maximise it in either case. It excludes friction and other loads; the delivered work includes them.",
    formula="sum of the areas of the p-V diagrams: integral of p dV over a cycle, one turn or two",
    example="-60 J",
    better="high",
    signed=True,
    instead_of_quotient=EFFICIENCY.name,
)
MEAN_EFFECTIVE_PRESSURE = _gas(
    name="mean_effective_pressure",
    kind=PRESSURE,
    closed_form=lambda gas: gas.cycle_work / gas.swept,
    place=441,
    sentence="The constant pressure that would do the work of a cycle in one stroke; negative if the gas absorbs work.",
    advice=(
        "It makes cylinders of different sizes comparable. With fixed pressures it follows from the clearance "
        "ratio alone."
    ),
    formula="work per cycle (two turns for four strokes) / sum of A S",
    example="-2.4 bar",
    better="high",
    signed=True,
    plain=True,
)
VOLUMETRIC_EFFICIENCY = _gas(
    name="volumetric_efficiency",
    kind=RATIO,
    closed_form=lambda gas: gas.delivers,
    place=450,
    sentence="The volume of gas that a compressor takes in during a stroke, divided by the swept volume.",
    advice=(
        "Gas left in the clearance expands first. At zero or less, nothing is delivered. Valves are assumed to "
        "be ideal."
    ),
    formula="1 - (V_c / (A S)) ((p_h / p_l)^(1/n_e) - 1); 1 for a liquid",
    example=0.8,
    better="high",
    domain=Domain.share("the volumetric efficiency", "0.6 to 0.9"),
    floor=0.05,  # near zero, nothing is delivered
    needs=(COMPRESSOR,),
)
