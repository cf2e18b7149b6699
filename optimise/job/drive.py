"""Drive of the crank in a job file, [drive], and its conversion to the drive of the model."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import BeforeValidator, Discriminator, Field, Tag

from ...model.machine import drive as model
from .kinds import Kinds
from .values import AngularSpeed, Built, Checked, Inertia, PositiveAngularSpeed, PositiveRatio, PositiveTorque, Torque


class ConstantMotor(Built[model.Motor]):
    """A motor with the same torque at every speed."""

    makes = model.ConstantTorque

    torque: PositiveTorque = Field(description="at every speed", examples=["20 N m"])


class LineMotor(Built[model.Motor]):
    """A motor whose torque falls linearly from standstill to its no-load speed."""

    makes = model.LinearMotor

    stall_torque: PositiveTorque = Field(description="at standstill", examples=["60 N m"])
    no_load_speed: PositiveAngularSpeed = Field(description="where the torque is zero", examples=["400 rpm"])


class RatedMotor(Checked[model.Motor]):
    """A motor whose torque is linear in speed, by its rated point and its no-load (synchronous) speed."""

    makes = model.LinearMotor.through
    renamed: ClassVar = {"rated_torque": "torque", "rated_speed": "speed"}

    rated_torque: PositiveTorque = Field(description="at the rated speed", examples=["14.6 N m"])
    rated_speed: PositiveAngularSpeed = Field(description="under the rated torque", examples=["1440 rpm"])
    no_load_speed: PositiveAngularSpeed = Field(description="where the torque is zero", examples=["1500 rpm"])


class TableMotor(Checked[model.Motor]):
    """A motor by its torque at several speeds, joined by a smooth curve without overshoot."""

    makes = model.TorqueTable

    speeds: tuple[AngularSpeed, ...] = Field(
        min_length=2,
        max_length=1000,
        description="of the motor, increasing, the first one standstill or below",
        examples=[["0 rpm", "750 rpm", "1500 rpm"]],
    )
    torques: tuple[Torque, ...] = Field(
        min_length=2, max_length=1000, description="at each speed", examples=[["30 N m", "45 N m", "0 N m"]]
    )


# The key that tells a kind of motor, in the order in which kinds are told apart.
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
    Discriminator(_KINDS.tag),
    BeforeValidator(_KINDS.one),
]


class DrivePart(Built[model.Drive]):
    """The motor and what turns with it; it turns the crank the way the sign of mechanism.speed says."""

    makes = model.Drive

    motor: AnyMotor = Field(
        description="torque over the motor's own speed",
        examples=[{"stall_torque": "60 N m", "no_load_speed": "400 rpm"}, {"torque": "20 N m"}],
    )
    flywheel: Inertia = Field(0.0, description="inertia on the crank shaft", examples=["0.5 kg m^2"])
    motor_inertia: Inertia = Field(
        0.0, description="of the rotor and all that turns at motor speed", examples=["0.004 kg m^2"]
    )
    gear_ratio: PositiveRatio = Field(1.0, description="turns of the motor for one turn of the crank", examples=[5.0])
