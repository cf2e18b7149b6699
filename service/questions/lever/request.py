"""Request for a lever: omitted numbers come from the job."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ....model.cycle.cycle import derived_design
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.linkage.require_single_linkage import SEE_DESIGNS
from ....model.machine.design import Design
from ....model.machine.lever_cylinder import Cylinder
from ....model.machine.mechanism import Mechanism
from ....model.swing.swing import Swing, swing_between_crank_angles
from ....model.swing.swing_types import LeverLaw
from ....model.turning_cylinder.cylinder_and_pin_forces import LeverBody, LeverMachine, LeverSwing, UniformBar
from ....model.turning_cylinder.lever_geometry import DimensionErrors, TurningCylinder

_GRAVITY = 9.81  # m/s^2
_CYLINDER = {
    **{name: name for name in ("closed_length", "bore", "supply_pressure", "seal_friction")},
    **{name: name for name in ("barrel_mass", "piston_rod_mass", "length_tolerance", "dead_length", "mounting")},
    **{name: name.partition("_")[2] for name in ("cylinder_stroke", "piston_rod")},
}
"""Inputs, and the field of a `Cylinder` that each one sets."""


@dataclass(frozen=True)
class LeverRequest:
    """Requested machine, swing, cylinder and tolerances."""

    machine: LeverMachine
    swing: LeverSwing
    cylinder: Cylinder
    errors: DimensionErrors


def lever_request(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    swing: Swing | None,
    words: Mapping[str, str] | None = None,
    **inputs: Any,
) -> LeverRequest:
    """Return the request from a machine and inputs by name, SI. words: the interface's names for the inputs.

    The crank is the lever, the rod the distance between the pivots. swing: swing of the job. Raises `InputError` for
    missing inputs and a swing with a dead point, `AssemblyError` if the linkage does not close.
    """
    if swing is not None and swing.of_full_turn:
        raise InputError(
            f"a lever is analysed over a swing that its cylinder drives; got a crank that rotates fully; {SEE_DESIGNS}"
        )
    labels = dict(words or {})
    lever_swing = _swing(mechanism, linkage, swing, labels, inputs)
    own = mechanism.lever
    pin_angle = inputs.get("pin_angle", 0.0 if own is None else own.pin_angle)
    # By default farthest from both dead points.
    usual_angle = 0.5 * (lever_swing.start + lever_swing.end) + pin_angle - 0.5 * math.pi
    sizes = TurningCylinder(
        crank=float(linkage.crank),
        frame=float(linkage.rod),
        frame_angle=inputs.get("frame_angle", usual_angle if own is None else own.frame_angle),
        offset=float(linkage.offset),
        pin_angle=pin_angle,
    )
    sizes.require_swing(lever_swing.start, lever_swing.end)
    design = derived_design(mechanism, linkage)
    given = {name: inputs[key] for key, name in _CYLINDER.items() if key in inputs}
    cylinder = replace(_cylinder_of_job(mechanism, swing), **given)
    shortest, longest = sorted(float(sizes.cylinder_length(angle)) for angle in (lever_swing.start, lever_swing.end))
    closed, _ = cylinder.closed_length_and_stroke(longest - shortest) or (shortest, None)
    machine = LeverMachine(
        sizes=sizes,
        lever=_lever(design, labels, inputs),
        barrel=UniformBar(mass=cylinder.barrel_mass, length=closed),
        piston_rod=UniformBar(mass=cylinder.piston_rod_mass, length=closed),
        gravity=_gravity(mechanism, inputs.get("gravity")),
        spring=None if own is None else own.spring,
    )
    errors = (float(design.crank_error), float(design.rod_error), float(design.offset_error), cylinder.length_tolerance)
    return LeverRequest(machine, lever_swing, cylinder, DimensionErrors(*errors))


def _cylinder_of_job(mechanism: Mechanism, swing: Swing | None) -> Cylinder:
    """Return the cylinder of a job; of a slider-crank that its slider drives, the tolerance of the actuator."""
    if mechanism.lever is not None:
        return mechanism.lever.cylinder
    return Cylinder(length_tolerance=0.0 if swing is None else swing.actuator_tolerance)


def _lever(design: Design, labels: Mapping[str, str], inputs: Mapping[str, Any]) -> LeverBody:
    """Return the crank of a design, including the additional mass that the lever carries."""
    mass, centre = inputs.get("mass", 0.0), inputs.get("centre")
    if mass and centre is None:
        raise InputError(
            f"a carried mass needs a position on the lever; got {mass:.6g} kg and no {labels.get('centre', 'centre')}; "
            "give its distance from the pivot"
        )
    body = LeverBody(
        mass=float(design.crank_mass),
        moment_along=float(design.crank_along),
        moment_across=float(design.crank_across),
        inertia=float(design.crank_inertia),
    )
    return body.with_point_mass(mass, centre or 0.0, inputs.get("centre_across", 0.0))


def _gravity(mechanism: Mechanism, downward: float | None) -> tuple[float, float]:
    """Return the given gravity, or else that of the job, or else that of the earth."""
    if downward is None and mechanism != Mechanism(branch=mechanism.branch):
        return mechanism.gravity
    return 0.0, -(_GRAVITY if downward is None else downward)


def _swing(
    mechanism: Mechanism, linkage: Linkage, swing: Swing | None, labels: Mapping[str, str], inputs: Mapping[str, Any]
) -> LeverSwing:
    """Return the requested swing; omitted values come from the job."""
    start, end = inputs.get("start"), inputs.get("end")
    if swing is not None and (start is None or end is None):
        of_job = swing_between_crank_angles(mechanism, linkage, swing)
        start, end = (given if given is not None else own for given, own in ((start, of_job.start), (end, of_job.end)))
    for name, angle in (("start", start), ("end", end)):
        if angle is None:
            raise InputError(
                f"a lever swings from one angle to another; got no {labels.get(name, name)}; give both, or use a job "
                "with [motion]"
            )
    law: LeverLaw | None = inputs.get("law")
    if law is None and swing is not None:
        if swing.law == "table":
            raise InputError(
                "a lever must move slowly or with a named law; got a table in [motion] of the job; give "
                f"{labels.get('law', 'law')} slow, or another law"
            )
        law = swing.law
    law = law or "slow"
    duration = inputs.get("duration")
    if duration is None and swing is not None and law != "slow":
        duration = swing.duration
    assert start is not None
    assert end is not None
    return LeverSwing(start, end, law, duration)
