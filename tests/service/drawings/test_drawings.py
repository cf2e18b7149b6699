"""Drawings: what is read back from DXF and SVG is the design, for both branches and signs, tiny and huge."""

from __future__ import annotations

import io
import math
import os
import random
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from ezdxf import recover
from ezdxf.bbox import extents
from ezdxf.document import Drawing as Document
from ezdxf.entities import Dimension as Measured
from hypothesis import given, settings
from hypothesis import strategies as st

from slidercrank.model.errors import AssemblyError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.model.swing.swing import Swing
from slidercrank.objectives.kinds import System
from slidercrank.service.designs.length_with_tolerance import format_toleranced
from slidercrank.service.drawings.design_drawing import linkage_drawing, swing_drawing
from slidercrank.service.drawings.dxf import dxf_file
from slidercrank.service.drawings.layers import LAYERS, SWING_LAYERS
from slidercrank.service.drawings.shapes import Circle, Dimension, Drawing, Label, Line, Outline
from slidercrank.service.drawings.svg import svg_file
from tests.model.cases import STRENGTH
from tests.service import fronts

EXACT = 1e-9  # relative to the size of the linkage

LINKAGES = {
    "offset": Linkage(0.04, 0.064, 0.02),
    "below": Linkage(0.14, 0.31, -0.06),
    "in line": Linkage(0.04, 0.2, 0.0),
    "crossed": Linkage(0.14, 0.31, 0.06, "crossed"),
    "crossed below": Linkage(0.14, 0.31, -0.06, "crossed"),
    "near locking": Linkage(0.04, 0.06006, 0.02),
    "watch": Linkage(2e-6, 7e-6, 1e-6),
    "crane": Linkage(30.0, 200.0, -25.0),
    "long rod": Linkage(0.001, 1.0, 1e-5),
}


@st.composite
def linkages(draw: st.DrawFn) -> Linkage:
    """Return fully turning linkages of any size."""
    size = 10.0 ** draw(st.floats(-5.0, 3.0))
    crank = size * draw(st.floats(0.01, 1.0))
    share = draw(st.one_of(st.just(0.0), st.floats(-3.0, 3.0)))
    rod = (crank * (1.0 + abs(share))) * draw(st.floats(1.001, 20.0))
    return Linkage(crank, rod, crank * share, draw(st.sampled_from(["open", "crossed"])))


def drawing_of(linkage: Linkage, angle: float = math.radians(60.0)) -> Drawing:
    return linkage_drawing(Mechanism(), linkage, name="Sieve", design="design 3", crank_angle=angle)


def read(drawing: Drawing) -> Document:
    return recover.read(io.BytesIO(dxf_file(drawing)))[0]  # as CAD does, it reads escaped characters


def exact(values: Any, expected: Any, linkage: Linkage) -> None:
    size = 1e3 * (float(linkage.crank) + float(linkage.rod))
    np.testing.assert_allclose(np.asarray(values), np.asarray(expected), rtol=0.0, atol=EXACT * size)


