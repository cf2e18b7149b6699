"""Texts of the quantities that follow from geometry and motion alone, and of the position error."""

from __future__ import annotations

from .text import Text

_CLOSED = "2. Closed forms"
_ERROR = "R. Chetana and T. V. Vineeth Kumar, Analysis of Position Error in Offset Slider Crank Mechanism, Eq. (3)"

GEOMETRY = (
    Text(
        name="crank",
        sentence="The crank is the link that the motor turns; its length r runs from the crank pivot to the crank pin.",
        advice="It sets the stroke, which is twice the crank without offset and a little more with one.",
        formula="r; from a stroke S: r^2 = S^2 (l^2 - e^2 - S^2/4) / (4 l^2 - S^2)",
        section=_CLOSED,
        picture="crank",
    ),
    Text(
        name="rod",
        sentence="The connecting rod joins crank pin and slider pin; its length l runs between the two pin centres.",
        advice="A long rod transmits force well and moves evenly; a short one is lighter and more compact.",
        formula="l; the crank turns fully if l > r + |e|",
        section=_CLOSED,
        picture="rod",
    ),
    Text(
        name="offset",
        sentence=(
            "The offset e is the distance of the slider line from the crank pivot, positive to the left of the outward "
            "direction, on the crossed branch to its right; it makes one stroke slower than the other."
        ),
        advice="The more offset, the higher the time ratio, and the smaller the transmission angle.",
        formula="e; the slider line is y = e",
        section="1. Notation and signs",
        picture="offset",
    ),
    Text(
        name="time_ratio",
        sentence=(
            "The time ratio says how many times longer the slower stroke takes than the faster one while the crank "
            "turns steadily: 1 without offset, more for a quick return."
        ),
        advice="Which stroke is the slow one follows from the sign of the offset and from the direction of rotation.",
        formula="Q = (180 deg + |b|) / (180 deg - |b|) with the excess angle b = arcsin(e/(l-r)) - arcsin(e/(l+r))",
        section=_CLOSED,
        picture="time ratio",
    ),
    Text(
        name="transmission_angle",
        sentence=(
            "The transmission angle is the angle between the rod and the normal of the slider line; its least value "
            "over the turn says how well the rod pushes the slider along instead of against its guide."
        ),
        advice="90 deg is ideal; least values of 30 to 50 deg are usual. A longer rod raises it, offset lowers it.",
        formula="cos(mu_min) = (r + |e|) / l",
        section=_CLOSED,
        picture="transmission angle",
    ),
    Text(
        name="stroke",
        sentence="The stroke is the way of the slider from one dead centre to the other.",
        advice="It equals twice the crank only without offset.",
        formula="S = sqrt((l+r)^2 - e^2) - sqrt((l-r)^2 - e^2)",
        section=_CLOSED,
        picture="stroke",
    ),
    Text(
        name="rod_to_offset",
        sentence="The length of the rod divided by the size of the offset: a rule such as rod = 3.2 offset.",
        advice="Held at one value it leaves one choice fewer, and the search meets it exactly.",
        formula="l / |e|, infinite without offset",
        section=_CLOSED,
        picture="offset",
    ),
    Text(
        name="rod_to_crank",
        sentence="The length of the rod divided by that of the crank; the higher, the more evenly the slider moves.",
        formula="l / r",
        section=_CLOSED,
        picture="rod",
    ),
    Text(
        name="footprint",
        sentence="The footprint is the area of the rectangle that the pin centres need over a whole turn.",
        formula="(x_out + r) (r + max(r, |e|)) with x_out = sqrt((l+r)^2 - e^2)",
        section=_CLOSED,
        picture="footprint",
    ),
    Text(
        name="peak_slider_speed",
        sentence="The highest speed that the slider reaches within a turn, whichever way it goes.",
        advice="It grows with the stroke and in proportion to the crank speed.",
        formula="max |x' omega| with x' = -r sin(theta - phi) / cos(phi)",
        section="3. Kinematics",
        picture="speed",
    ),
    Text(
        name="peak_slider_acceleration",
        sentence="The greatest acceleration of the slider within a turn, from which its inertia force follows.",
        advice="It grows with the square of the crank speed.",
        formula="max |x'' omega^2 + x' alpha|",
        section="3. Kinematics",
        picture="acceleration",
    ),
    Text(
        name="position_error",
        sentence=(
            "How far the slider may be from where it should be when crank, rod, offset and crank angle are all off by "
            "their tolerances in the worst combination: the greatest value over the cycle."
        ),
        advice="It comes from the tolerances alone: without tolerances there is none.",
        formula="max over theta of the sum of |dx/di| T_i, for i = crank, rod, offset, crank angle",
        section="12. Position error",
        source=_ERROR,
        picture="position error",
    ),
    Text(
        name="position_error_rss",
        sentence=(
            "The position error to be expected where deviations are independent of each other, so that they seldom "
            "add up: the root of the sum of their squares."
        ),
        advice="With the four tolerances alone it is at least half of the worst case, and never more than it.",
        formula="max over theta of sqrt(sum of (dx/di T_i)^2)",
        section="12. Position error",
        source=_ERROR,
        picture="position error",
    ),
    Text(
        name="motion_deviation",
        sentence="The greatest distance between the slider and the points of the wanted motion.",
        formula="max over the points of |x(theta_i + psi) + s - t_i|; psi and s zero, or the best where free",
        section="12. Position error",
        source="derived there",
        picture="wanted motion",
    ),
    Text(
        name="motion_deviation_rms",
        sentence="The distance between the slider and the points of the wanted motion, as a root mean square.",
        advice="One point that is far off counts less than in the greatest deviation.",
        formula="sqrt(mean of (x(theta_i + psi) + s - t_i)^2)",
        section="12. Position error",
        source="derived there",
        picture="wanted motion",
    ),
)
