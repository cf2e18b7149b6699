"""Gas cycle in a machine's cylinders, and flow that pumps and compressors deliver, with its ripple over the cycle."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from ..model.cycle.gas_work import GasCycle, cylinder_loads, evaluate_on_gas_cycle
from ..model.kernel.arithmetic import magnitude
from ..model.kinematics.geometry import stroke
from ..model.machine.cylinders_and_turns import cylinder_count
from ..model.machine.loads.compressor import Compressor
from ..model.machine.loads.crank_torque import CrankTorque
from ..model.machine.loads.cylinder import Cylinder
from ..model.machine.loads.load import Load
from ..model.machine.loads.stroke_force import StrokeForce
from ..model.machine.mechanism import Mechanism
from ..model.machine.memoise import memoise_by_machine
from ..model.machine.raw_machine_vector import LOAD_SLOTS, Raw
from ..model.machine.raw_numbers_of_designs import evaluate_formula_of_raw_numbers
from ..model.machine.varying_numbers import Varying
from ..model.signals.peaks import find_peaks
from ..model.signals.shaft_statistics import mean_speed_ratio
from ..model.signals.signals import Signal
from .energy import EFFICIENCY
from .kinds import ENERGY, PRESSURE, RATIO, VOLUME, VOLUME_FLOW
from .machine_needs import COMPRESSOR, CYLINDER, EVEN_SPEED, SPEED, Need
from .quantity import Array, Domain, Group, Pieces, Quantity, Values, undefined_values


@dataclass(frozen=True, kw_only=True)
class GasQuantity(Quantity):
    """A closed-form quantity of the `GasCycle`. closed_form: its function."""

    closed_form: Callable[[GasCycle], Any] = field(repr=False)

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); NaN if there is no suitable cylinder; see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        return Values(*evaluate_on_gas_cycle(mechanism, dimensions, self.closed_form, gradients=gradients))


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
    domain=Domain.of_fraction("the volumetric efficiency", "0.6 to 0.9"),
    floor=0.05,  # near zero, nothing is delivered
    needs=(COMPRESSOR,),
)


_MOST_PIECES = 3
"""Local peaks, and local troughs, of the flow from which pieces are built."""
_LABEL_STEP = 10.0  # labels of peaks are crank angles, hence below 2 pi


@dataclass(frozen=True, kw_only=True)
class Flow(Quantity):
    """Volume that pumps and compressors deliver in a turn, times turns per unit of time."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        factor = mechanism.direction * mean_speed_ratio(mechanism) / (2.0 * math.pi)
        rate = evaluate_formula_of_raw_numbers(
            mechanism, dimensions, lambda number: factor * number(Raw.SPEED), gradients=gradients
        )
        volume = evaluate_on_gas_cycle(mechanism, dimensions, lambda gas: gas.delivered, gradients=gradients)
        return Values(*volume).multiplied_by(Values(*rate))


class FlowRipple(Quantity):
    """Maximum minus minimum of the combined flow of all liquid pumps, divided by the mean flow.

    Consider massless pumps that deliver against 1 Pa. Their drive torque, N m, then equals the delivered volume per
    crank angle, m^3/rad. Subtract its maximum: the maximum magnitude of the result is the difference between maximum
    and minimum flow.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        differences = self._peak_to_trough_pieces(mechanism, np.asarray(dimensions, dtype=np.float64), 1)
        return Values(differences.values[:, 0], differences.gradients[:, 0] if gradients else None)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the differences between local peaks and troughs; see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return super().pieces(mechanism, dimensions)
        return self._peak_to_trough_pieces(mechanism, np.asarray(dimensions, dtype=np.float64), _MOST_PIECES)

    def _peak_to_trough_pieces(self, mechanism: Mechanism, designs: Array, peak_count: int) -> Pieces:
        n, pumps = len(designs), list(liquid_pumps(mechanism))
        areas = [
            evaluate_formula_of_raw_numbers(mechanism, designs, partial(_piston_area, k), gradients=True) for k in pumps
        ]
        machine, count = _machine_with_flow_as_torque(mechanism), cylinder_count(mechanism)
        flow_designs = np.column_stack([designs[:, :3], *(area for area, _ in areas), np.zeros(n)])
        peaks = find_peaks(machine, Signal.TORQUE, flow_designs, limit=peak_count, gradients=True)
        flow_designs[:, -1] = peaks.values[:, 0] / count
        troughs = find_peaks(machine, Signal.TORQUE, flow_designs, limit=peak_count, gradients=True)
        shape, chain = (n, peak_count * peak_count), np.zeros((n, flow_designs.shape[1], designs.shape[1]))
        chain[:, :3, :3] = np.eye(3)
        chain[:, 3:-1] = np.stack([slopes for _, slopes in areas if slopes is not None], axis=1)
        differences = (peaks.values - peaks.values[:, :1])[:, :, None] + troughs.values[:, None]
        assert peaks.gradients is not None
        assert troughs.gradients is not None
        slopes = (peaks.gradients[:, :, None] + troughs.gradients[:, None]).reshape(*shape, -1) @ chain
        mean, mean_slopes = evaluate_formula_of_raw_numbers(
            mechanism, designs, lambda number: _mean_delivery(number, pumps, count), gradients=True
        )
        assert mean_slopes is not None
        values = differences.reshape(shape) / mean[:, None]
        finite = np.isfinite(values)
        slopes = (slopes - np.where(finite, values, 0.0)[:, :, None] * mean_slopes[:, None]) / mean[:, None, None]
        labels = peaks.angles[:, :, None] + _LABEL_STEP * troughs.angles[:, None]
        return Pieces(values, np.where(finite[:, :, None], slopes, 0.0), labels.reshape(shape))


def liquid_pumps(mechanism: Mechanism) -> dict[int, Cylinder]:
    """Return the liquid pumps among a machine's loads, by index."""
    return {
        k: load
        for k, load in cylinder_loads(mechanism)
        if isinstance(load, Compressor) and load.compression_exponent == 0.0
    }


