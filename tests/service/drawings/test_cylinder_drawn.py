"""The cylinder of a machine, drawn: bore, stroke and clearance are true on both branches and at both heads."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
from ezdxf.filemanagement import read as read_dxf

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.loads.cylinder import Head
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.service.drawings.design_drawing import linkage_drawing
from slidercrank.service.drawings.dxf import dxf_file
from slidercrank.service.drawings.shapes import Drawing, Line, Outline
from slidercrank.service.drawings.svg import svg_file


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("head", ["outer dead centre", "inner dead centre"])
def test_bore_and_clearance_are_to_scale(seed: int, branch: Branch, head: Head) -> None:
    """At the dead centre of its head the piston leaves the clearance volume over its area."""
    random = np.random.default_rng(seed)
    crank = random.uniform(0.02, 0.06)
    linkage = Linkage(crank, crank * random.uniform(2.6, 5.0), crank * random.uniform(-0.5, 0.5), branch)
    load = Compressor(
        bore=crank * random.uniform(0.3, 3.0),
        piston_rod=crank * 0.1,
        low=1e5,
        high=4e5,
        clearance=random.uniform(0.01, 0.1),
        clearance_volume=random.uniform(0.0, 1e-6),
        compression_exponent=1.3,
        expansion_exponent=1.3,
        head=head,
    )
    machine = Mechanism(loads=(load,), branch=branch)
    inner, outer = linkage.dead_centre_angles
    at, other = (outer, inner) if head == "outer dead centre" else (inner, outer)
    drawing = linkage_drawing(machine, linkage, name="pump", crank_angle=float(at))
    far = linkage_drawing(machine, linkage, name="pump", crank_angle=float(other))
    walls = [shape for shape in drawing.shapes if isinstance(shape, Line) and shape.layer.name == "CYLINDER"]
    assert len(walls) == 3
    (low, top, high) = walls
    e, size = 1e3 * float(linkage.offset), 1e3 * float(linkage.rod)
    for wall, side in ((low, -1.0), (high, 1.0)):
        assert (wall.start[1], wall.end[1]) == pytest.approx((e + side * 500.0 * load.bore,) * 2, abs=1e-9 * size)
    assert top.start[0] == top.end[0]

    def piston(drawn: Drawing) -> list[float]:
        shapes = [one for one in drawn.shapes if isinstance(one, Outline) and one.layer.name == "SLIDER"]
        (outline,) = shapes
        assert np.ptp([y for _, y in outline.corners]) == pytest.approx(1e3 * load.bore)
        return sorted({x for x, _ in outline.corners})

    way = math.copysign(1.0, float(linkage.at(at).slider_position) - float(linkage.at(other).slider_position))
    face = piston(drawing)[-1 if way > 0.0 else 0]
    stroke = float(linkage.stroke)
    height = load.clearance * stroke + load.clearance_volume / load.area
    assert way * (top.start[0] - face) == pytest.approx(1e3 * height, rel=1e-6)
    # At the other dead centre its far end is where the bore ends.
    foot = piston(far)[0 if way > 0.0 else -1]
    assert low.start[0] == pytest.approx(foot, abs=1e-6 * size)
    space = read_dxf(io.StringIO(dxf_file(drawing).decode("ascii"))).modelspace()
    assert len(space.query('LINE[layer=="CYLINDER"]')) == 3
    assert b'id="CYLINDER"' in svg_file(drawing)


def test_a_machine_without_a_cylinder_has_no_layer_for_it() -> None:
    drawing = linkage_drawing(Mechanism(), Linkage(0.04, 0.1, 0.01), name="feeder")
    assert b"CYLINDER" not in svg_file(drawing)
    assert not [note for note in drawing.notes if "cylinder" in note]