def pins(linkage: Linkage, angle: float) -> list[tuple[float, float]]:
    """Return crank pin and slider pin, mm, from the loop of the linkage rather than from the drawing's own formulas."""
    r, l, e = (1e3 * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    pin = (r * math.cos(angle), r * math.sin(angle))
    reach = math.sqrt(l * l - (e - pin[1]) ** 2)
    return [pin, (pin[0] + (reach if linkage.branch == "open" else -reach), e)]


@settings(max_examples=25, deadline=None)
@given(linkage=linkages(), angle=st.floats(0.0, 2.0 * math.pi))
def test_what_is_read_back_from_dxf_is_the_design(linkage: Linkage, angle: float) -> None:
    found = read(drawing_of(linkage, angle))
    audit = found.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    space = found.modelspace()
    r, l, e = (1e3 * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))

    centres = [tuple(circle.dxf.center)[:2] for circle in space.query('CIRCLE[layer=="PINS"]')]
    exact(centres, [(0.0, 0.0), *pins(linkage, angle)], linkage)
    skeleton = [(line.dxf.start, line.dxf.end) for line in space.query('LINE[layer=="SKELETON"]')]
    exact([(end - start).magnitude for start, end in skeleton], [r, l], linkage)

    sign = 1.0 if linkage.branch == "open" else -1.0
    ends = [sign * math.sqrt((l + side * r) ** 2 - e * e) for side in (-1.0, 1.0)]
    for layer, x, direction in (("DEAD_CENTRE_INNER", ends[0], -1.0), ("DEAD_CENTRE_OUTER", ends[1], 1.0)):
        pin, slider = (tuple(circle.dxf.center)[:2] for circle in space.query(f'CIRCLE[layer=="{layer}"]'))
        exact(slider, (x, e), linkage)
        # At a dead centre crank and rod lie along the line from the pivot to the slider pin.
        exact(pin, (direction * r * x / (l + direction * r), direction * r * e / (l + direction * r)), linkage)
    (path,) = (line for line in space.query('LINE[layer=="PATHS"]'))
    exact([path.dxf.start.x, path.dxf.end.x], ends, linkage)

    dims = [dim for dim in space if isinstance(dim, Measured)]
    lengths = sorted(dim.get_measurement() for dim in dims)
    exact(lengths, sorted([r, l, abs(ends[1] - ends[0]), *([abs(e)] if e else [])]), linkage)
    for dim in dims:
        assert dim.dxf.actual_measurement == pytest.approx(dim.get_measurement(), rel=1e-12, abs=EXACT * (r + l))


@pytest.mark.parametrize("name", LINKAGES)
def test_svg_has_the_same_geometry_as_the_drawing(name: str) -> None:
    linkage = LINKAGES[name]
    root = ElementTree.fromstring(svg_file(drawing_of(linkage)))
    groups = {group.get("id"): group for group in root.findall("{*}g")}
    assert list(groups) == [layer.name for layer in LAYERS]
    circles = [
        [float(circle.get(key, "nan")) for key in ("cx", "cy")] for circle in groups["PINS"].findall("{*}circle")
    ]
    exact([(x, -y) for x, y in circles], [(0.0, 0.0), *pins(linkage, math.radians(60.0))], linkage)
    inner, outer = (1e3 * float(x) for x in linkage.dead_centres)
    for layer, x in (("DEAD_CENTRE_INNER", inner), ("DEAD_CENTRE_OUTER", outer)):
        last = groups[layer].findall("{*}circle")[-1]
        exact([float(last.get("cx", "nan")), -float(last.get("cy", "nan"))], [x, 1e3 * float(linkage.offset)], linkage)


@pytest.mark.parametrize("name", LINKAGES)
def test_svg_is_at_true_scale_and_has_everything_in_its_frame(name: str) -> None:
    drawing = drawing_of(LINKAGES[name])
    root = ElementTree.fromstring(svg_file(drawing))
    left, top, width, height = (float(part) for part in root.get("viewBox", "").split())
    assert (root.get("width"), root.get("height")) == (f"{width!r}mm".replace(".0mm", "mm"), root.get("height"))
    assert float(root.get("height", "").removesuffix("mm")) == height
    low_x, low_y, high_x, high_y = drawing.bounds
    assert left < low_x
    assert -top > high_y
    assert left + width > high_x
    assert -(top + height) < low_y


@pytest.mark.parametrize("name", LINKAGES)
def test_outlines_are_round_about_their_pivots(name: str) -> None:
    linkage = LINKAGES[name]
    drawing = drawing_of(linkage)
    pin, slider = pins(linkage, math.radians(60.0))
    for layer, ends in (("CRANK", ((0.0, 0.0), pin)), ("ROD", (pin, slider))):
        (outline,) = drawing.shapes_on_layer(layer)
        assert isinstance(outline, Outline)
        one, two, three, four = outline.corners
        middles = [[0.5 * (a + b) for a, b in zip(*pair, strict=True)] for pair in ((four, one), (two, three))]
        exact(middles, ends, linkage)
        assert outline.bulges == (0.0, 1.0, 0.0, 1.0)
        assert math.dist(one, four) < math.dist(*ends)


