"""A crank turn divided into cells, with the terms of the kinetic energy over the crank angle.

With the kinetic energy K = J w^2 / 2 of all moving parts and phi the angle passed, in the direction of rotation,

    dK / d(phi) = T - Q(phi),        w^2 = 2 K / J(phi),        alpha = (T - Q - K J' / J) / J,

where T is the torque in that direction, and Q is the torque that gravity and loads absorb. J and Q follow from the
equation of motion (`model.transient.crank_equation`); the drive's inertia at the crank counts as part of the crank.
Cells end at all breakpoints, so that every term is smooth within a cell and is known at its 16 Gauss-Legendre nodes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre

from ..arrays import Array, IntArray, Mask
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.arrangement import require_one_cylinder
from ..machine.cylinders_and_turns import cycle_turns
from ..machine.mechanism import Mechanism
from ..quadrature import DEGREE, FIT, INTEGRALS, INTEGRATED, WEIGHTS
from ..transient.crank_equation import TURN, CrankEquation
from ..transient.steady_cycle import PeriodicTurn


def with_drive_inertia(mechanism: Mechanism) -> Mechanism:
    """Return the machine at constant speed, with the inertia of the flywheel and the rotor added to the crank."""
    added = 0.0 if mechanism.drive is None else mechanism.drive.inertia
    weight = mechanism.counterweight
    heavy = replace(weight, inertia=weight.inertia + added) if added else weight
    return replace(mechanism, counterweight=heavy, drive=None, speed_profile=None, acceleration=0.0)


@dataclass(frozen=True)
class LawTerms:
    """J, J', Q, x' and x'' by the angle passed, SI; arrays of one shape."""

    inertia: Array
    inertia_slope: Array
    load: Array
    travel: Array
    curvature: Array


class LawTurn:
    """Cells of a turn in the order in which the crank passes them: n cells, 16 nodes each.

    machine: the mechanism with the drive's inertia on its crank. way: +1 or -1, direction of rotation. start: crank
    angle of the first cell, rad. passed: phi at the start of each cell, (n,), rad. width: (n,), rad. angle, inertia,
    inertia_slope, load, travel, curvature: crank angle, J, J', Q, x' and x'' by phi at the nodes, (n, 16), SI.
    """

    def __init__(self, mechanism: Mechanism, linkage: Linkage, marks: tuple[float, ...] = ()) -> None:
        """Take a machine and additional crank angles at which cells end, rad.

        Raises `AssemblyError` for a linkage that does not rotate fully, and `InputError` for machines without such an
        equation: with friction, several cylinders, a two-turn cycle, or speed-dependent loads.
        """
        self.machine = with_drive_inertia(mechanism)
        self.linkage = require_single_rotating_linkage(self.machine, linkage)
        _require_torque_from_energy_alone(self.machine)
        equation = CrankEquation(self.machine, self.linkage, marks=marks)
        equation.require_inertia(0.0)
        dimensions = (float(linkage.crank), float(linkage.rod), float(linkage.offset))
        self._copy_cells(PeriodicTurn(equation, dimensions))
        if self._turn.terms.depends_on_speed:
            raise InputError(
                "a motion law accepts only loads that do not depend on the speed; got one that does; leave out "
                "viscous loads and drag"
            )

    def _copy_cells(self, turn: PeriodicTurn) -> None:
        self._turn, self.way = turn, turn.way
        self.start, self.width = float(turn.low[0]), np.abs(turn.width)
        self.passed = np.concatenate([[0.0], np.cumsum(self.width)[:-1]])
        self.angle = turn.angle
        slope, load = 2.0 * self.way * turn.terms.spin, self.way * turn.terms.static
        self.terms = LawTerms(turn.terms.inertia, slope, load, *self.slider_derivatives(turn.angle))
        cells = np.arange(len(turn.width))

        def at_cell_ends(values: Array) -> Array:
            return np.stack([interpolate_in_cells(values, cells, np.full(len(cells), end)) for end in (0.0, 1.0)])

        angles = np.stack([turn.low, turn.low + turn.width])
        self.end_terms = LawTerms(
            self.inertia_at(angles), at_cell_ends(slope), at_cell_ends(load), *self.slider_derivatives(angles)
        )

    def with_halved_cells(self, cells: Mask) -> LawTurn:
        """Return the turn with the chosen cells (n,) halved."""
        turn = object.__new__(LawTurn)
        turn.machine, turn.linkage = self.machine, self.linkage
        turn._copy_cells(self._turn.cut_at_angles(self._turn.low[cells] + 0.5 * self._turn.width[cells]))
        return turn

    @property
    def angle_weights(self) -> Array:
        """Weights (n, 16) for an integral over phi."""
        return np.asarray(self.width[:, None] * WEIGHTS)

    @property
    def cell_start_angles(self) -> Array:
        """Crank angle at the start of each cell, (n,), rad."""
        return self._turn.low

    @property
    def work_absorbed_by_loads(self) -> float:
        """Work that the loads absorb in a turn, J; gravity absorbs none."""
        return float(np.sum(self.angle_weights * self.terms.load))

    def slider_derivatives(self, crank_angle: Array) -> tuple[Array, Array]:
        """Return x' and x'' by phi, m, at crank angles, rad."""
        motion = self.linkage.at(crank_angle, speed=self.way)
        return motion.slider_velocity, motion.slider_acceleration

    def inertia_at(self, crank_angle: Array) -> Array:
        """Return J, kg m^2, at crank angles, rad."""
        return np.asarray(self._turn.equation.moving_inertia(crank_angle))

    def locate_in_cells(self, crank_angle: Array) -> tuple[IntArray, Array]:
        """Return the cells (n,) that contain crank angles, rad, and the positions within them, from 0 to 1."""
        phi = np.mod(self.way * (crank_angle - self.start), TURN)
        cell = np.clip(np.searchsorted(self.passed, phi, side="right") - 1, 0, len(self.width) - 1)
        return np.asarray(cell), (phi - self.passed[cell]) / self.width[cell]

    def integrals_to_nodes(self, values: Array) -> Array:
        """Return integrals over phi (n, 16) of values at the nodes, from the start of each cell to its nodes."""
        return np.asarray(self.width[:, None] * (values @ INTEGRALS.T))

    def integral_from_cell_start(self, values: Array, cell: IntArray, place: Array) -> Array:
        """Return integrals over phi of values at all nodes, from the start of cells (n,) to positions within them."""
        return np.asarray(self.width[cell] * np.einsum("ni,ni->n", cell_integral_weights(place), values[cell]))


def interpolate_in_cells(values: Array, cell: IntArray, place: Array) -> Array:
    """Return values (n,) at positions from 0 to 1 in cells, interpolated from those at all nodes (cells, 16)."""
    basis = legendre.legvander(2.0 * place - 1.0, DEGREE) @ FIT
    return np.asarray(np.einsum("ni,ni->n", basis, values[cell]))


def cell_integral_weights(place: Array) -> Array:
    """Return weights (n, 16) for integrals over a unit cell, from its start to positions from 0 to 1."""
    return np.asarray(legendre.legvander(2.0 * place - 1.0, DEGREE + 1) @ INTEGRATED @ FIT)


def _require_torque_from_energy_alone(mechanism: Mechanism) -> None:
    """Raise `InputError` for machines whose torque has terms besides T = K' + Q."""
    require_one_cylinder(mechanism.arrangement, "a motion law")
    if cycle_turns(mechanism) > 1:
        raise InputError(
            "a motion law must repeat after one turn; got loads with a cycle of 720 deg; use loads with a cycle of "
            "one turn"
        )
    if mechanism.friction.acts:
        raise InputError(
            "a motion law can only be found without friction in the joints; got friction in joints or guide; leave "
            "[friction] out, and state its force as a load that opposes motion"
        )
