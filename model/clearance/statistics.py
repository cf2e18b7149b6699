"""Statistics over the crank turns of a run with a loose joint, each with its uncertainty."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..signals.peaks import find_peaks
from ..signals.signals import Signal
from .run import ClearanceRun

CONFIDENCE = 0.99


@dataclass(frozen=True)
class Estimate:
    """A mean over crank turns, with its uncertainty as an estimate of the long-run mean.

    uncertainty: half the width of the 99 % confidence interval, Student's t times s / sqrt(n) with s the standard
    deviation over the turns; None after one turn. The motion is usually chaotic: two runs that differ by a rounding
    error diverge after a few impacts. Single turns therefore do not repeat, and only such means can be compared. The
    difference of two means scatters sqrt(2) times as widely as either mean, so it lies within this width in at least 9
    of 10 comparisons. Turns are taken as independent; if the motion repeats after several turns, this overstates the
    uncertainty.
    """

    value: float
    uncertainty: float | None

    @classmethod
    def from_turns(cls, turns: Array) -> Estimate:
        """Return the estimate from one value per turn, (n,)."""
        n = len(turns)
        if n < 2:
            return cls(float(turns[0]), None)
        from scipy.stats import t

        factor = float(t.ppf(0.5 + 0.5 * CONFIDENCE, n - 1)) / math.sqrt(n)
        return cls(float(np.mean(turns)), factor * float(np.std(turns, ddof=1)))


@dataclass(frozen=True)
class ClearanceSummary:
    """Statistics over the turns after the first `discard` ones. SI.

    turns: number of counted turns. peak_acceleration: maximum slider acceleration in a turn, in magnitude, m/s^2;
    acceleration_ratio: the same divided by that of the ideal linkage. displacement_deviation: maximum distance from the
    ideal slider position in a turn, as a fraction of the stroke. velocity_deviation: likewise for the velocity, m/s.
    impacts: contacts begun per turn. contact_share: fraction of the time in contact. peak_contact_force: maximum in a
    turn, N. penetration: maximum in a turn, m. fastest_impact: maximum over all turns, m/s; None if there was none.
    input_work, load_work, dissipated, stored: energies per turn, J: work of the drive, work of the loads on the slider,
    loss in the joint, gain in kinetic, potential and elastic energy. energy_residual: maximum energy balance error in a
    turn, J.
    """

    turns: int
    peak_acceleration: Estimate
    acceleration_ratio: Estimate
    displacement_deviation: Estimate
    velocity_deviation: Estimate
    impacts: Estimate
    contact_share: Estimate
    peak_contact_force: Estimate
    penetration: Estimate
    fastest_impact: float | None
    input_work: Estimate
    load_work: Estimate
    dissipated: Estimate
    stored: Estimate
    energy_residual: float


def clearance_statistics(run: ClearanceRun) -> ClearanceSummary:
    """Return the statistics of a run. Raises `InputError` if no turn remains after discarding."""
    turns = run.cycles - run.discard
    if turns < 1:
        raise InputError(
            f"statistics need a complete turn after the first {run.discard}; got {run.cycles} turns; let it run longer"
        )
    marks = run.turn_time * np.arange(run.discard, run.cycles + 1)
    # Samples of one turn: from the last sample at its beginning to the first at its end.
    first = np.searchsorted(run.times, marks[:-1] * (1.0 + 1e-12), side="right") - 1
    last = np.searchsorted(run.times, marks[1:] * (1.0 - 1e-12), side="left")
    spans = [slice(int(a), int(b) + 1) for a, b in zip(first, last, strict=True)]

    def greatest(values: Array) -> Array:
        return np.array([np.abs(values[span]).max() for span in spans])

    def gain_per_turn(values: Array) -> Array:
        return np.array([values[b] - values[a] for a, b in zip(first, last, strict=True)])

    lengths = np.append(np.diff(run.times), 0.0)
    touching = np.cumsum(np.append(0.0, np.where(run.in_contact, lengths, 0.0)))[:-1]
    acceleration = greatest(run.slider_acceleration)
    linkage = run.linkage
    ideal = find_peaks(
        run.mechanism,
        Signal.SLIDER_ACCELERATION,
        np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]]),
        limit=1,
    ).values[0, 0]
    counted = run.impact_times >= marks[0]
    residual = [np.ptp(run.energy_residual[span]) for span in spans]
    return ClearanceSummary(
        turns=turns,
        peak_acceleration=Estimate.from_turns(acceleration),
        acceleration_ratio=Estimate.from_turns(acceleration / ideal),
        displacement_deviation=Estimate.from_turns(
            greatest(run.slider_position - run.ideal_position) / float(linkage.stroke)
        ),
        velocity_deviation=Estimate.from_turns(greatest(run.slider_velocity - run.ideal_velocity)),
        impacts=Estimate.from_turns(np.histogram(run.impact_times, marks)[0].astype(np.float64)),
        contact_share=Estimate.from_turns(gain_per_turn(touching) / run.turn_time),
        peak_contact_force=Estimate.from_turns(greatest(run.contact_force)),
        penetration=Estimate.from_turns(np.array([run.penetration[span].max() for span in spans])),
        fastest_impact=float(run.impact_speeds[counted].max()) if counted.any() else None,
        input_work=Estimate.from_turns(gain_per_turn(run.input_work)),
        load_work=Estimate.from_turns(gain_per_turn(run.load_work)),
        dissipated=Estimate.from_turns(gain_per_turn(run.dissipated)),
        stored=Estimate.from_turns(gain_per_turn(run.stored)),
        energy_residual=float(max(residual)),
    )