def test_an_arc_bulges_outward_in_both_files() -> None:
    """The ends of a link reach beyond its pivots: found by the boxes of the outlines themselves."""
    linkage = LINKAGES["in line"]
    drawing = drawing_of(linkage, 0.0)  # crank and rod along x
    space = read(drawing).modelspace()
    box = extents(space.query('LWPOLYLINE[layer=="CRANK"]'))
    width = box.size.y
    assert box.extmin.x == pytest.approx(-0.5 * width, rel=1e-3)
    assert box.extmax.x == pytest.approx(40.0 + 0.5 * width, rel=1e-3)
    root = ElementTree.fromstring(svg_file(drawing))
    (crank,) = (group for group in root.findall("{*}g") if group.get("id") == "CRANK")
    path = crank.findall("{*}path")[0].get("d", "")
    # From the lower right corner to the upper right one, counter-clockwise on paper: sweep flag 0 where y points down.
    assert path.count("A") == 2
    assert " 0 0 0 " in path
    assert " 0 0 1 " not in path


@pytest.mark.parametrize("name", LINKAGES)
def test_texts_of_a_drawing_do_not_overlap(name: str) -> None:
    drawing = drawing_of(LINKAGES[name])
    labels = [shape for shape in drawing.shapes if isinstance(shape, Label)]
    labels += [
        part
        for shape in drawing.shapes
        if isinstance(shape, Dimension)
        for part in shape.parts
        if isinstance(part, Label)
    ]
    assert len(labels) == (9 if LINKAGES[name].offset else 8)
    if name == "long rod":
        return  # the crank is a thousandth of the rod: its dimension is on top of others however it is placed
    boxes = [Drawing((), (label,), 1.0, "", ()).bounds for label in labels if label.angle == 0.0]
    for index, one in enumerate(boxes):
        for other in boxes[:index]:
            apart = one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]
            assert apart, (one, other)


def test_dxf_says_units_layers_and_line_types() -> None:
    found = read(drawing_of(LINKAGES["offset"]))
    assert found.header["$INSUNITS"] == 4
    assert found.header["$MEASUREMENT"] == 1
    for layer in LAYERS:
        made = found.layers.get(layer.name)
        assert made.dxf.linetype in found.linetypes
        assert made.dxf.lineweight == round(100 * layer.weight)
        assert list(found.modelspace().query(f'*[layer=="{layer.name}"]')), layer.name
    assert found.layers.get("DEAD_CENTRE_INNER").dxf.linetype == "DASHED"
    left, bottom = found.header["$EXTMIN"][:2]
    right, top = found.header["$EXTMAX"][:2]
    assert left < -40.0
    assert right > 90.0
    assert bottom < -40.0
    assert top > 40.0


def test_dimensions_are_entities_that_cad_can_draw_anew() -> None:
    found = read(drawing_of(LINKAGES["offset"]))
    dims = [dim for dim in found.modelspace() if isinstance(dim, Measured)]
    assert len(dims) == 4
    for dim in dims:
        assert dim.dxf.text in ("", "<>")  # shows what it measures
        assert dim.dxf.dimstyle in found.dimstyles
        picture = dim.get_geometry_block()
        assert picture is not None
        texts = [entity.dxf.text for entity in picture.query("TEXT")]
        assert texts[0] == f"{dim.get_measurement():.5g}"


def test_without_offset_there_is_no_dimension_of_it() -> None:
    names = {shape.name for shape in drawing_of(LINKAGES["in line"]).shapes if isinstance(shape, Dimension)}
    assert names == {"crank", "rod", "stroke"}


