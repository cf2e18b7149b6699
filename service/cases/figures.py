"""Figures of the five publications, redrawn: their data and their files."""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from ...model.arrays import Array
from ...model.classical.approximations import series_acceleration, series_torque
from ...model.classical.loop_equations import static_forces
from ..figures.panel_drawing import save_figure
from ..figures.panel_figure import CRANK_ANGLE, Line, Panel, PanelFigure, crank_angle_panel
from ..questions.clearance.figure import speed_runs, speeds_figure
from ..questions.polygons.analysis import polygon_panels, polygons_by_branch
from . import case_1, case_2, case_3, case_4, case_5

_TURN = np.linspace(0.0, 2.0 * math.pi, 721)
_SIEVE = "crank 140, rod 310, offset −60 mm, 300 rpm"


def draw_cases(numbers: Sequence[int], folder: Path) -> Iterator[Path]:
    """Write the case figures as case_<number>_<what>.png; yield each file as soon as it is written."""
    folder.mkdir(parents=True, exist_ok=True)
    for number in numbers:
        for name, make in FIGURES[number].items():
            path = folder / f"case_{number}_{name}.png"
            save_figure(make(), path)
            yield path


def polygon_figure() -> PanelFigure:
    """Return the polygons of case 1 (its Fig. 2)."""
    polygons = polygons_by_branch(
        case_1.case_linkage(), case_1.ANGLE, speed=case_1.SPEED, acceleration=case_1.ACCELERATION
    )
    return polygon_panels(
        polygons,
        title="Case 1: position, velocity and acceleration polygons (Boyle and Liu, Fig. 2)",
        subtitle="crank 3, rod 8, offset 2 (dimensionless); crank angle −30°, −15 rad/s, −10 rad/s²",
        units=("dimensionless", "1/s", "1/s²"),
    )


def labelled_curves_panel(
    title: str, *curves: tuple[str, Array], theta: Array = _TURN, styles: Sequence[int] = (0, 1, 2)
) -> Panel:
    """Return a panel of labelled curves over the crank angle, each in its own line style."""
    degrees = np.degrees(theta)
    lines = (Line(label, degrees, y, style) for style, (label, y) in zip(styles, curves, strict=False))
    return crank_angle_panel(title, *lines)


def sieve_figure() -> PanelFigure:
    """Return rod and slider motion of the sieve over the cycle (Figs. 4 to 6 and 19 of case 2)."""
    at = case_2.SIEVE.at(_TURN, speed=case_2.SPEED)
    panels = (
        labelled_curves_panel("slider position, mm", ("", 1e3 * at.slider_position)),
        labelled_curves_panel("rod angle, deg", ("", np.degrees(at.rod_angle))),
        labelled_curves_panel("slider velocity, m/s", ("", at.slider_velocity)),
        labelled_curves_panel("rod angular velocity, rad/s", ("", at.rod_velocity)),
        labelled_curves_panel("slider acceleration, m/s²", ("", at.slider_acceleration)),
        labelled_curves_panel("rod angular acceleration, rad/s²", ("", at.rod_acceleration)),
    )
    return PanelFigure(
        "Case 2: vibrating sieve over the cycle (ME748 report, Figs. 4 to 6 and 19)", _SIEVE, panels, columns=2
    )


def sensitivity_figure() -> PanelFigure:
    """Return slider motion with a longer crank and with a longer rod, one at a time (Figs. 7 to 12 of case 2)."""
    designs = (("as designed", case_2.SIEVE), ("crank 150 mm", case_2.LONGER_CRANK), ("rod 320 mm", case_2.LONGER_ROD))
    designed, *changed = ((name, linkage.at(_TURN, speed=case_2.SPEED)) for name, linkage in designs)
    panels = tuple(
        labelled_curves_panel(title, *((name, factor * getattr(at, field)) for name, at in (designed, variant)))
        for title, field, factor in (
            ("slider position, mm", "slider_position", 1e3),
            ("slider velocity, m/s", "slider_velocity", 1.0),
            ("slider acceleration, m/s²", "slider_acceleration", 1.0),
        )
        for variant in changed
    )
    return PanelFigure(
        "Case 2: one dimension changed at a time (ME748 report, Figs. 7 to 12)", _SIEVE, panels, columns=2
    )