def _piston_area(k: int, number: Callable[[int], Any]) -> Any:
    """Return the piston area of a load from a machine's raw numbers, m^2."""
    bore, rod = (number(Raw.END + LOAD_SLOTS * k + Cylinder.slots[name][0]) for name in ("bore", "piston_rod"))
    return 0.25 * math.pi * (bore * bore - rod * rod)


def _mean_delivery(number: Callable[[int], Any], pumps: Iterable[int], count: int) -> Any:
    """Return the mean volume per crank angle that all cylinders deliver over a turn, m^3/rad."""
    swept = stroke(number(Raw.CRANK), number(Raw.ROD), magnitude(number(Raw.OFFSET)))
    return swept * sum(_piston_area(k, number) for k in pumps) * (count / (2.0 * math.pi))


@memoise_by_machine
def _machine_with_flow_as_torque(mechanism: Mechanism) -> Mechanism:
    """Return a machine whose drive torque equals the flow.

    Its designs end with the pump areas and a torque to subtract.
    """
    loads: list[Load] = []
    varying = []
    for place, pump in enumerate(liquid_pumps(mechanism).values()):
        loads.append(StrokeForce(outward=0.0, inward=0.0))
        side, sign = ("outward", -1.0) if pump.head == "outer dead centre" else ("inward", 1.0)
        varying.append(Varying(name=f"area {place}", sets=((f"loads.{place}.{side}", sign),), lower=0.0, upper=1.0))
    path = f"loads.{len(loads)}.torque"
    varying.append(Varying(name="torque", sets=((path, mechanism.direction),), lower=0.0, upper=1.0))
    return Mechanism(
        speed=mechanism.direction,
        branch=mechanism.branch,
        arrangement=mechanism.arrangement,
        loads=(*loads, CrankTorque()),
        varying=tuple(varying),
    )


FLOW = Flow(
    name="flow",
    title="delivered flow",
    kind=VOLUME_FLOW,
    place=451,
    group=Group.DRIVE,
    sentence=(
        "The mean volume per unit time that pumps and compressors deliver, summed over the cylinders. Gas is "
        "measured at suction pressure."
    ),
    advice=(
        "It follows the displacement volume, the speed and the volumetric efficiency. Valves are assumed to be ideal."
    ),
    formula="(|omega| / 2 pi) sum of eta_v A S: volumetric efficiency eta_v, 1 for a liquid; piston area A, stroke S",
    section="7. Loads",
    picture="cylinder",
    better="high",
    needs=(SPEED, COMPRESSOR),
)
FLOW_RIPPLE = FlowRipple(
    name="flow_ripple",
    kind=RATIO,
    place=452,
    group=Group.DRIVE,
    sentence=(
        "The difference between the greatest and least flow within a turn, divided by the mean flow: for all pumps "
        "together, at constant speed, with an incompressible liquid."
    ),
    advice="It is pi for one single-acting pump with a long rod, and 0.14 for three evenly spaced pumps.",
    formula="(max q - min q) / mean q, q = sum of A |x'| over the pumps in their delivery strokes",
    section="7. Loads",
    picture="cylinder",
    example=0.14,
    needs=(
        Need(
            lambda machine: bool(liquid_pumps(machine.with_largest_variables)),
            'it needs pumps for a liquid; got none; for example, add [[load]] bore = "70 mm", suction = "1 bar", '
            'discharge = "8 bar", medium = "liquid"',
            consequence="undefined",
        ),
        EVEN_SPEED,
    ),
)
