"""Counterweight for minimum shaking, and the shaking before and after: numbers, text and figure."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any

import numpy as np

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import FORCE, LENGTH, MASS, TORQUE, display_unit
from ....optimise.problem.problem import Problem
from ....optimise.sizing.counterweight import Balance, RodSpace, Shaking, best_balance
from ....optimise.sizing.input_words import Measure
from ...figures.panel_figure import Line, Panel, PanelFigure, crank_angle_panel
from ...render.blocks import (
    Block,
    NamedNumber,
    Text,
    Unit,
    Value,
    joined,
    note,
    number_list,
    remark_with_value,
    value_from_record,
    words,
)
from ...render.numerals import format_number
from ..record_types import Note, Record, ShakingNumbers
from . import QUESTION


class RodBalance(Record):
    """Mass added to the rod; its centre is measured along and across the rod from the crank pin."""

    mass_kg: float
    moment_along_kg_m: float
    moment_across_kg_m: float
    inertia_kg_m2: float
    """Moment of inertia about the crank pin."""
    centre_along_mm: Annotated[float | None, Note("null where nothing is added")]
    centre_across_mm: Annotated[float | None, Note("null where nothing is added")]


class BalanceNumbers(Record):
    """Counterweight for minimum shaking, and a balance mass on the rod."""

    measure: Measure
    """Quantity that is minimal over the cycle."""
    counterweight_moment_kg_m: float
    """Mass times radius."""
    counterweight_angle_deg: float
    """From the crank."""
    counterweight_radius_mm: float
    counterweight_kg: float
    rod_balance: Annotated[RodBalance | None, Note("null where none is allowed")]
    before: ShakingNumbers
    after: ShakingNumbers
    objective_N: float
    least_possible_N: float
    """Proven lower bound of the objective."""
    saving_N_per_kg: float
    """Saving in the objective if the counterweight is at its maximum mass; otherwise 0."""
    rounds: int
    converged: bool
    """Whether the objective is proven to be minimal."""


_SAMPLES = 1441


def compute_shared_options(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    words: Mapping[str, str] | None = None,
    measure: Measure = "peak",
    radius: float | None = None,
    mass: float | None = None,
    arm: float | None = None,
    **inputs: Any,
) -> dict[str, Any]:
    """Return the balance that numbers and figure share. inputs: remaining inputs, in SI."""
    at = radius or mechanism.counterweight.radius or float(linkage.crank)
    optimum = best_balance(
        mechanism,
        linkage,
        measure=measure,
        arm=arm,
        radius=at,
        greatest_moment=None if mass is None else mass * at,
        rod=_rod_balance_space(inputs, words or {}),
    )
    return {"optimum": optimum}


def _rod_balance_space(inputs: Mapping[str, Any], labels: Mapping[str, str]) -> RodSpace | None:
    """Return the space for a balance mass on the rod. Raises `InputError` if only one of radius and mass is given."""
    names = [item.name for item in QUESTION.inputs if item.name.startswith("rod_")]
    (first, radius), (second, mass) = ((labels.get(name, name), inputs.get(name)) for name in names)
    if radius is None and mass is None:
        return None
    if radius is None or mass is None:
        have, need = (second, first) if radius is None else (first, second)
        raise InputError(f"a balance mass on the rod needs {first} and {second}; got only {have}; add {need}")
    return RodSpace(radius=radius, mass=mass)


def numbers(
    _: Mechanism, __: Linkage, *, optimum: Balance, measure: Measure = "peak", **options: Any
) -> BalanceNumbers:
    """Return a balance ready for JSON; the angle of the counterweight is measured from the crank direction."""
    rod = optimum.rod
    weighs = rod is not None and rod.mass > 0.0
    return {
        "measure": measure,
        "counterweight_moment_kg_m": optimum.moment,
        "counterweight_angle_deg": float(np.degrees(optimum.angle)),
        "counterweight_radius_mm": 1e3 * optimum.radius,
        "counterweight_kg": optimum.mass,
        "rod_balance": None
        if rod is None
        else {
            "mass_kg": rod.mass,
            "moment_along_kg_m": rod.moment_along,
            "moment_across_kg_m": rod.moment_across,
            "inertia_kg_m2": rod.inertia,
            "centre_along_mm": 1e3 * rod.moment_along / rod.mass if weighs else None,
            "centre_across_mm": 1e3 * rod.moment_across / rod.mass if weighs else None,
        },
        "before": _shaking_numbers(optimum.shaking_before),
        "after": _shaking_numbers(optimum.shaking_after),
        "objective_N": optimum.objective,
        "least_possible_N": optimum.bound,
        "saving_N_per_kg": optimum.saving * optimum.radius,
        "rounds": optimum.rounds,
        "converged": optimum.converged,
    }


def notes(numbers: BalanceNumbers) -> list[str]:
    """Return a note if the optimum is not proven."""
    proven = f"{numbers['objective_N']:.6g} N, and at least {numbers['least_possible_N']:.6g} N is unavoidable"
    return [] if numbers["converged"] else [f"not proven to be the best: {proven}"]


def _shaking_numbers(shaking: Shaking) -> ShakingNumbers:
    return {
        "peak_shaking_force_N": shaking.peak_force,
        "peak_shaking_force_angle_deg": float(np.degrees(shaking.peak_force_angle)),
        "rms_shaking_force_N": shaking.rms_force,
        "peak_shaking_moment_Nm": shaking.peak_moment,
        "peak_shaking_moment_angle_deg": float(np.degrees(shaking.peak_moment_angle)),
        "rms_shaking_moment_Nm": shaking.rms_moment,
    }


def blocks(numbers: BalanceNumbers) -> list[Block]:
    """Return the answer in human-readable form."""
    mass, radius, angle = (
        value_from_record(numbers, f"counterweight_{key}") for key in ("kg", "radius_mm", "angle_deg")
    )
    moment = value_from_record(numbers, "counterweight_moment_kg_m")
    saving = numbers["saving_N_per_kg"]
    remark: Text = ""
    if saving:
        inch = FORCE.display_unit("inch").factor / MASS.display_unit("inch").factor
        per_mass = replace(FORCE, metric=display_unit("N"), inch=display_unit("lbf", inch))
        text = "at its maximum; each further {unit} would save {saving}"
        remark = words(text, unit=Unit(MASS), saving=Value(saving, per_mass, 4))
    lines: list[NamedNumber] = [
        ("counterweight: mass times radius", moment, remark),
        ("its angle from the crank", angle, "180 deg is opposite the crank pin"),
        ("its mass", mass, words("at {radius} from the crank pivot", radius=radius)),
    ]
    rod = numbers["rod_balance"]
    if rod is not None:
        lines += [
            ("added to the rod", value_from_record(rod, "mass_kg"), _centre_text(rod)),
            ("its inertia about the crank pin", value_from_record(rod, "inertia_kg_m2"), ""),
        ]
    for name, unit in (("shaking_force", "N"), ("shaking_moment", "Nm")):
        for statistic in ("peak", "rms"):
            key, called = f"{statistic}_{name}_{unit}", name.replace("_", " ")
            title = f"RMS {called} over time" if statistic == "rms" else f"{statistic} {called}"
            lines.append(
                (title, value_from_record(numbers["after"], key), remark_with_value(numbers["before"], key, "before"))
            )
    line = '  in the job: counterweight = {{ mass = "{mass}", radius = "{radius}", angle = "{angle}" }}'
    return [
        *number_list(f"Balance with least {numbers['measure']} shaking (moment about the crank pivot)", lines),
        note(line, mass=mass, radius=radius, angle=angle),
    ]


def _centre_text(rod: RodBalance) -> Text:
    along_mm, across_mm = rod["centre_along_mm"], rod["centre_across_mm"]
    if along_mm is None or across_mm is None:
        return ""
    places = {"along": Value(1e-3 * round(along_mm, 3), LENGTH), "across": Value(1e-3 * round(across_mm, 3), LENGTH)}
    return words("mass centre {along} along and {across} across the rod", **places)


def figure(_: Mechanism, __: Linkage, *, optimum: Balance, problem: Problem, **options: Any) -> PanelFigure:
    """Return the hodograph and the force before and after, and the moment if a rod balance changes it."""
    theta = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    degrees = np.degrees(theta)
    curves = list(enumerate(zip(("before", "after"), optimum.shaking_before_and_after(theta), strict=True)))
    hodographs = tuple(Line(name, shaking.force_x, shaking.force_y, n) for n, (name, shaking) in curves)
    sizes = (Line(name, degrees, np.hypot(shaking.force_x, shaking.force_y), n) for n, (name, shaking) in curves)
    x_title = words("horizontal: along the slider line, {unit}; vertical: across it", unit=Unit(FORCE))
    panels = [
        Panel("hodograph of the shaking force", x_title, hodographs, kind=FORCE, x_kind=FORCE, equal=True),
        crank_angle_panel("size of the shaking force", *sizes, kind=FORCE),
    ]
    angle = format_number(float(np.degrees(optimum.angle)) % 360.0)
    mass, radius = Value(optimum.mass, MASS, 4), Value(optimum.radius, LENGTH, 4)
    parts: list[Text] = [
        words(f"counterweight {{mass}} at {{radius}}, {angle}° from the crank", mass=mass, radius=radius)
    ]
    if optimum.rod is not None:
        moments = (Line(name, degrees, shaking.moment, n) for n, (name, shaking) in curves)
        panels.append(crank_angle_panel("moment about the pivot", *moments, kind=TORQUE))
        added = words("{mass} added to the rod", mass=Value(optimum.rod.mass, MASS, 4))
        parts.append(added if optimum.rod.mass else "nothing added to the rod")
    return PanelFigure(
        f"{problem.name}: balance", joined(parts), tuple(panels), columns=len(panels), width=5.0, height=4.4
    )