def test_links_of_a_section_have_their_width() -> None:
    drawing = linkage_drawing(fronts.MACHINE, LINKAGES["below"], name="Sieve")
    for layer in ("CRANK", "ROD"):
        (outline,) = drawing.shapes_on_layer(layer)
        assert isinstance(outline, Outline)
        assert math.dist(outline.corners[0], outline.corners[3]) == pytest.approx(30.0)
    assert drawing.title == "Sieve"
    assert "Link widths are to scale" in drawing.notes[-1]


def test_pins_of_a_job_have_their_diameters() -> None:
    machine = replace(fronts.MACHINE, strength=STRENGTH)
    drawing = linkage_drawing(machine, LINKAGES["below"], name="Sieve")
    radii = [shape.radius for shape in drawing.shapes_on_layer("PINS") if isinstance(shape, Circle)]
    diameters = (STRENGTH.crank_pivot, STRENGTH.crank_pin, STRENGTH.slider_pin)
    assert radii == pytest.approx([500.0 * diameter for diameter in diameters])
    assert "Link widths and pins are to scale; the slider is schematic." in drawing.notes


@pytest.mark.parametrize("name", [r"$\frac{ <script>&amp; 50 %%u \P {x;y} ^J", "Größe 寸法\nline", "", "\\U+0041"])
def test_any_name_can_be_drawn(name: str) -> None:
    drawing = linkage_drawing(Mechanism(), LINKAGES["offset"], name=name, design="design 1")
    assert read(drawing).audit().errors == []
    root = ElementTree.fromstring(svg_file(drawing))
    title = root.find("{*}title")
    assert title is not None
    assert title.text == drawing.title
    texts = [entity.dxf.text for entity in read(drawing).modelspace().query("TEXT")]
    assert any(text.endswith("design 1") for text in texts)
    assert all(word in " ".join(texts) for word in name.split() if word.isalpha())


def test_a_linkage_that_does_not_turn_fully_is_refused() -> None:
    with pytest.raises(AssemblyError, match="rod must exceed"):
        drawing_of(Linkage(0.1, 0.11, 0.05))


def test_the_same_design_gives_the_same_svg() -> None:
    assert svg_file(drawing_of(LINKAGES["offset"])) == svg_file(drawing_of(LINKAGES["offset"]))


def test_dxf_is_written_where_the_home_folder_cannot_be(tmp_path: Path) -> None:
    """As in a service that may write nothing but its own folder. ezdxf keeps a list of the fonts at home."""
    script = (
        "from slidercrank.model.linkage.linkage import Linkage;"
        "from slidercrank.model.machine.mechanism import Mechanism;"
        "from slidercrank.service.drawings.dxf import dxf_file;"
        "from slidercrank.service.drawings.design_drawing import linkage_drawing;"
        "print(len(dxf_file(linkage_drawing(Mechanism(), Linkage(0.04, 0.064, 0.02), name='x'))))"
    )
    home = tmp_path / "a file"
    home.touch()
    environment = os.environ | {"HOME": str(home), "XDG_CACHE_HOME": str(home)}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    assert int(done.stdout) > 10_000


def test_lines_and_circles_of_a_drawing_are_finite() -> None:
    for linkage in LINKAGES.values():
        for angle in np.linspace(0.0, 2.0 * np.pi, 7):
            drawing = drawing_of(replace(linkage), float(angle))
            for shape in drawing.shapes:
                if isinstance(shape, Line):
                    assert all(map(math.isfinite, (*shape.start, *shape.end)))
                elif isinstance(shape, Circle):
                    assert shape.radius > 0.0


