"""Table of docs/motions.md: what is refused on which motion, and why, as the code says it.

`python -m tests.service.table_of_motions` writes it anew.
"""

from __future__ import annotations

import copy
import re
import warnings
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any

import slidercrank as sc
from slidercrank.model.errors import InputError, InputWarning
from slidercrank.objectives.lever_quantity import LeverQuantity
from slidercrank.objectives.registry import FACTS
from slidercrank.optimise.certificate.box_conditions import unbounded_reason
from slidercrank.optimise.problem.requirements import Objective, Sense
from tests.service import sized

Motion = str
Refusals = dict[str, str]
"""Why each of several names is refused; empty where it works."""

FILE = Path(__file__).parents[2] / "docs" / "motions.md"
DESIGN = (0.04, 0.14, 0.02)

BASE: dict[str, Any] = {
    **sized.TABLES,
    "name": "Motions",
    "mechanism": {
        **sized.TABLES["mechanism"],
        "speed": "300 rpm",
        "slider": {"mass": "2 kg", "touch_distance": "7 mm", "dwell_distance": "2 mm", "guide_distance": "90 mm"},
        "counterweight": {"mass": "1 kg", "radius": "41 mm"},
        "gravity": "9.81 m/s^2",
    },
    "sections": {**sized.TABLES["sections"], "wear_coefficient": "1e-9 mm^2/N"},
    "load": [
        {"force": "60 N", "opposes": "motion"},
        {"bore": "30 mm", "suction": "1 bar", "discharge": "4 bar", "clearance": 0.1},
    ],
    "drive": {
        "motor": {"stall_torque": "60 N m", "no_load_speed": "330 rpm"},
        "flywheel": "0.5 kg m^2",
        "motor_inertia": "5 kg cm^2",
        "greatest_torque": "90 N m",
        "rated_torque": "30 N m",
        "greatest_speed": "600 rpm",
    },
    "target_motion": {
        "crank_angles": ["0 deg", "90 deg", "180 deg", "270 deg"],
        "positions": ["180 mm", "140 mm", "100 mm", "140 mm"],
    },
    "variables": {"crank": ["35 mm", "45 mm"], "rod": ["130 mm", "150 mm"], "offset": ["15 mm", "25 mm"]},
    "constraints": {},
    "objectives": {"peak_torque": "minimise", "footprint": "minimise"},
    "optimiser": {"method": "sobol", "evaluations": 64, "designs": 3, "seed": 1},
}
_SECOND = {"crank_angles": ["0 deg", "360 deg", "700 deg"], "forces": ["0 N", "90 N", "20 N"], "cycle": "720 deg"}
_SWING = {"kind": "swing", "from": "30 deg", "to": "110 deg", "law": "harmonic", "duration": "2 s"}


def _swing(tables: dict[str, Any], driver: str) -> None:
    tables["motion"] = {**_SWING, "driver": driver}
    tables["load"] = tables["load"][:1]
    for key in ("drive", "target_motion"):
        tables.pop(key)
    tables["mechanism"]["slider"] = {"mass": "2 kg"}
    of_driver = {"crank": ("peak_actuator_torque", "swing_position_error")}
    names = of_driver.get(driver, ("peak_actuator_force", "swing_angle_error"))
    tables["objectives"] = dict.fromkeys(names, "minimise")


def _lever(tables: dict[str, Any]) -> None:
    for key in ("load", "drive", "target_motion", "sections", "costs"):
        tables.pop(key, None)
    tables["mechanism"] = {
        **{"inversion": "turning cylinder", "frame_angle": "-40 deg"},
        **{"crank": {"mass": "2 kg"}, "counterweight": {"mass": "1 kg", "radius": "41 mm"}, "gravity": "9.81 m/s^2"},
    }
    tables["motion"] = dict(_SWING)
    tables["cylinder"] = {
        **{"bore": "16 mm", "rod": "8 mm", "supply_pressure": "200 bar", "closed_length": "100 mm", "stroke": "90 mm"},
    }
    tables["tolerances"] = {"crank": "0.05 mm"}
    tables["objectives"] = dict.fromkeys(("peak_cylinder_force", "lever_angle_error"), "minimise")


def _arm(tables: dict[str, Any]) -> None:
    _lever(tables)
    for key in ("motion", "tolerances"):
        tables.pop(key)
    tables["cylinder"].pop("supply_pressure")
    tables["mechanism"]["speed"] = "300 rpm"
    tables["arm"] = {"inertia": "0.01 kg m^2", "torque": "2 N m", "ram": "200 mm"}
    tables["objectives"] = dict.fromkeys(("arm_swing", "peak_crank_torque"), "minimise")


MOTIONS: dict[str, Callable[[dict[str, Any]], object]] = {
    "one turn": lambda tables: None,
    "720 deg": lambda tables: tables["load"].append(_SECOND),
    "several cylinders": lambda tables: tables["mechanism"].update(
        cylinders={"phases": ["0 deg", "120 deg"], "places": ["-50 mm", "50 mm"]}
    ),
    "speed profile": lambda tables: tables["mechanism"].update(speed_profile={"cosines": [0.0, 0.05]}),
    "crank acceleration": lambda tables: tables["mechanism"].update(acceleration="9 rad/s^2"),
    "swing, driven crank": partial(_swing, driver="crank"),
    "swing, driven slider": partial(_swing, driver="slider"),
    "lever": _lever,
    "arm, turned by the crank": _arm,
    "sections and pins": lambda tables: tables["variables"].update(
        {"mechanism.rod.width": ["28 mm", "32 mm"], "sections.pins.crank_pin": ["10 mm", "13 mm"]}
    ),
    "a choice": lambda tables: tables["variables"].update({"mechanism.slider.mass": {"choices": ["2 kg", "3 kg"]}}),
}


