"""Texts of the quantities that masses and loads bring about."""

from __future__ import annotations

from .text import Text

_DYNAMICS = "8. Dynamics"
_MOTOR = "10. Motor and balance"
_TORQUE = "T = J alpha + J' omega^2 / 2 + V' - F x'"

FORCES = (
    Text(
        name="peak_torque",
        sentence=(
            "The greatest torque that the drive must give within a turn, whichever way it acts, with all masses, "
            "loads, gravity and friction of the job."
        ),
        advice="It sizes motor and gear; at high speed inertia dominates it, at low speed the load.",
        formula=f"max |T|, {_TORQUE}: reflected inertia J, potential energy V, load F",
        section=_DYNAMICS,
        picture="torque",
    ),
    Text(
        name="peak_torque_outward",
        sentence="The greatest torque of the drive while the slider moves outward, away from the crank pivot.",
        formula=f"max |T| over the outward stroke, {_TORQUE}",
        section=_DYNAMICS,
        picture="torque",
    ),
    Text(
        name="peak_torque_inward",
        sentence="The greatest torque of the drive while the slider moves inward, towards the crank pivot.",
        formula=f"max |T| over the inward stroke, {_TORQUE}",
        section=_DYNAMICS,
        picture="torque",
    ),
    Text(
        name="rms_torque",
        sentence="The root mean square of the drive torque over a turn, which is what warms up a motor.",
        advice="Compare it with the rated torque of the motor, and the peak torque with its greatest one.",
        formula="sqrt(mean of T^2 over the crank angle)",
        section=_MOTOR,
        picture="torque",
    ),
    Text(
        name="mean_torque",
        sentence="The average of the drive torque over a turn: what the load takes, and friction.",
        advice="Inertia and gravity need no torque on average, however high their peaks.",
        formula="mean of T over the crank angle",
        section=_MOTOR,
        picture="torque",
    ),
    Text(
        name="peak_power",
        sentence="The greatest power that passes between drive and crank within a turn, driving or braking.",
        formula="max |T omega|",
        section=_MOTOR,
        picture="power",
    ),
    Text(
        name="mean_power",
        sentence="The average power of the drive over a turn: the energy that the machine takes.",
        formula="omega times the mean of T",
        section=_MOTOR,
        picture="power",
    ),
    Text(
        name="peak_reflected_inertia",
        sentence="The greatest moment of inertia that the drive feels at the crank, with rod and slider counted in.",
        advice="To compare it with the inertia of a motor, divide it by the square of the gear ratio.",
        formula="max J, where J omega^2 / 2 is the kinetic energy of all links",
        section=_MOTOR,
        picture="inertia",
    ),
    Text(
        name="peak_pivot_force",
        sentence="The greatest force in the bearing of the crank in the frame within a turn.",
        advice="It sizes the main bearing.",
        formula="max |P|, P = A + dynamic and weight forces of the crank",
        section=_DYNAMICS,
        picture="pivot force",
    ),
    Text(
        name="peak_crank_pin_force",
        sentence="The greatest force in the joint of crank and rod within a turn.",
        formula="max |A|, A = B + dynamic and weight forces of the rod",
        section=_DYNAMICS,
        picture="crank pin force",
    ),
    Text(
        name="peak_slider_pin_force",
        sentence="The greatest force in the joint of rod and slider within a turn.",
        formula="max |B|, with B_x = m_s (acceleration - g_x) - F",
        section=_DYNAMICS,
        picture="slider pin force",
    ),
    Text(
        name="peak_guide_force",
        sentence="The greatest force of the guide on the slider, normal to the slider line: what wears the guide.",
        advice="A small transmission angle makes it large.",
        formula="max |N|, N = -B_y - m_s g_y",
        section=_DYNAMICS,
        picture="guide force",
    ),
    Text(
        name="self_locking_margin",
        sentence=(
            "By how many degrees the least transmission angle exceeds the one at which friction would lock the "
            "linkage, so that no torque could drive it."
        ),
        advice="It must stay above 0; 10 deg and more are usual. Without friction there is none.",
        formula="mu_min - arctan(f) - arcsin((rho_A + rho_B) / l): friction f of the guide, friction circles rho",
        section="15. Self-locking",
        picture="self-locking",
    ),
    Text(
        name="peak_shaking_force",
        sentence="The greatest force with which the moving links shake the frame within a turn.",
        advice="A counterweight on the crank lowers it, never to zero: the slider remains.",
        formula="max |F_s|, F_s = minus the rate of change of the momentum of all links",
        section=_MOTOR,
        picture="shaking force",
    ),
    Text(
        name="rms_shaking_force",
        sentence="The root mean square, over a turn, of the force with which the moving links shake the frame.",
        formula="sqrt(mean of |F_s|^2 over the crank angle)",
        section=_MOTOR,
        picture="shaking force",
    ),
    Text(
        name="peak_shaking_moment",
        sentence="The greatest moment about the crank pivot with which the moving links twist the frame within a turn.",
        formula="max |M_s|, M_s = minus the rate of change of the angular momentum of all links",
        section=_MOTOR,
        picture="shaking moment",
    ),
    Text(
        name="rms_shaking_moment",
        sentence="The root mean square, over a turn, of the moment with which the moving links twist the frame.",
        formula="sqrt(mean of M_s^2 over the crank angle)",
        section=_MOTOR,
        picture="shaking moment",
    ),
)
