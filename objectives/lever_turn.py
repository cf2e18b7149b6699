"""Quantities of a crank that rotates fully and turns an arm: crank-shaper, Whitworth, oscillating cylinder."""

from functools import partial

import numpy as np

from ..model.turning_cylinder.closed_forms import (
    arm_swing_angle,
    arm_time_ratio_at_constant_crank_speed,
    crank_work_per_turn,
    least_arm_transmission_angle,
    ram_stroke,
)
from .kinds import ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, ENERGY, LENGTH, RATIO, SPEED, TORQUE
from .lever_quantity import LeverForm, LeverPeak, LeverRms
from .machine_needs import SPEED as CRANK_SPEED
from .quantity import Domain, Group

_form = partial(LeverForm, group=Group.MOTION, moved_by=("turning crank",), picture="cylinder")
_peak = partial(LeverPeak, group=Group.MOTION, moved_by=("turning crank",), picture="cylinder")
_fast = partial(_peak, needs=(CRANK_SPEED,))

ARM_TIME_RATIO = _form(
    name="arm_time_ratio",
    title="time ratio of the arm",
    kind=RATIO,
    forms=(lambda c, _: arm_time_ratio_at_constant_crank_speed(c),),
    place=360,
    sentence="The time of the arm's slow stroke divided by the time of its fast stroke, with the crank at constant "
    "speed.",
    advice="If the arm rotates, a stroke lasts from one crossing of the normal to the line between both pivots to "
    "the other.",
    formula="(180 deg + a) / (180 deg - a), a = asin((m - e) / M) + asin((m + e) / M), m < M of crank and frame",
    example=1.6,
    better="high",
    domain=Domain(lower=1.0, rule="a time ratio is above 1", remedy="1.3 to 2 are usual"),
)
ARM_SWING = _form(
    name="arm_swing",
    title="swing of the arm",
    kind=ANGLE,
    forms=(lambda c, _: arm_swing_angle(c),),
    place=361,
    sentence="The angle between both ends of the arm's swing, 360 deg if it rotates, as it does with frame < crank.",
    formula="asin((r - e) / f) + asin((r + e) / f)",
    example="50 deg",
    better="high",
)
ARM_TRANSMISSION_ANGLE = _form(
    name="arm_transmission_angle",
    title="least transmission angle of the arm",
    short="transmission angle",
    kind=ANGLE,
    forms=(lambda c, _: least_arm_transmission_angle(c),),
    smooth_at_zero_offset=False,
    place=362,
    group=Group.PROPORTIONS,
    sentence="The least angle between the force of the crank on the arm and the line from pin to arm pivot.",
    advice="It is 90 deg without an offset.",
    formula="acos(|e| / |f - r|)",
    example="30 deg",
    better="high",
    domain=Domain.of_acute_angle("the transmission angle of an arm lies between 0 and 90 deg", "20 to 50 deg"),
    floor=float(np.radians(10.0)),
)
ARM_SPEED_RATIO = _peak(
    name="arm_speed_ratio",
    title="greatest speed of the arm divided by the speed of the crank",
    kind=RATIO,
    curves=("arm_speed_ratio",),
    place=363,
    sentence="The greatest angular speed of the arm divided by the angular speed of the crank.",
    formula="max over the turn of |d gamma / d theta|, r / |f - r| without an offset",
    example=1.2,
)
ARM_ACCELERATION_RATIO = _peak(
    name="arm_acceleration_ratio",
    title="greatest acceleration of the arm over the squared speed of the crank",
    kind=RATIO,
    curves=("arm_rise_ratio", "arm_fall_ratio"),
    place=364,
    sentence="The greatest angular acceleration of the arm over the square of the crank's angular speed.",
    formula="max over the turn of |d^2 gamma / d theta^2|",
    example=1.2,
)
PEAK_ARM_SPEED = _fast(
    name="peak_arm_speed",
    kind=ANGULAR_SPEED,
    curves=("arm_speed",),
    place=365,
    sentence="The greatest angular speed of the arm.",
    formula="max over the turn of |omega d gamma / d theta|",
)
PEAK_ARM_ACCELERATION = _fast(
    name="peak_arm_acceleration",
    kind=ANGULAR_ACCELERATION,
    curves=("arm_rise", "arm_fall"),
    place=366,
    picture="acceleration",
    sentence="The greatest angular acceleration of the arm.",
    formula="max over the turn of |omega^2 d^2 gamma / d theta^2|",
)
PEAK_SLIDING_SPEED = _fast(
    name="peak_sliding_speed",
    title="greatest speed of the pin along the arm",
    kind=SPEED,
    curves=("sliding_speed",),
    place=367,
    sentence="The greatest speed of the crank's pin along the arm, or of an oscillating cylinder's piston.",
    formula="max over the turn of |omega dL / d theta|",
    example="1 m/s",
)
RAM_STROKE = _form(
    name="ram_stroke",
    title="stroke of the ram",
    kind=LENGTH,
    forms=(lambda c, _: ram_stroke(c),),
    known=("ram",),
    place=368,
    sentence="The stroke of the ram that the arm drives, at right angles to the line between both pivots.",
    formula="2 R r / f, or 2 R with frame < crank",
    example="300 mm",
    better="high",
)
PEAK_RAM_SPEED = _fast(
    name="peak_ram_speed",
    kind=SPEED,
    curves=("ram_speed",),
    known=("ram",),
    place=369,
    sentence="The greatest speed of the ram over a turn of the crank.",
    formula="max over the turn of |omega R cos(gamma - direction of OA) d gamma / d theta|",
    example="1 m/s",
)
PEAK_CRANK_TORQUE = _peak(
    name="peak_crank_torque",
    kind=TORQUE,
    curves=("torque_up", "torque_down"),
    place=370,
    group=Group.DRIVE,
    picture="torque",
    sentence="The greatest torque on the crank over the turn at constant speed, driving or braking.",
    formula="max over the turn of |T|",
)
RMS_CRANK_TORQUE = LeverRms(
    name="rms_crank_torque",
    title="RMS crank torque",
    kind=TORQUE,
    moved_by=("turning crank",),
    place=371,
    group=Group.DRIVE,
    picture="torque",
    sentence="The root mean square of the torque on the crank over the turn at constant speed.",
    formula="sqrt(mean of T^2 over the turn)",
)
TURN_WORK = _form(
    name="turn_work",
    title="work of the crank in a turn",
    kind=ENERGY,
    forms=(lambda c, _: crank_work_per_turn(c),),
    place=372,
    group=Group.DRIVE,
    picture="power",
    sentence="The work of the crank in a full turn: against the arm's torque, the ram's force and friction.",
    formula="torque * angle of both strokes + ram force * ram stroke + 2 friction of the seal * travel",
)