def test_the_layers_are_those_that_the_documentation_names(pytestconfig: pytest.Config) -> None:
    text = (pytestconfig.rootpath / "docs" / "drawings.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1:4] for line in text.splitlines() if line.startswith("|")]
    named = {name.strip(): dashes.strip() for names, _, dashes in rows for name in names.split(",")}
    linkage = LINKAGES["offset"]
    swings = swing_drawing(Mechanism(), linkage, Swing(start=0.5, end=1.5, driver="slider"), name="Support")
    for drawing, layers in ((drawing_of(linkage), LAYERS), (swings, SWING_LAYERS)):
        found = read(drawing)
        for layer in layers:
            assert named[layer.name] == str(found.layers.get(layer.name).dxf.linetype).upper(), layer.name
    known = {layer.name for layer in (*LAYERS, *SWING_LAYERS)}
    assert {name for name in named if name.isupper() and "_" in name} <= known


def test_dimensions_have_the_digits_of_their_tolerances() -> None:
    linkage = Linkage(0.07333253, 0.25123456, -0.0400049)
    tolerances = Tolerances(
        crank=Tolerance(absolute=5e-5), rod=Tolerance(fraction=1e-3), offset=Tolerance(absolute=1e-4)
    )
    drawing = linkage_drawing(Mechanism(tolerances=tolerances), linkage, name="press")
    found = {shape.name: shape for shape in drawing.shapes if isinstance(shape, Dimension)}
    assert found["crank"].text == "73.33 ± 0.05"
    assert found["rod"].text == "251.23 ± 0.25"
    assert found["offset"].text == "40.0 ± 0.1"
    assert "±" not in found["stroke"].text
    assert found["crank"].length == pytest.approx(73.33253, rel=1e-9)
    assert "crank 73.33 mm" in drawing.notes[0]
    read_back = read(drawing)
    assert read_back.audit().errors == []
    written = {text.dxf.text for block in read_back.blocks for text in block.query("TEXT")}
    assert {"73.33 ± 0.05", "251.23 ± 0.25", "40.0 ± 0.1"} <= written
    (crank,) = [
        dim
        for dim in read_back.modelspace()
        if isinstance(dim, Measured) and dim.get_measurement() == pytest.approx(73.33253, rel=1e-6)
    ]
    style = crank.override()
    assert (style.get("dimtol"), style.get("dimdec")) == (1, 2)
    assert (style.get("dimtp"), style.get("dimtm")) == (pytest.approx(0.05), pytest.approx(0.05))  # plus and minus
    for length, tolerance, words in (
        (73.33253, 0.025, "73.333 ± 0.025"),
        (-0.001, 0.1, "0.0 ± 0.1"),
        (1234.56, 12.0, "1235 ± 12"),
        (2.887, 0.0019685, "2.887 ± 0.002"),
        (100.0, 10.0, "100 ± 10"),
        (5.0, 1e-7, "5.0000000 ± 0.0000001"),
    ):
        assert format_toleranced(length, tolerance) == words


@pytest.mark.parametrize("offset", [0.0, 0.02, -0.013])
def test_in_inches_only_texts_differ(offset: float) -> None:
    chance, factor = random.Random(37), 1.0 / 25.4
    for _ in range(20):
        linkage = Linkage(chance.uniform(0.02, 0.05), chance.uniform(0.12, 0.3), offset)
        metric, inch = (
            linkage_drawing(Mechanism(speed=1.0), linkage, name="run", system=system) for system in get_args(System)
        )
        assert [shape.name for shape in inch.shapes if isinstance(shape, Dimension)] == [
            shape.name for shape in metric.shapes if isinstance(shape, Dimension)
        ]
        for one, other in zip(inch.shapes, metric.shapes, strict=True):
            if isinstance(one, Dimension) and isinstance(other, Dimension):
                assert (one.text, other.text) == (f"{factor * other.length:.5g}", f"{other.length:.5g}")
                assert (one.start, one.end, one.through) == (other.start, other.end, other.through)
        assert not [note for note in inch.notes if "mm" in note or "millimetre" in note]
        assert f"crank {1e3 * factor * float(linkage.crank):.5g} in" in inch.notes[0]
