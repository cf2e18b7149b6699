"""Drive and joints in a job file, converted to the model: [drive], [friction], and the pin with [clearance]."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, Discriminator, Tag

from ...model.errors import JobError
from ...model.machine import drive as model
from ...model.machine.links_and_joints import Clearance, Friction, Joint, Law, Pin
from ...model.machine.mechanism import Mechanism
from ..problem.question_registry import Change, Remark
from .named_files import table_in
from .part_kinds import Kinds
from .sections_table import PinsPart
from .value_types import (
    AngularSpeed,
    Built,
    Checked,
    DrivingTorque,
    Efficiency,
    Fraction,
    Inertia,
    Limited,
    Loss,
    PositiveAngularSpeed,
    PositiveClearance,
    PositiveLength,
    PositiveRatio,
    PositiveTorque,
    Pressure,
    Recovery,
    Torque,
    optional_entry,
    required_entry,
)


class ConstantMotor(Built[model.Motor]):
    """A motor with constant torque at any speed."""

    makes = model.ConstantTorque

    torque: DrivingTorque = required_entry("at every speed; zero if only a load drives the crank", "20 N m")


class LineMotor(Built[model.Motor]):
    """A motor whose torque falls linearly from standstill to its no-load speed."""

    makes = model.LinearMotor

    stall_torque: PositiveTorque = required_entry("at standstill", "60 N m")
    no_load_speed: PositiveAngularSpeed = required_entry("where the torque is zero", "400 rpm")


class RatedMotor(Checked[model.Motor]):
    """A motor whose torque is linear in speed, given by its rated point and its no-load (synchronous) speed."""

    makes = model.LinearMotor.from_rated_point
    renamed: ClassVar = {"rated_torque": "torque", "rated_speed": "speed"}

    rated_torque: PositiveTorque = required_entry("at the rated speed", "14.6 N m")
    rated_speed: PositiveAngularSpeed = required_entry("under the rated torque", "1440 rpm")
    no_load_speed: PositiveAngularSpeed = required_entry("where the torque is zero", "1500 rpm")


class TableMotor(Checked[model.Motor]):
    """A motor given by its torque at several speeds, joined by a smooth curve without overshoot."""

    makes = model.TorqueTable

    speeds: tuple[AngularSpeed, ...] = required_entry(
        "motor speeds, increasing; the first must be zero or negative",
        ["0 rpm", "750 rpm", "1500 rpm"],
        min_length=2,
        max_length=1000,
    )
    torques: tuple[Torque, ...] = required_entry(
        "at each speed", ["30 N m", "45 N m", "0 N m"], min_length=2, max_length=1000
    )


# The key that identifies each kind of motor, in the order of the tests.
_KINDS = Kinds(
    {
        "torque": ConstantMotor,
        "stall_torque": LineMotor,
        "rated_torque": RatedMotor,
        "speeds": TableMotor,
    },
    "{ torque }, { stall_torque, no_load_speed }, { rated_torque, rated_speed, no_load_speed } or { speeds, torques }",
    "leave out one of the two",
)

AnyMotor = Annotated[
    Annotated[ConstantMotor, Tag("(torque)")]
    | Annotated[LineMotor, Tag("(stall_torque)")]
    | Annotated[RatedMotor, Tag("(rated_torque)")]
    | Annotated[TableMotor, Tag("(speeds)")],
    Discriminator(_KINDS.kind_tag),
    BeforeValidator(_KINDS.require_one_kind),
]


class DrivePart(Checked[model.Drive]):
    """The motor and the rotating parts; they turn the crank in the direction given by the sign of mechanism.speed."""

    makes = model.Drive

    motor: AnyMotor | None = optional_entry(
        "motor torque over motor speed, for a machine driven by its motor",
        {"stall_torque": "60 N m", "no_load_speed": "400 rpm"},
        {"torque": "20 N m"},
    )
    flywheel: Inertia = optional_entry("inertia on the crankshaft", "0.5 kg m^2", default=0.0)
    motor_inertia: Inertia = optional_entry(
        "of the rotor and everything that turns at motor speed", "0.004 kg m^2", default=0.0
    )
    gear_ratio: PositiveRatio = optional_entry("motor turns per crank turn", 5.0, default=1.0)
    gear_efficiency: Efficiency = optional_entry("of the gear while the motor drives", 0.94, default=1.0)
    braking_efficiency: Efficiency | None = optional_entry(
        "of the gear while the crank drives the motor; gear_efficiency if left out", 0.9
    )
    greatest_torque: PositiveTorque | None = optional_entry("that the motor can give briefly", "15 N m")
    rated_torque: PositiveTorque | None = optional_entry("that the motor can give continuously", "5 N m")
    greatest_speed: PositiveAngularSpeed | None = optional_entry("of the motor", "4000 rpm")
    copper_loss: Loss | None = optional_entry("heat in the winding at the rated torque", "120 W")
    recovery: Recovery = optional_entry("fraction of the braking energy that the supply takes back", 0.8, default=0.0)


def motor_torque_warnings(mechanism: Mechanism, tables: Mapping[str, Any]) -> list[str]:
    """Return a warning if the motor's continuous torque exceeds its brief torque, as stated and for all designs.

    tables: those of the job, for the change that swaps the two.
    """
    drive = mechanism.drive
    varying = {path for item in mechanism.varying for path in item.paths}
    if drive is None or varying & {"drive.rated_torque", "drive.greatest_torque"}:
        return []
    rated, greatest = drive.rated_torque, drive.greatest_torque
    if rated is None or greatest is None or rated <= greatest:
        return []
    stated = table_in(tables, "drive")
    swapped = {"rated_torque": stated.get("greatest_torque"), "greatest_torque": stated.get("rated_torque")}
    return [
        Remark(
            f"drive.rated_torque: a motor gives it continuously, and greatest_torque briefly; got {rated:.6g} N m, "
            f"more than {greatest:.6g} N m; swap the two, or correct one",
            None if None in swapped.values() else Change("drive", {**stated, **swapped}, "Swap the two torques"),
        )
    ]


Coefficient = Annotated[
    Fraction,
    Limited("a coefficient of friction of at most 2", "greased steel on bronze has about 0.1", greatest=2.0),
]
_Restitution = Annotated[
    Fraction, Limited("above 0 and at most 1", "steel on steel has about 0.9", greater_than=0.0, greatest=1.0)
]
_Poisson = Annotated[Fraction, Limited("from 0 to 0.5", "steel has 0.3", greatest=0.5)]


class PinPart(Built[Pin]):
    """A pin in its bearing: the friction moment is coefficient times radius times force."""

    makes = Pin

    radius: PositiveLength | None = optional_entry(
        "radius of the pin; default half its diameter in [sections]", "10 mm"
    )
    coefficient: Coefficient = required_entry("of friction, on the pin's surface", 0.08)


class FrictionPart(Built[Friction]):
    """Coulomb friction; an omitted joint has none."""

    makes = Friction

    guide: Coefficient = optional_entry("coefficient of the slider in its guide", 0.1, default=0.0)
    crank_pivot: PinPart | None = optional_entry("between frame and crank", {"radius": "15 mm", "coefficient": 0.08})
    crank_pin: PinPart | None = optional_entry(
        "between crank and connecting rod", {"radius": "10 mm", "coefficient": 0.08}
    )
    slider_pin: PinPart | None = optional_entry(
        "between connecting rod and slider", {"radius": "8 mm", "coefficient": 0.08}
    )

    def with_pins(self, pins: PinsPart | None) -> Friction:
        """Return the friction; pins without a radius have the diameters of [sections].

        Raises JobError if it then needs [sections] and that is missing.
        """
        friction = self.build()
        for name in PinsPart.model_fields:
            part: PinPart | None = getattr(self, name)
            if part is None or part.radius is not None:
                continue
            if pins is None:
                raise JobError(
                    f"friction.{name}.radius: is missing, but required without [sections], which has the pins; add for "
                    'example radius = "10 mm"'
                )
            pin = replace(getattr(friction, name), radius=0.5 * getattr(pins, name))
            friction = replace(friction, **{name: pin})
        return friction


class ClearancePart(Checked[Clearance]):
    """A pin joint with a loose journal in its bearing."""

    makes = Clearance
    renamed: ClassVar = {"radial_clearance": "radius"}

    joint: Joint = required_entry("pin with clearance", "crank pin")
    radial_clearance: PositiveClearance = required_entry(
        "radius of the bearing minus radius of the journal: half the difference of the diameters", "0.2 mm"
    )
    journal_radius: PositiveLength = required_entry("of the pin", "10 mm")
    restitution: _Restitution = optional_entry(
        "speed after an impact over speed before, above 0 and at most 1", 0.9, default=0.9
    )
    friction: Fraction = optional_entry("coefficient between journal and bearing", 0.1, default=0.0)
    law: Law = optional_entry("of the damping in a contact", "flores", default="flores")
    elastic_modulus: Pressure = optional_entry("of journal and bearing; default steel", "207 GPa", default=207e9)
    poisson: _Poisson = optional_entry("Poisson's ratio of journal and bearing", 0.3, default=0.3)
