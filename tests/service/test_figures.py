"""Figures: what they draw is what the model computes, and every kind of front can be drawn."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.load import Datum
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.mechanism import Mechanism, Tolerances
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.requirements import Objective
from slidercrank.service.figures.datasheet import Curves, cycle_curves, design_datasheet
from slidercrank.service.figures.design_marks import marked_designs
from slidercrank.service.figures.front_figures import write_front_figures
from slidercrank.service.figures.panel_figure import Panel, panel_in_units
from slidercrank.service.figures.parallel_coordinates import parallel_coordinates
from slidercrank.service.figures.scatter_matrix import scatter_matrix
from slidercrank.service.figures.style import add_axes, colour_map, new_figure, style_axes
from slidercrank.service.render.formatting import format_text
from slidercrank.service.render.numerals import format_number
from tests.service import fronts

LINKAGES = {
    "offset": Linkage(0.14, 0.31, 0.06),
    "below": Linkage(0.14, 0.31, -0.06),
    "in line": Linkage(0.04, 0.2, 0.0),
    "near locking": Linkage(0.04, 0.06006, 0.02),
    "crossed": Linkage(0.14, 0.31, 0.06, "crossed"),
}


def machine(linkage: Linkage, speed: float = 10.0 * math.pi) -> Mechanism:
    return replace(fronts.MACHINE, branch=linkage.branch, speed=speed)


def curves_of(name: str, speed: float = 10.0 * math.pi) -> tuple[Mechanism, Linkage, Curves]:
    linkage = LINKAGES[name]
    mechanism = machine(linkage, speed)
    return mechanism, linkage, cycle_curves(mechanism, linkage)


def point_of(panel: Panel) -> tuple[float, float] | None:
    return (float(panel.lines[1].x[0]), float(panel.lines[1].y[0])) if len(panel.lines) > 1 else None


@pytest.mark.parametrize("speed", [10.0 * math.pi, -3.0])
@pytest.mark.parametrize("name", LINKAGES)
def test_curves_are_those_of_the_cycle(name: str, speed: float) -> None:
    mechanism, linkage, curves = curves_of(name, speed)
    motion = cycle(mechanism, linkage, np.radians(curves.angles))
    expected = [
        motion.torque,
        motion.transmission_angle,
        motion.slider_position,
        motion.slider_velocity,
        motion.slider_acceleration,
    ]
    for curve, values in zip(curves.panels, expected, strict=True):
        # The angle is turned into degrees and back: a rounding of it, on a steep curve.
        np.testing.assert_allclose(curve.lines[0].y, values, rtol=1e-9, atol=1e-9 * np.abs(values).max())


@pytest.mark.parametrize("name", LINKAGES)
def test_marked_points_lie_on_their_curve_and_are_its_extremum(name: str) -> None:
    _, _, curves = curves_of(name)
    for curve in curves.panels:
        marked = point_of(curve)
        if marked is None:
            continue
        angle, value = marked
        assert value == curve.lines[0].y[curves.angles == angle][0]
        size = np.abs(curve.lines[0].y)
        best = size.min() if format_text(curve.note).startswith("least") else size.max()
        assert abs(value) == pytest.approx(best, rel=1e-12)


@pytest.mark.parametrize("name", LINKAGES)
def test_marked_values_are_those_of_the_table(name: str) -> None:
    mechanism, linkage, curves = curves_of(name)
    row = analyse(mechanism, np.array([[linkage.crank, linkage.rod, linkage.offset]])).iloc[0]
    torque, transmission, _, speed, acceleration = (
        point_of(panel_in_units(curve, "metric")) for curve in curves.panels
    )
    assert torque is not None
    assert abs(torque[1]) == pytest.approx(row["peak_torque_Nm"], rel=1e-12)
    assert torque[0] == pytest.approx(row["peak_torque_angle_deg"], rel=1e-12)
    assert transmission is not None
    assert transmission[1] == pytest.approx(row["least_transmission_angle_deg"], rel=1e-9)
    assert speed is not None
    assert abs(speed[1]) == pytest.approx(row["peak_slider_speed_m_s"], rel=1e-12)
    assert acceleration is not None
    assert abs(acceleration[1]) == pytest.approx(row["peak_slider_acceleration_m_s2"], rel=1e-12)
    assert curves.inner == pytest.approx(row["inner_dead_centre_deg"], rel=1e-12)
    assert curves.outer == pytest.approx(row["outer_dead_centre_deg"], rel=1e-12)


@pytest.mark.parametrize("datum", ["inner dead centre", "outer dead centre"])
@pytest.mark.parametrize("speed", [-7.0, 7.0])
def test_a_peak_on_a_step_of_the_load_is_marked_at_its_height(datum: Datum, speed: float) -> None:
    """The tool bites 8 mm before the dead centre: the torque jumps there, to its peak."""
    load = PositionTable(
        positions=(0.0, 0.008, 0.008), forces=(-1500.0, -1500.0, 0.0), datum=datum, during="outward stroke"
    )
    mechanism, random = Mechanism(speed=speed, slider_mass=6.0, loads=(load,)), np.random.default_rng(6)
    for _ in range(20):
        crank, offset = random.uniform(0.03, 0.06), random.uniform(-0.05, 0.05)
        linkage = Linkage(crank, (crank + abs(offset)) * random.uniform(1.3, 3.0), offset)
        row = analyse(mechanism, np.array([[linkage.crank, linkage.rod, linkage.offset]])).iloc[0]
        point = point_of(panel_in_units(cycle_curves(mechanism, linkage).panels[0], "metric"))
        assert point is not None
        assert abs(point[1]) == pytest.approx(row["peak_torque_Nm"], rel=1e-9)
        assert point[0] == pytest.approx(row["peak_torque_angle_deg"], rel=1e-12)


def test_dead_centres_are_the_ends_of_the_position_curve() -> None:
    _, linkage, curves = curves_of("offset")
    position = curves.panels[2]
    for angle, x in zip((curves.inner, curves.outer), linkage.dead_centres, strict=True):
        assert position.lines[0].y[np.isclose(curves.angles, angle, rtol=1e-13)][0] == pytest.approx(x, rel=1e-12)


def test_without_a_speed_velocity_is_per_crank_speed() -> None:
    linkage = LINKAGES["offset"]
    curves = cycle_curves(Mechanism(), linkage, torque=False)
    assert [format_text(curve.title) for curve in curves.panels] == [
        *("transmission angle", "slider position", "slider velocity per crank speed"),
        "slider acceleration per crank speed",
    ]
    expected = linkage.at(np.radians(curves.angles), speed=1.0).slider_velocity
    np.testing.assert_allclose(curves.panels[2].lines[0].y, expected, rtol=1e-9, atol=1e-9)


def texts_in_figure(figure: Figure) -> list[Text]:
    """Return the texts that are seen in a figure once it is drawn."""
    figure.draw_without_rendering()  # a third of the time, and the same places
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    hidden = [
        label
        for axes in figure.axes
        for axis in (axes.xaxis, axes.yaxis)
        for tick in axis.get_major_ticks()
        for label in (tick.label1, tick.label2)
        if not axes.axison or not axis.get_visible() or not _lies_within(axis.get_view_interval(), tick.get_loc())
    ]
    return [text for text in texts if text not in hidden]


def _lies_within(interval: tuple[float, float], at: float) -> bool:
    low, high = sorted(interval)
    return bool(low <= at <= high)


def overlaps(figure: Figure) -> list[tuple[str, str]]:
    """Return the pairs of texts that overlap, and texts that stick out of the figure as pairs with "edge"."""
    texts = texts_in_figure(figure)
    boxes = [text.get_window_extent() for text in texts]
    page = figure.bbox
    found = []
    for i, one in enumerate(boxes):
        if one.x0 < page.x0 or one.y0 < page.y0 or one.x1 > page.x1 or one.y1 > page.y1:
            found.append((texts[i].get_text(), "edge"))
        for j in range(i):
            other = boxes[j]
            across = min(one.x1, other.x1) - max(one.x0, other.x0)
            along = min(one.y1, other.y1) - max(one.y0, other.y0)
            if across > 1.0 and along > 1.0:
                found.append((texts[i].get_text(), texts[j].get_text()))
    return found


SIX = (*fronts.FOUR, "footprint", "peak_guide_force")
FRONTS = {
    "two objectives": lambda: fronts.front(fronts.FOUR[:2]),
    "three objectives": lambda: fronts.front(fronts.FOUR[:3]),
    "four objectives": lambda: fronts.front(designs=60),
    "six objectives": lambda: fronts.front(SIX, designs=40),
    "two designs": lambda: fronts.front(designs=2),
    "target": lambda: with_target(fronts.front()),
    "all alike": lambda: front_of_equal_designs(fronts.front(designs=3)),
}


def with_target(front: ParetoFront) -> ParetoFront:
    objectives = (Objective(quantity="time_ratio", sense="target", target=1.1), *front.objectives[1:])
    return replace(front, problem=replace(front.problem, objectives=objectives))


def front_of_equal_designs(front: ParetoFront) -> ParetoFront:
    """Return a front whose designs are all the first one."""
    rows = [0] * len(front)
    return replace(
        front,
        columns={name: column[rows] for name, column in front.columns.items()},
        dimensions=front.dimensions[rows],
        values=front.values[rows],
    )


def test_texts_that_overlap_are_found() -> None:
    figure = scatter_matrix(fronts.front(fronts.FOUR[:2]))
    figure.text(0.05, 0.95, "on the title")
    figure.text(0.99, 0.5, "over the edge")
    pairs = overlaps(figure)
    assert ("on the title", "Vibrating sieve") in pairs
    assert ("over the edge", "edge") in pairs


@pytest.mark.parametrize("name", FRONTS)
def test_no_two_texts_of_the_front_figures_overlap(name: str) -> None:
    front = FRONTS[name]()
    assert overlaps(scatter_matrix(front)) == []
    assert overlaps(parallel_coordinates(front)) == []


@pytest.mark.parametrize("name", LINKAGES)
def test_no_two_texts_of_a_design_sheet_overlap(name: str) -> None:
    linkage = LINKAGES[name]
    row = analyse(machine(linkage), np.array([[linkage.crank, linkage.rod, linkage.offset]])).iloc[0]
    numbers = {str(key): value for key, value in row.items()}
    bold = {"position_error_mm": "position error", "least_transmission_angle_deg": "least transmission angle"}
    title = "A job with a name of the greatest length that is allowed, which is 80 characters: best this, best that"
    figure = design_datasheet(machine(linkage), linkage, numbers, title=title, subtitle="design 1 of 2", bold=bold)
    assert overlaps(figure) == []


def test_the_table_of_a_sheet_has_every_objective_of_the_job() -> None:
    linkage = LINKAGES["offset"]
    row = analyse(machine(linkage), np.array([[linkage.crank, linkage.rod, linkage.offset]])).iloc[0]
    numbers = {str(key): value for key, value in row.items()} | {"wear_of_the_bush": -1.2345e-7}
    few = {"time_ratio": "time ratio", "peak_power_W": "peak power", "wear_of_the_bush": "wear of the bush"}
    defined = [of for of in QUANTITIES.values() if np.isfinite(row[of.field])]
    every = {of.field: of.short_title for of in defined[-20:]}
    for bold in (few, every):
        figure = design_datasheet(machine(linkage), linkage, numbers, title="A job", bold=bold)
        printed = [text.get_text() for text in figure.texts if text.get_fontweight() == "bold"]
        assert set(bold.values()) <= set(printed)
        assert {format_number(float(numbers[key]), 5, zeros=True) for key in bold} <= set(printed)
        assert overlaps(figure) == []


def test_a_sheet_without_tolerances_has_no_position_error() -> None:
    linkage = LINKAGES["offset"]
    bare = replace(machine(linkage), tolerances=Tolerances())
    row = analyse(bare, np.array([[linkage.crank, linkage.rod, linkage.offset]])).iloc[0]
    figure = design_datasheet(bare, linkage, {str(key): value for key, value in row.items()}, title="A job")
    texts = [text.get_text() for text in figure.texts]
    assert "peak torque" in texts
    assert not [text for text in texts if "error" in text or text in ("0", "–", "nan")]


def test_ends_and_ticks_of_axes_show_no_rounding_noise() -> None:
    front = fronts.front()
    dimensions = front.dimensions.copy()
    dimensions[:, 2] -= dimensions[:, 2].min() - 1e-11
    noisy = replace(front, dimensions=dimensions)
    said = [text.get_text() for text in parallel_coordinates(noisy).findobj(Text)]
    assert not [text for text in said if "e−" in text]
    figure = new_figure(2.0, 2.0)
    axes = add_axes(figure, 0.2, 0.2, 1.0, 1.0)
    style_axes(axes)
    axes.set_xlim(-1.0, 5.0)
    axes.set_ylim(0.0, 3e-7)
    form = axes.xaxis.get_major_formatter()
    assert [form(1e-8), form(-5.55e-17), form(2.5), form(-0.5)] == ["0", "0", "2.5", "−0.5"]
    assert axes.yaxis.get_major_formatter()(1e-8) == "1e−08"


def test_every_design_is_a_point_and_a_line() -> None:
    front = fronts.front()
    scatter, parallel = scatter_matrix(front), parallel_coordinates(front)
    m = len(front.objectives)
    panels = [axes for axes in scatter.axes if axes.get_xlabel() or axes.get_ylabel() or axes.collections]
    points = [axes.collections[0].get_offsets() for axes in panels if len(axes.collections) == 1 and axes.lines]
    assert len(points) == m * (m - 1) // 2
    assert all(len(offsets) == len(front) for offsets in points)  # type: ignore[arg-type]
    lines = parallel.axes[0].collections[0].get_segments()  # type: ignore[attr-defined]
    assert len(lines) == len(front)


def test_lines_of_parallel_coordinates_have_better_objectives_higher() -> None:
    front = fronts.front()
    lines = np.array(parallel_coordinates(front).axes[0].collections[0].get_segments())  # type: ignore[attr-defined]
    heights = lines[np.argsort(np.argsort(front.designs["time_ratio"]))][:, 3:, 1]
    low, high = front.values.min(axis=0), front.values.max(axis=0)
    np.testing.assert_allclose(heights, (high - front.values) / (high - low), atol=1e-12)


def test_a_design_that_is_best_twice_is_marked_once() -> None:
    front = fronts.front()
    found = marked_designs(front)
    assert len({mark.row for mark in found}) == len(found)
    names = [name for mark in found for name in mark.names]
    assert sorted(names) == sorted([*(f"best_{name}" for name in fronts.FOUR), "knee"])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("names", "designs", "expected"),
    [
        (
            fronts.FOUR,
            20,
            {"scatter_matrix", "parallel_coordinates", "knee", *(f"best_{name}" for name in fronts.FOUR)},
        ),
        (fronts.FOUR[:2], 1, {"best_time_ratio", "best_peak_torque", "knee"}),
        (("peak_torque",), 1, {"best_peak_torque"}),
    ],
)
def test_the_files_of_a_front(names: tuple[str, ...], designs: int, expected: set[str], tmp_path: Path) -> None:
    front = fronts.front(names, designs=designs)
    files = list(write_front_figures(front, tmp_path / "figures"))
    assert {file.stem for file in files} == expected
    assert all(file.read_bytes().startswith(b"\x89PNG") for file in files)


@pytest.mark.slow
def test_figures_do_without_pyplot(tmp_path: Path) -> None:
    script = (
        "import sys; from pathlib import Path; from tests.service import fronts; "
        "from slidercrank.service.figures.front_figures import write_front_figures; "
        f"list(write_front_figures(fronts.front(fronts.FOUR[:2], designs=2), Path({str(tmp_path)!r}))); "
        "sys.exit('matplotlib.pyplot' in sys.modules)"
    )
    root = str(Path(fronts.__file__).parents[2])
    assert subprocess.run([sys.executable, "-c", script], cwd=root, check=False).returncode == 0


@pytest.mark.slow
def test_drawing_again_gives_the_same_files_and_leaves_matplotlib_as_it_was(tmp_path: Path) -> None:
    front = fronts.front(fronts.FOUR[:2], designs=3)
    before = dict(matplotlib.rcParams)
    first, again = (list(write_front_figures(front, tmp_path / name)) for name in ("a", "b"))
    assert dict(matplotlib.rcParams) == before
    assert {file.stem for file in first} >= {"scatter_matrix", "parallel_coordinates", "knee"}
    for one, other in zip(first, again, strict=True):
        assert (one.name, one.read_bytes()) == (other.name, other.read_bytes())


def test_the_colour_scale_is_as_clear_in_grey() -> None:
    """Luminance by ITU-R BT.709; a reader of a black-and-white print sees the same order."""
    grey = [0.2126 * red + 0.7152 * green + 0.0722 * blue for red, green, blue in map(to_rgb, colour_map().colors)]  # type: ignore[arg-type]
    assert np.all(np.diff(grey) > -1e-3)
    assert grey[-1] - grey[0] > 0.6


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (12345.6, "12346"),
        (-3.14159, "−3.142"),
        (0.00012346, "0.0001235"),
        (123456.0, "123456"),
        (1.5e9, "1.5e+09"),
        (math.inf, "∞"),
        (-math.inf, "−∞"),
        (math.nan, "–"),
    ],
)
def test_numbers_are_shown_without_exponent_where_possible(value: float, text: str) -> None:
    assert format_number(value) == text
