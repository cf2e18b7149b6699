"""Quantities of a lever's cylinder over a swing: force, pressure, flow, power, work, safety against buckling."""

from functools import partial

from ..model.turning_cylinder.closed_forms import greatest_cylinder_speed, work_from_start_to_end
from .kinds import ANGLE, ENERGY, FORCE, POWER, PRESSURE, RATIO, SPEED, VOLUME_FLOW
from .lever_quantity import LeverForm, LeverPeak
from .motion_deviation import POSITION_ERROR
from .quantity import Group
from .swing_quantities import PEAK_ACTUATOR_FORCE, PEAK_ACTUATOR_POWER, SWING_ANGLE_ERROR, SWING_ENERGY

_peak = partial(LeverPeak, group=Group.DRIVE, picture="cylinder")
_form = partial(LeverForm, group=Group.DRIVE, picture="cylinder")
_pin = partial(LeverPeak, kind=FORCE, group=Group.FORCES, example="5 kN", moved_by=("cylinder", "turning crank"))

PEAK_CYLINDER_FORCE = _peak(
    name="peak_cylinder_force",
    swing_counterpart=PEAK_ACTUATOR_FORCE.name,
    kind=FORCE,
    curves=("push", "pull"),
    least_value=0.0,
    place=340,
    sentence="The greatest force of the cylinder, push or pull, over the swing and at rest at both ends.",
    advice="It grows without bound towards a dead point.",
    formula="max over the swing of |P| + friction of the seal",
    example="5 kN",
)
PEAK_CYLINDER_PUSH = _peak(
    name="peak_cylinder_push",
    kind=FORCE,
    curves=("push",),
    least_value=0.0,
    place=341,
    sentence="The greatest push of the cylinder, 0 if it only pulls.",
    formula="max over the swing of P + friction of the seal",
    example="5 kN",
)
PEAK_CYLINDER_PULL = _peak(
    name="peak_cylinder_pull",
    kind=FORCE,
    curves=("pull",),
    least_value=0.0,
    place=342,
    sentence="The greatest pull of the cylinder, 0 if it only pushes.",
    formula="max over the swing of -P + friction of the seal",
    example="5 kN",
)
CYLINDER_PRESSURE = _peak(
    name="cylinder_pressure",
    title="pressure that the cylinder needs",
    kind=PRESSURE,
    curves=("push", "pull"),
    divisors=(lambda c: c.full_area, lambda c: c.annular_area),
    least_value=0.0,
    known=("bore",),
    place=343,
    sentence="The greatest pressure, of push on the full area or of pull on the annular area.",
    formula="max(push / full area, pull / annular area)",
    example="160 bar",
)
PRESSURE_MARGIN = _peak(
    name="pressure_margin",
    title="supply pressure over the needed one",
    kind=RATIO,
    curves=("push", "pull"),
    divisors=(lambda c: c.full_area * c.supply, lambda c: c.annular_area * c.supply),
    inverse=True,
    known=("bore", "supply_pressure"),
    place=344,
    sentence="The supply pressure divided by the pressure that the cylinder needs.",
    advice="Unless a job sets another bound, it is at least 1.",
    formula="supply pressure / max(push / full area, pull / annular area)",
    example=1.2,
    better="high",
    floor=1.0,
    endless="It is infinite where nothing loads the cylinder.",
)
BUCKLING_MARGIN = _peak(
    name="buckling_margin",
    title="margin of the cylinder against buckling",
    kind=RATIO,
    curves=("buckling_share",),
    inverse=True,
    known=("rod",),
    place=345,
    group=Group.STRENGTH,
    sentence="The least ratio of the cylinder's buckling load to its push, for pinned ends and the piston rod's "
    "diameter over the whole length.",
    advice="Unless a job sets another bound, it is at least 1.",
    formula="min over the swing of pi^2 E I / (L^2 P)",
    source="S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, chapter 2",
    example=3.0,
    better="high",
    floor=1.0,
    endless="It is infinite where the cylinder only pulls.",
)
PEAK_CYLINDER_SPEED = _form(
    name="peak_cylinder_speed",
    kind=SPEED,
    forms=(greatest_cylinder_speed,),
    timed=True,
    place=346,
    group=Group.MOTION,
    sentence="The greatest speed at which the cylinder extends.",
    formula="max over the swing of |dL/dt|",
    example="0.2 m/s",
)
CYLINDER_FLOW = _form(
    name="cylinder_flow",
    title="greatest flow of the cylinder",
    kind=VOLUME_FLOW,
    forms=(lambda c, fastest: c.full_area * greatest_cylinder_speed(c, fastest),),
    timed=True,
    known=("bore",),
    place=347,
    sentence="The greatest volume flow into the full area.",
    formula="full area * max |dL/dt|",
)
PEAK_CYLINDER_POWER = _peak(
    name="peak_cylinder_power",
    swing_counterpart=PEAK_ACTUATOR_POWER.name,
    kind=POWER,
    curves=("push_power", "pull_power"),
    least_value=0.0,
    timed=True,
    place=348,
    picture="power",
    sentence="The greatest power of the cylinder over the swing, driving or braking.",
    formula="max over the swing of (|P| + friction of the seal) |dL/dt|",
)
LEVER_WORK = _form(
    name="lever_work",
    swing_counterpart=SWING_ENERGY.name,
    title="work of the cylinder from start to end",
    kind=ENERGY,
    forms=(lambda c, _: work_from_start_to_end(c),),
    signed=True,
    place=349,
    picture="power",
    sentence="The work that a slow cylinder does from start to end; negative if it has to brake.",
    formula="integral of P dL + friction of the seal * travel",
)
LEVER_PIN_FORCE = _pin(
    name="lever_pin_force",
    title="force at the lever's pin",
    curves=("pin",),
    place=350,
    picture="crank pin force",
    sentence="The greatest force of the piston rod on the lever.",
    formula="max over the motion of |F|",
)
LEVER_PIVOT_FORCE = _pin(
    name="lever_pivot_force",
    title="force at the lever's pivot",
    curves=("pivot",),
    place=351,
    picture="pivot force",
    sentence="The greatest force of the frame on the lever at its pivot.",
    formula="max over the motion of |rate of its momentum - m g - F|",
)
CYLINDER_PIVOT_FORCE = _pin(
    name="cylinder_pivot_force",
    title="force at the cylinder's pivot",
    curves=("cylinder_pivot",),
    place=352,
    picture="pivot force",
    sentence="The greatest force of the frame on the cylinder, or on the arm that a crank drives, at its pivot.",
    formula="max over the motion of |F + rate of its momentum - m g|",
)
LEVER_ANGLE_ERROR = _peak(
    name="lever_angle_error",
    swing_counterpart=SWING_ANGLE_ERROR.name,
    kind=ANGLE,
    curves=("angle_error",),
    tolerated=True,
    place=353,
    group=Group.ACCURACY,
    source=POSITION_ERROR.source,
    picture="position error",
    about_tolerances=True,
    sentence=(
        "The greatest error of the lever angle over the swing, with crank, frame, offset and length of the cylinder at "
        "their tolerances in the worst combination."
    ),
    formula="max of (L T_L + |e| T_e + |r - f cos(psi)| T_r + |f - r cos(psi)| T_f) / (r f |sin(psi)|)",
    example="0.4 deg",
)