@cache
def _problem(motion: Motion, friction: float) -> sc.Problem:
    """Return the problem of a motion."""
    tables = copy.deepcopy(BASE)
    if friction:
        tables["friction"] = {"guide": friction}
    MOTIONS[motion](tables)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return sc.problem(tables, require_feasible=False)


def _chosen_problem(motion: Motion, friction: float) -> sc.Problem:
    return _problem(motion, friction).parts()[0]


def _design(problem: sc.Problem) -> list[float]:
    return [*DESIGN, *(0.5 * (item.lower + item.upper) for item in problem.mechanism.varying)]


def _refusal(ask: Callable[[float], object]) -> str:
    """Return why something is refused with and without friction; empty if it is answered with either."""
    reason = ""
    for friction in (0.05, 0.0):
        try:
            ask(friction)
        except (InputError, sc.AssemblyError) as error:
            reason = str(error)
        else:
            return ""
    return reason


def quantities(motion: Motion) -> Refusals:
    """Return why each quantity is refused on a motion."""

    def ask(name: str, friction: float) -> None:
        problem = _chosen_problem(motion, friction)
        value = problem.evaluate([_design(problem)], [name])[0, 0]
        reason = problem.quantity(name).undefined_because([problem.mechanism])
        if reason is not None:
            raise InputError(reason)
        assert value == value, name

    return {name: _refusal(partial(ask, name)) for name in FACTS}


def _bound(motion: Motion, name: str, friction: float) -> None:
    problem = _chosen_problem(motion, friction)
    senses: tuple[Sense, ...] = ("minimise", "maximise")
    reasons = [unbounded_reason(problem, Objective(quantity=name, sense=sense)) for sense in senses]
    if all(reasons):
        raise InputError(reasons[0])


def certificates(motion: Motion) -> Refusals:
    """Return why each quantity that works on a motion has no certificate."""
    works = [name for name, reason in quantities(motion).items() if not reason]
    return {name: _refusal(partial(_bound, motion, name)) for name in works}


def _rule(name: str, reason: str) -> str:
    """Return the rule of a refusal without value, remedy and the name of what is refused."""
    rule = reason.removeprefix(f"{name}: ").partition(";")[0].replace(f"is called '{name}'", "has this name")
    for words in (FACTS[name].title, name):
        rule = re.sub(rf"^{re.escape(words)}\b", "it", rule)
    return rule


def _names_in_words(names: list[str]) -> str:
    """Return names in words; all of a kind of motion as such."""
    levers = {name for name, fact in FACTS.items() if isinstance(fact, LeverQuantity)}
    arms = {name for name, fact in FACTS.items() if isinstance(fact, LeverQuantity) and "cylinder" not in fact.moved_by}
    every = {
        "all quantities of a lever": levers - arms,
        "all quantities of an arm": arms,
        "all quantities of a swing": {name for name, fact in FACTS.items() if fact.table == "motion"} - levers,
        "all quantities of a crank that rotates fully": {name for name, fact in FACTS.items() if fact.turning}
        - {name for name, fact in FACTS.items() if fact.table},
    }
    words = [words for words, of in every.items() if of.issubset(names)]
    rest = [name for name in names if not any(name in every[of] for of in words)]
    return ", ".join([*(f"`{name}`" for name in rest), *words])


def table(of: Callable[[Motion], Refusals]) -> str:
    """Return a table of the refusals and the motions on which they are, in Markdown."""
    motions: dict[tuple[str, str], list[str]] = {}
    for motion in MOTIONS:
        for name, reason in of(motion).items():
            if reason:
                motions.setdefault((name, _rule(name, reason)), []).append(motion)
    names: dict[tuple[str, str], list[str]] = {}
    for (name, rule), on in motions.items():
        names.setdefault((rule, "; ".join(on)), []).append(name)
    rows = [f"| {_names_in_words(refused)} | {rule} | {on} |" for (rule, on), refused in names.items()]
    return "\n".join(["| rejected | reason | on |", "|---|---|---|", *rows]) + "\n"


TABLES = {"quantities": quantities, "certificates": certificates}


def section(name: str, text: str) -> tuple[str, str, str]:
    """Return the text before a table of the page, the table, and the text after it."""
    before, begin, rest = text.partition(f"<!-- {name} -->\n\n")
    inside, end, after = rest.partition(f"\n<!-- end of {name} -->\n")
    return before + begin, inside, end + after


def main() -> None:
    """Write the tables anew."""
    for name, of in TABLES.items():
        before, _, after = section(name, FILE.read_text(encoding="utf-8"))
        FILE.write_text(before + table(of) + after, encoding="utf-8")


if __name__ == "__main__":
    main()
