r"""Position, velocity and acceleration of every point on the linkage: the notation used throughout the project.

                       A  crank pin
                      / \
              crank r/   \  connecting rod l
                    /     \
          theta    /       \
        ----------O---------\------------------> x      O  crank pivot, the origin
                             \  phi
        - - - - - - - - - - - B - - - slider - - -      slider line y = e (offset, signed)

The crank angle `theta` is counted counter-clockwise from +x, and so is the rod angle `phi` of A -> B:

    r sin(theta) + l sin(phi) = e,        x = r cos(theta) + l cos(phi).

The open branch has cos(phi) > 0 (slider to the right), the crossed branch cos(phi) < 0. `branch` is +1 or -1.
*Outward* means away from the crank pivot. A positive speed turns the crank counter-clockwise. SI units and radians.

Primes are derivatives with respect to the crank angle: velocity = x' w, acceleration = x'' w^2 + x' alpha.
"""

from typing import Any, NamedTuple

from ..kernel.arithmetic import analytic, inverse, root


class Motion(NamedTuple):
    """Motion of the linkage at one crank angle, per unit of crank angle.

    l_cos, l_sin: components l cos(phi), l sin(phi) of the rod vector A -> B, m. per_l_cos: 1 / l_cos.
    tangent: tan(phi).
    rod_1, rod_2: phi' and phi''.
    x, x_1, x_2: slider position, m, with its first and second derivative, m/rad and m/rad^2.
    """

    l_cos: Any
    l_sin: Any
    per_l_cos: Any
    tangent: Any
    rod_1: Any
    rod_2: Any
    x: Any
    x_1: Any
    x_2: Any


@analytic
def motion(sine: Any, cosine: Any, r: Any, l: Any, e: Any, branch: Any) -> Motion:
    """Return the `Motion` from sine and cosine of the crank angle, r, l, e (m) and branch (+1, -1).

    Differentiating the two loop equations once and twice gives
    phi' = -r cos(theta) / (l cos(phi)),  phi'' = (r sin(theta) + l sin(phi) phi'^2) / (l cos(phi)),
    x' = -r sin(theta) - l sin(phi) phi',  x'' = -r cos(theta) - l cos(phi) phi'^2 - l sin(phi) phi''.
    Requires l > |e - r sin(theta)| (the linkage can be assembled at this angle).
    """
    l_sin = e - r * sine
    return motion_from_rod_vector(sine, cosine, r, l_sin, branch * root(l * l - l_sin * l_sin))


@analytic
def motion_from_rod_vector(sine: Any, cosine: Any, r: Any, l_sin: Any, l_cos: Any) -> Motion:
    """Return the `Motion` from sine and cosine of the crank angle, crank r and the rod vector's components, m."""
    per_l_cos = inverse(l_cos)
    tangent = l_sin * per_l_cos
    rod_1 = -r * cosine * per_l_cos
    rod_2 = r * sine * per_l_cos + rod_1 * rod_1 * tangent
    x = r * cosine + l_cos
    x_1 = -r * sine - l_sin * rod_1
    x_2 = -r * cosine - l_cos * rod_1 * rod_1 - l_sin * rod_2
    return Motion(l_cos, l_sin, per_l_cos, tangent, rod_1, rod_2, x, x_1, x_2)


@analytic
def third_slider_derivative(sine: Any, cosine: Any, m: Motion, r: Any) -> Any:
    """Return x''', the third derivative of the slider position with respect to crank angle, m/rad^3.

    With a = l cos(phi), b = l sin(phi): phi''' = (r cos(theta) + a phi'^3 + 3 b phi' phi'') / a and
    x''' = r sin(theta) + b phi'^3 - 3 a phi' phi'' - b phi'''.
    """
    cube = m.rod_1 * m.rod_1 * m.rod_1
    bent = m.rod_1 * m.rod_2
    rod_3 = (r * cosine + m.l_cos * cube + 3.0 * m.l_sin * bent) * m.per_l_cos
    return r * sine + m.l_sin * cube - 3.0 * m.l_cos * bent - m.l_sin * rod_3
