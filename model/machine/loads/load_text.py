"""A load in words: magnitudes, signs, effects and ranges, which `Load.text` combines."""

import math
import re
from collections.abc import Iterable, Sequence

Ways = tuple[str, str]
SLIDES: Ways = ("outward", "inward")
TURNS: Ways = ("counter-clockwise", "clockwise")


_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]\d+)?")
_SEPARATORS = re.compile(r"([ ,;()]+)")


def join_range_ends(low: str, high: str) -> str:
    """Return one text for both ends of a range: "200 to 400 N" if only numbers differ.

    Texts that differ otherwise are shown side by side.
    """
    words = [_SEPARATORS.split(text) for text in (low, high)]
    pairs = list(zip(*words, strict=False))
    alike = len(words[0]) == len(words[1])
    if alike and all(
        low_word == high_word or (_NUMBER.fullmatch(low_word) and _NUMBER.fullmatch(high_word))
        for low_word, high_word in pairs
    ):
        return "".join(
            low_word if low_word == high_word else " to ".join(sorted((low_word, high_word), key=float))
            for low_word, high_word in pairs
        )
    return f"{low}; at the other end of the range {high}"


def force_magnitude_text(forces: Iterable[float], unit: str = "N", ways: Ways = SLIDES) -> str:
    """Return magnitudes and directions: "350 N outward", "up to 600 N inward".

    ways: words for positive and negative.
    """
    low, high = min(forces := tuple(forces)), max(forces)
    if low < 0.0 < high:
        return f"{-low:.6g} {unit} {ways[1]} to {high:.6g} {unit} {ways[0]}"
    least, greatest = sorted((abs(low), abs(high)))
    if not greatest:
        return f"0 {unit}"
    start = "" if least == greatest else f"{least:.6g} to " if least else "up to "
    return f"{start}{greatest:.6g} {unit} {ways[0] if high > 0.0 else ways[1]}"


def without_end_zeros_at_steps(at: Sequence[float], forces: Sequence[float]) -> Sequence[float]:
    """Return the forces in a table, without a zero at either end that is followed or preceded by a step."""
    first = int(forces[0] == 0.0 and at[0] == at[1])
    last = int(forces[-1] == 0.0 and at[-1] == at[-2])
    return forces[first : len(forces) - last] or forces


def effect_in_strokes(outward: Sequence[float], inward: Sequence[float]) -> str:
    """Return the effect of forces, N outward, on each stroke: "helps the outward stroke"."""
    verbs = _effect_verb(outward), _effect_verb([-force for force in inward])
    if verbs[0] == verbs[1]:
        return f"{verbs[0]} both strokes" if verbs[0] else "no effect"
    return " and ".join(f"{verb} the {way} stroke" for verb, way in zip(verbs, SLIDES, strict=True) if verb)


def effect_by_direction(forces: Sequence[float], ways: Ways, motion: str) -> str:
    """Return the effect of forces on motion in either direction. motion: "motion" or "rotation"."""
    low, high = min(forces), max(forces)
    if low < 0.0 < high:
        return "helps or resists depending on the crank angle"
    helped, resisted = ways if high > 0.0 else ways[::-1]
    return f"helps {helped} and resists {resisted} {motion}" if low or high else "no effect"


def spring_effect(stiffness: float) -> str:
    """Return the effect of a spring on motion away from its free position, and back."""
    away, back = ("resists", "helps") if stiffness >= 0.0 else ("helps", "resists")
    return f"{away} motion away from there and {back} motion back, no net work over a cycle"


def _effect_verb(forces: Sequence[float]) -> str:
    """Return the verb for forces along the motion: "helps", "resists", both, or none."""
    helps, resists = max(forces) > 0.0, min(forces) < 0.0
    if helps and resists:
        return "partly helps and partly resists"
    return "helps" if helps else "resists" if resists else ""


def range_of_positions(positions: Sequence[float], forces: Sequence[float], datum: str, during: str) -> str:
    """Return the range of a table over position, m from its datum, and the force beyond it."""
    low, high = (f"{1e3 * end:.6g} mm" for end in (positions[0], positions[-1]))
    inner_end = datum == "crank pivot" or positions[0] > 0.0
    towards = (datum, during) in (("outer dead centre", "outward stroke"), ("inner dead centre", "inward stroke"))
    if datum == "crank pivot":
        place = f"between {low} and {high} from the crank pivot"
    elif during == "cycle":
        place = f"from {low} to {high} from the {datum}" if inner_end else f"within {high} of the {datum}"
    elif towards:
        place = f"from {high} to {low} before the {datum}" if inner_end else f"from {high} before the {datum} to it"
    else:
        place = f"from {low} to {high} after the {datum}" if inner_end else f"from the {datum} to {high} after it"
    if len(set(forces)) == 1 and forces[0]:
        return f"{place}; constant beyond, hence everywhere"
    near, far = ("zero" if not end else force_magnitude_text((end,)) for end in (forces[0], forces[-1]))
    return f"{place}; {near} nearer and {far} beyond" if inner_end and near != far else f"{place}; {far} beyond"


def range_of_angles(angles: Sequence[float], datum: str, cycle: str) -> str:
    """Return a table's range over the crank angle, rad from its datum, and its cycle."""
    low, high = (f"{math.degrees(end):.6g}" for end in (angles[0], angles[-1]))
    after = "of crank angle" if datum == "zero crank angle" else f"after the {datum}"
    return f"from {low} to {high} deg {after}; periodic over {cycle}"
