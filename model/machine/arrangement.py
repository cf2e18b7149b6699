"""Several identical cylinders on one crankshaft: angles between their cranks, bank angles, positions along the shaft.

Cylinder k has its crank at the angle theta + phase_k and its slider line rotated by bank_k about the shaft, both
counter-clockwise. Its position is that of a single machine at the crank angle theta + phase_k - bank_k, rotated by
bank_k. All cylinders have the same crank, counterweight, rod, slider, loads and friction.
"""

import math
from dataclasses import dataclass

from ..checks import require_all_finite, store_as_tuples
from ..errors import InputError

MOST = 24
_SAME = 1e-9  # rad
_TURN = 2.0 * math.pi


@dataclass(frozen=True, kw_only=True)
class Arrangement:
    """Identical cylinders on one crankshaft.

    phases: angle of each crank from the shaft's zero, counter-clockwise, rad. banks: angle of each slider line from +x,
    counter-clockwise, rad; all zero by default. places: positions of the cylinders along the shaft, m, positive towards
    a viewer who sees these angles as counter-clockwise; all in one plane by default.
    """

    phases: tuple[float, ...]
    banks: tuple[float, ...] = ()
    places: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        store_as_tuples(self, "phases", "banks", "places")
        for name in ("phases", "banks", "places"):
            require_all_finite(f"{name} of cylinders", getattr(self, name))
        count = len(self.phases)
        if not 1 <= count <= MOST:
            raise InputError(
                f"the number of cylinders must be 1 to {MOST}; got {count} phases; give a phase for each cylinder"
            )
        for name in ("banks", "places"):
            number = len(getattr(self, name))
            if number not in (0, count):
                raise InputError(
                    f"cylinders must have as many {name} as phases; got {number} {name} and {count} phases; give "
                    f"one for each cylinder, or leave out {name}"
                )
        for k in range(count):
            for i in range(k):
                self._require_distinct_cylinders(i, k)

    def _require_distinct_cylinders(self, i: int, k: int) -> None:
        """Raise an error if two cylinders at the same position have the same phase and bank."""
        angles = self.phases[k] - self.phases[i], self.bank_angle(k) - self.bank_angle(i)
        if self.shaft_position(i) == self.shaft_position(k) and all(
            abs(math.remainder(angle, _TURN)) <= _SAME for angle in angles
        ):
            bank_text = f", both in the bank at {math.degrees(self.bank_angle(k)):.6g} deg" if self.banks else ""
            raise InputError(
                f"cylinders at one place must differ in phase or bank; got {math.degrees(self.phases[i]):.6g} deg "
                f"for cylinder {i + 1} and {math.degrees(self.phases[k]):.6g} deg for cylinder {k + 1}{bank_text}; "
                "change one of them, or give all their places along the shaft"
            )

    def bank_angle(self, k: int) -> float:
        """Return the bank angle of cylinder k, rad."""
        return self.banks[k] if self.banks else 0.0

    def shaft_position(self, k: int) -> float:
        """Return the position of cylinder k along the shaft, m."""
        return self.places[k] if self.places else 0.0

    def lead_over_slider_line(self, k: int) -> float:
        """Return the lead of cylinder k's crank angle, from its own slider line, over the shaft angle, rad."""
        return self.phases[k] - self.bank_angle(k)

    @property
    def text(self) -> str:
        """A short description of the cylinders."""
        lists = [f"{len(self.phases)} cylinders at {_angles_text(self.phases)} deg"]
        lists += [f"banks {_angles_text(self.banks)} deg"] if self.banks else []
        lists += [f"at {', '.join(f'{1e3 * at:.6g}' for at in self.places)} mm along the shaft"] if self.places else []
        return ", ".join(lists)


def _angles_text(angles: tuple[float, ...]) -> str:
    return ", ".join(f"{math.degrees(angle):.6g}" for angle in angles)


def require_one_cylinder(arrangement: Arrangement | None, subject: str) -> None:
    """Raise `InputError` for several cylinders. subject: the analysis, as the subject of the message."""
    if arrangement is not None and len(arrangement.phases) > 1:
        raise InputError(
            f"{subject} accepts only a machine with one cylinder; got {arrangement.text}; leave out cylinders to "
            "study a single one, or see analyse --show cylinders"
        )