def in_line_figure() -> PanelFigure:
    """Return paths, velocities and static forces of the in-line example (case 3)."""
    linkage = case_3.LINKAGE
    at = linkage.at(_TURN, speed=case_3.SPEED)
    pin = 1e3 * linkage.crank_point(_TURN, along=float(linkage.crank)).position
    forces = static_forces(linkage, _TURN, load=case_3.LOAD)
    x = 1e3 * at.slider_position
    paths = (Line("crank pin", pin[:, 0], pin[:, 1]), Line("slider pin", x, np.zeros_like(x), 1))
    panels = (
        Panel("paths: y, mm", "x, mm", paths, equal=True),
        labelled_curves_panel("slider position, mm", ("", x)),
        labelled_curves_panel(
            "angular velocities, rad/s", ("crank", np.full_like(x, case_3.SPEED)), ("rod", at.rod_velocity)
        ),
        labelled_curves_panel("slider velocity, m/s", ("", at.slider_velocity)),
        labelled_curves_panel(
            "static forces, N", ("rod, compression", forces.rod_force), ("guide", forces.guide_reaction)
        ),
        labelled_curves_panel("crank torque, N m", ("", forces.crank_torque)),
    )
    return PanelFigure(
        "Case 3: in-line slider-crank, motion and static forces (its formulas for one example)",
        "crank 50, rod 150 mm, no offset, 10 rad/s; 100 N on the slider towards the crank",
        panels,
        columns=2,
    )


def position_error_figure() -> PanelFigure:
    """Return the contributions to the position error, exact and as printed (Figs. 3 to 7 of case 4)."""
    printed = case_4.printed_table()
    at = printed["crank_angle_deg"]
    fine = np.linspace(at[0], at[-1], 361)
    exact = case_4.position_error_contributions(np.radians(fine))
    columns = dict(zip(case_4.COLUMNS, list(printed)[3:], strict=True))
    titles = {
        "crank": "from the crank, 0.1 %",
        "rod": "from the rod, 0.1 %",
        "offset": "from the offset, 0.1 %",
        "crank_angle": "from the crank angle, 0.1°",
        "total": "total, with signs",
    }
    panels = tuple(
        Panel(
            f"position error {titles[name]}, mm",
            CRANK_ANGLE,
            (Line("exact", fine, exact[name]), Line("printed", at, printed[columns[name]], points=True)),
        )
        for name in case_4.COLUMNS
    )
    return PanelFigure(
        "Case 4: position error (Chetana and Vineeth Kumar, Figs. 3 to 7)",
        "crank 1400, rod 1800, offset −50 mm, which fit Table 1; the printed crank-angle column is a misprint",
        panels,
        columns=2,
    )


def offset_figure() -> PanelFigure:
    """Return acceleration and inertia torque over two cycles for the three offsets (Figs. 15 to 18 of case 5)."""
    theta = np.linspace(0.0, 4.0 * math.pi, 2881)
    exact, formula = (partial(torque, crank_angle=theta) for torque in (case_5.exact_torque, case_5.formula_torque))
    two_turns = partial(labelled_curves_panel, theta=theta)
    centred = case_5.feeder_linkage(0.0)
    series = series_torque(
        centred, theta, speed=case_5.SPEED, reciprocating_mass=case_5.rotating_and_reciprocating_mass()[1]
    )

    def acceleration(offset: float) -> Array:
        acceleration_m_s2: Array = case_5.feeder_linkage(offset).at(theta, speed=case_5.SPEED).slider_acceleration
        return acceleration_m_s2

    def offsets_panel(title: str, curve: Callable[[float], Array]) -> Panel:
        return two_turns(title, *((f"e = {1e3 * offset:.0f} mm", curve(offset)) for offset in case_5.OFFSETS))

    panels = (
        offsets_panel("slider acceleration, exact, m/s²", acceleration),
        two_turns(
            "slider acceleration, e = 0, m/s²",
            ("exact", acceleration(0.0)),
            ("series, Eq. 52", series_acceleration(centred, theta, speed=case_5.SPEED)),
        ),
        offsets_panel("inertia torque, exact, N m", exact),
        offsets_panel("torque by k F tan(alpha), N m", formula),
        two_turns(
            "inertia torque, e = 0, N m",
            ("exact", exact(0.0)),
            ("series, Eq. 53", series),
            ("k F tan(alpha)", formula(0.0)),
        ),
        two_turns(
            "inertia torque, e = 20 mm, N m",
            ("exact", exact(0.020)),
            ("k F tan(alpha)", formula(0.020)),
            styles=(0, 2),  # same as in the previous panel
        ),
    )
    return PanelFigure(
        "Case 5: effect of the offset over two cycles (Obaseki and Alfred, Figs. 15 to 18)",
        "crank 40, rod 64 mm, 251 rad/s; 1.05 kg with the slider, 0.35 kg at the crank pin; offset −e",
        panels,
        columns=2,
        height=2.5,
    )


def clearance_figure() -> PanelFigure:
    """Return slider motion with a loose joint at three speeds (case 2); the simulation takes about 20 s."""
    return speeds_figure(speed_runs(case_2.LOOSE, case_2.SIEVE))


FIGURES: dict[int, dict[str, Callable[[], PanelFigure]]] = {
    1: {"polygons": polygon_figure},
    2: {"motion": sieve_figure, "sensitivity": sensitivity_figure, "clearance": clearance_figure},
    3: {"motion_and_forces": in_line_figure},
    4: {"position_error": position_error_figure},
    5: {"offset": offset_figure},
}
