"""Texts, pictures and figures of a notebook; no text can break its page."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

import slidercrank as sc
from slidercrank.model.errors import InputError

NASTY = "Feeder <script>alert(1)</script> & co"


@pytest.fixture(scope="module")
def front(pytestconfig: pytest.Config) -> sc.ParetoFront:
    problem = sc.load_job(pytestconfig.rootpath / "runs/feeder.toml")
    return sc.solve(replace(problem, name=NASTY, settings=replace(problem.settings, designs=8)))


def test_texts_are_short_and_say_what_it_is(front: sc.ParetoFront) -> None:
    analysis = front.problem.analyse(front.dimensions[0])
    assert repr(front).startswith(f"ParetoFront({NASTY!r}: done, 8 designs; time ratio; peak torque, N m; ")
    assert repr(front.problem).startswith(f"Problem({NASTY!r}: maximise time_ratio, minimise peak_torque")
    assert repr(analysis).startswith("Analysis(crank ")
    for shown in (front, front.problem, analysis):
        assert len(repr(shown)) < 300


def test_pages_are_well_formed_escaped_and_have_a_picture(front: sc.ParetoFront) -> None:
    analysis = front.problem.analyse(front.dimensions[0])
    for shown in (front, front.problem, analysis, analysis.linkage):
        page = shown._repr_html_()
        assert page is not None
        ElementTree.fromstring(page)
        assert page.count("<svg") == 1
        assert "<script" not in page
        assert not re.search(r"\b(src|href)=", page)
        assert "nan" not in page.lower().replace("nano", "")


def test_picture_of_a_linkage_has_its_pins_where_they_are() -> None:
    # The crank pin lies on the circle of the crank, the rod has its length.
    page = ElementTree.fromstring(str(sc.Linkage(0.04, 0.1, 0.02)._repr_html_()))
    name = "{http://www.w3.org/2000/svg}"
    circle, pivot, pin = page.iter(f"{name}circle")
    _, crank, rod = page.iter(f"{name}line")
    at = {key: float(value) for key, value in rod.items() if key in ("x1", "y1", "x2", "y2")}
    scale = float(circle.attrib["r"]) / 0.04
    assert np.hypot(at["x2"] - at["x1"], at["y2"] - at["y1"]) == pytest.approx(0.1 * scale, abs=0.3)
    assert float(pin.attrib["cx"]) == pytest.approx(float(crank.attrib["x2"]))
    arm = float(pin.attrib["cx"]) - float(pivot.attrib["cx"]), float(pin.attrib["cy"]) - float(pivot.attrib["cy"])
    assert np.hypot(*arm) == pytest.approx(0.04 * scale, abs=0.3)


def test_figures_show_the_numbers(front: sc.ParetoFront) -> None:
    analysis = front.problem.analyse(front.dimensions[0])
    assert isinstance(analysis.linkage.plot(), Figure)
    with pytest.raises(sc.InputError, match=r"can only show one crank angle; got an array of shape \(2,\); choose one"):
        analysis.linkage.plot(crank_angle=[1.0, 2.0])  # type: ignore[arg-type]
    shown = front.plot()
    spots = np.asarray(shown.axes[0].lines[0].get_xydata())
    np.testing.assert_allclose(spots, front.designs[["time_ratio", "peak_torque_Nm"]])
    curves = analysis.plot()
    torque = np.asarray(curves.axes[3].lines[0].get_ydata())
    np.testing.assert_allclose(torque[:-1], analysis.cycle(360)["torque_Nm"])


def test_what_has_no_picture_says_so(front: sc.ParetoFront) -> None:
    arms = sc.Linkage([0.04, 0.05], 0.1)
    assert arms._repr_html_() is None
    with pytest.raises(InputError, match="one linkage"):
        arms.plot()
    empty = replace(front, values=front.values[:0], message="nothing <b>fits</b>")
    assert "&lt;b&gt;" in empty._repr_html_()
    with pytest.raises(InputError, match="this front is empty: nothing"):
        empty.plot()


def test_picture_of_one_objective_and_of_equal_values_is_drawn(front: sc.ParetoFront) -> None:
    from slidercrank.optimise.front.front_picture import scatter_figure, scatter_svg

    for values in (np.ones((3, 1)), np.ones((3, 2)), np.ones((1, 4))):
        ElementTree.fromstring(scatter_svg(values, ["a & b", "c", "d", "e"]))
        assert isinstance(scatter_figure(values, ["a", "b", "c", "d"], "title"), Figure)


def test_a_notebook_shows_the_figures_without_pyplot(front: sc.ParetoFront) -> None:
    analysis = front.problem.analyse(front.dimensions[0])
    for figure in (front.plot(), analysis.plot(), analysis.linkage.plot()):
        assert figure._repr_png_().startswith(b"\x89PNG\r\n")  # type: ignore[attr-defined] # as a notebook asks for it
