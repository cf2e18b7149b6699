"""Drawings of a swing: what is read back from DXF is the linkage at both ends, with what drives it."""

from __future__ import annotations

import io
import math
import re
from typing import Any

import numpy as np
import pytest
from ezdxf.document import Drawing as Document
from ezdxf.entities import Dimension as Measured
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.filemanagement import read as read_dxf
from matplotlib.patches import Circle as Disc

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.swing.swing import Swing
from slidercrank.service.drawings.design_drawing import swing_drawing
from slidercrank.service.drawings.dxf import dxf_file
from slidercrank.service.drawings.shapes import WIDE, Label
from slidercrank.service.drawings.svg import svg_file
from slidercrank.service.figures.shape_painting import drawing_figure
from slidercrank.service.figures.swing_figure import swing_figure
from tests.model.swing.swings import Case, random_swings

CASES = random_swings(24, seed=61)


def read(case: Case, **given: Any) -> Document:
    mechanism, linkage, swing = case
    drawing = swing_drawing(mechanism, linkage, swing, name="Support", design="design 2", **given)
    found = read_dxf(io.StringIO(dxf_file(drawing).decode("ascii")))
    audit = found.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    return found


def pins(linkage: Linkage, angle: float) -> list[tuple[float, float]]:
    """Return crank pin and slider pin, mm, from the loop of the linkage rather than from the drawing's own formulas."""
    r, l, e = (1e3 * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    pin = (r * math.cos(angle), r * math.sin(angle))
    reach = math.sqrt(l * l - (e - pin[1]) ** 2)
    return [pin, (pin[0] + (reach if linkage.branch == "open" else -reach), e)]


def centres(found: Document, layer: str) -> list[tuple[float, float]]:
    return [tuple(circle.dxf.center)[:2] for circle in found.modelspace().query(f'CIRCLE[layer=="{layer}"]')]


@pytest.mark.parametrize("case", CASES, ids=range(len(CASES)))
def test_what_is_read_back_from_dxf_is_the_swing(case: Case) -> None:
    _, linkage, swing = case
    found = read(case)
    r, l, e = (1e3 * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    near = 1e-9 * (r + l)
    for layer, angle in (("SWING_START", swing.start), ("SWING_END", swing.end)):
        np.testing.assert_allclose(centres(found, layer), pins(linkage, angle), rtol=0.0, atol=near)
    middle = 0.5 * (swing.start + swing.end)
    np.testing.assert_allclose(centres(found, "PINS"), [(0.0, 0.0), *pins(linkage, middle)], rtol=0.0, atol=near)

    (arc,) = found.modelspace().query('ARC[layer=="PATHS"]')
    assert (arc.dxf.end_angle - arc.dxf.start_angle) % 360.0 == pytest.approx(
        math.degrees(abs(swing.end - swing.start))
    )
    (path,) = found.modelspace().query('LINE[layer=="PATHS"]')
    ways = [pins(linkage, angle)[1][0] for angle in np.linspace(swing.start, swing.end, 20001)]
    ends = sorted((path.dxf.start.x, path.dxf.end.x))
    np.testing.assert_allclose(ends, [min(ways), max(ways)], rtol=0.0, atol=1e-6 * (r + l))

    lengths = sorted(dim.get_measurement() for dim in found.modelspace() if isinstance(dim, Measured))
    travel = abs(pins(linkage, swing.end)[1][0] - pins(linkage, swing.start)[1][0])
    np.testing.assert_allclose(lengths, sorted([r, l, travel, abs(e)]), rtol=0.0, atol=near)


@pytest.mark.parametrize("case", CASES, ids=range(len(CASES)))
def test_a_cylinder_reaches_from_the_slider_into_its_barrel_all_over_the_swing(case: Case) -> None:
    _, linkage, swing = case
    for angle in np.linspace(swing.start, swing.end, 5):
        if swing.driver == "crank":
            assert swing_drawing(*case, name="Support", crank_angle=float(angle)).shapes_on_layer("ACTUATOR") == []
            continue
        found = read(case, crank_angle=float(angle))
        outlines = found.modelspace().query('LWPOLYLINE[layer=="ACTUATOR"]')
        parts = [list(shape.vertices()) for shape in outlines if isinstance(shape, LWPolyline)]
        barrel, rod = (np.array(part) for part in parts)
        slider = pins(linkage, float(angle))[1]
        assert rod[:, 1].mean() == pytest.approx(slider[1], abs=1e-6)
        assert barrel[:, 1].mean() == pytest.approx(slider[1], abs=1e-6)
        assert rod[1, 0] == pytest.approx(barrel[0, 0], abs=1e-6)  # at the face
        reach = np.ptp(barrel[:, 0])
        assert reach > 1e3 * abs(float(linkage.at(swing.end).slider_position - linkage.at(swing.start).slider_position))
        assert 0.0 < np.sign(barrel[1, 0] - slider[0]) * (rod[1, 0] - rod[0, 0]) < reach


def test_the_body_stands_where_the_mass_centre_of_the_crank_is() -> None:
    linkage, swing = Linkage(1.4, 1.8, -0.05), Swing(start=0.2, end=1.7, driver="slider")
    machine = Mechanism(crank=RigidLink(mass=1200.0, centre=1.1, centre_across=0.15))
    found = read((machine, linkage, swing), crank_angle=0.9)
    (centre,) = centres(found, "BODY")
    point = 1e3 * linkage.crank_point(0.9, along=1.1, across=0.15).position
    np.testing.assert_allclose(centre, point, atol=1e-9 * 1400.0)
    for bare in (Mechanism(), Mechanism(crank=RigidLink(mass=0.0))):
        assert centres(read((bare, linkage, swing)), "BODY") == []


def test_a_crank_angle_of_the_drawing_lies_in_the_swing_but_for_whole_turns() -> None:
    linkage, swing = Linkage(1.4, 1.8, -0.05), Swing(start=math.radians(11.16), end=math.radians(101.16))
    case = (Mechanism(), linkage, swing)
    for angle in (11.16, 60.0, 101.16, 371.16, -300.0):
        found = centres(read(case, crank_angle=math.radians(angle)), "PINS")
        np.testing.assert_allclose(found[1:], pins(linkage, math.radians(angle)), atol=1e-5)
    with pytest.raises(InputError, match=r"from 11\.16 to 101\.16 deg; got 120 deg"):
        read(case, crank_angle=math.radians(120.0))


def test_svg_and_figure_show_the_same_shapes() -> None:
    mechanism, linkage, swing = CASES[0]
    drawing = swing_drawing(mechanism, linkage, swing, name="Größe $x", design="")
    text = svg_file(drawing).decode()
    assert text.count('id="SWING_START"') == 1
    assert "NaN" not in text
    left, low, right, high = drawing.bounds
    width, height = drawing_figure(drawing).get_size_inches()
    assert width / height == pytest.approx((right - left) / (high - low), rel=1e-6)


@pytest.mark.parametrize("number", range(0, 24, 6))
def test_the_figure_of_a_swing_has_the_machine_to_scale_above_its_curves(number: int) -> None:
    """Discs of the pins stand where the linkage is half-way, at one scale in both directions; nothing overlaps."""
    mechanism, linkage, swing = CASES[number]
    figure = swing_figure(mechanism, linkage, swing)
    (drawn, *panels) = sorted(figure.axes, key=lambda axes: -axes.get_position().y1)
    assert len(panels) >= 3
    assert all(panel.get_position().y1 < drawn.get_position().y0 for panel in panels)
    middle = 0.5 * (swing.start + swing.end)
    found = np.array([patch.center for patch in drawn.patches if isinstance(patch, Disc)])
    for pin in [(0.0, 0.0), *pins(linkage, middle)]:
        assert np.hypot(*(found - pin).T).min() < 1e-6 * 1e3 * float(linkage.rod)
    across, up = (np.ptp(limits) for limits in (drawn.get_xlim(), drawn.get_ylim()))
    box = drawn.get_window_extent()
    assert across / box.width == pytest.approx(up / box.height, rel=1e-9)


def test_the_figure_of_a_swing_has_its_body() -> None:
    linkage, swing = Linkage(1.4, 1.8, -0.05), Swing(start=0.2, end=1.7, driver="slider")
    machine = Mechanism(crank=RigidLink(mass=1200.0, centre=1.1, centre_across=0.15))
    drawn = max(swing_figure(machine, linkage, swing).axes, key=lambda axes: axes.get_position().y1)
    point = 1e3 * linkage.crank_point(0.95, along=1.1, across=0.15).position
    found = np.array([patch.center for patch in drawn.patches if isinstance(patch, Disc)])
    assert np.hypot(*(found - point).T).min() < 1e-6


@pytest.mark.parametrize("case", CASES, ids=range(len(CASES)))
def test_the_words_of_the_swing_angle_do_not_lie_on_the_crank(case: Case) -> None:
    mechanism, linkage, swing = case
    drawing = swing_drawing(mechanism, linkage, swing, name="Support", design="design 2")
    (words,) = (
        shape for shape in drawing.shapes if isinstance(shape, Label) and re.fullmatch(r"[\d.]+ deg", shape.text)
    )
    long = WIDE * words.height * len(words.text)
    left = words.position[0] - {"start": 0.0, "middle": 0.5, "end": 1.0}[words.anchor] * long
    along = np.linspace(0.0, 1e3 * float(linkage.crank), 400)
    angle = 0.5 * (swing.start + swing.end)
    x, y = along * math.cos(angle), along * math.sin(angle) - words.position[1]
    assert not np.any((x > left) & (x < left + long) & (y > -0.3 * words.height) & (y < words.height))
