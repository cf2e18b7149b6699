"""Everything about one design: the numbers of the table of designs, reasons for what is not defined, the cycle."""

from typing import Any

import numpy as np
import pandas as pd
import pytest

import slidercrank as sc
from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.all_quantities import analyse as table_of
from slidercrank.objectives.tables.cycle_curves import cycle_curves

DESIGN = [0.04, 0.1, 0.02]


@pytest.fixture(scope="module")
def problem(pytestconfig: pytest.Config) -> sc.Problem:
    return sc.load_job(pytestconfig.rootpath / "runs/feeder.toml")


def test_analysis_has_the_numbers_of_the_table_of_designs(problem: sc.Problem) -> None:
    analysis = problem.analyse(DESIGN)
    row = table_of(problem.mechanism, np.array([DESIGN])).iloc[0]
    assert {*analysis, *analysis.undefined} == set(QUANTITIES)
    for name, value in analysis.items():
        quantity = QUANTITIES[name]
        assert quantity.unit.factor * value == pytest.approx(float(row[quantity.field]), rel=1e-12), name
    table = analysis.table()
    assert table.loc["stroke", "value"] == pytest.approx(1e3 * analysis["stroke"], rel=1e-14)
    assert table.loc["peak_torque", "unit"] == "N m"
    assert "needs friction" in str(table.loc["self_locking_margin", "undefined_because"])
    assert bool(table["value"].isna()["self_locking_margin"])


def test_undefined_quantities_say_why_instead_of_a_number() -> None:
    still = sc.analyse(Mechanism(slider_mass=0.8), DESIGN)
    for name, words in (
        ("position_error", "tolerances"),
        ("peak_slider_speed", "needs a crank speed; got none"),
        ("peak_power", "needs a crank speed; got none"),
        ("peak_torque", "masses that move or weigh|speed"),
    ):
        assert name not in still or name == "peak_torque"
        if name not in still:
            with pytest.raises(InputError, match=words):
                still[name]
    with pytest.raises(InputError, match="did you mean stroke"):
        still["strok"]
    assert still.get("stroke") == pytest.approx(float(sc.Linkage(DESIGN[0], DESIGN[1], DESIGN[2]).stroke), rel=1e-14)


def test_cycle_is_consistent_with_itself(problem: sc.Problem) -> None:
    # Derivatives of periodic curves by the Fourier series are exact to rounding.
    table = problem.analyse(DESIGN).cycle(512)
    speed = problem.mechanism.speed
    waves = np.fft.fftfreq(512, 1.0 / 512.0)

    def rate(name: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        found = np.fft.ifft(1j * waves * np.fft.fft(table[name].to_numpy())).real
        return np.asarray(speed * found)

    for name, of in (
        ("slider_velocity_m_s", "slider_position_m"),
        ("slider_acceleration_m_s2", "slider_velocity_m_s"),
        ("slider_jerk_m_s3", "slider_acceleration_m_s2"),
    ):
        size = float(table[name].abs().max())
        np.testing.assert_allclose(table[name], rate(of), atol=1e-9 * size, rtol=0.0)
    np.testing.assert_allclose(table["power_W"], speed * table["torque_Nm"], rtol=1e-14)
    np.testing.assert_allclose(
        table["transmission_angle_rad"], np.pi / 2 - np.abs(table["rod_angle_rad"]), rtol=0.0, atol=1e-12
    )
    closing = 0.04 * np.cos(table["crank_angle_rad"]) + 0.1 * np.cos(table["rod_angle_rad"])
    np.testing.assert_allclose(table["slider_position_m"], closing, rtol=1e-13)


def test_jerk_counts_the_acceleration_of_the_crank() -> None:
    of, at = Mechanism(speed=3.0, acceleration=40.0), 1.1
    analysis, h = sc.analyse(of, DESIGN), 1e-6
    # A crank that accelerates evenly: angle and speed a moment before and after.
    times = np.array([-h, h])
    linkage = analysis.linkage
    found = linkage.at(at + 3.0 * times + 20.0 * times**2, speed=3.0 + 40.0 * times, acceleration=40.0)
    slope = np.diff(found.slider_acceleration)[0] / (2.0 * h)
    assert analysis.cycle([at])["slider_jerk_m_s3"].iloc[0] == pytest.approx(slope, rel=1e-7)


def test_cycle_of_a_crank_without_speed_is_by_crank_angle() -> None:
    still = sc.analyse(Mechanism(slider_mass=0.8, gravity=(0.0, -9.81)), DESIGN).cycle(8)
    moving = sc.analyse(Mechanism(slider_mass=0.8, gravity=(0.0, -9.81), speed=1.0), DESIGN).cycle(8)
    for per, name in (
        ("slider_velocity_m_per_rad", "slider_velocity_m_s"),
        ("slider_acceleration_m_per_rad2", "slider_acceleration_m_s2"),
        ("slider_jerk_m_per_rad3", "slider_jerk_m_s3"),
    ):
        np.testing.assert_allclose(still[per], moving[name], rtol=1e-14)
    assert still["power_W"].isna().all()
    assert still["position_error_m"].isna().all()
    assert not still["torque_Nm"].isna().any()


def test_columns_of_the_cycle_are_the_names_and_units_of_the_curves(problem: sc.Problem) -> None:
    analysis = problem.analyse(DESIGN)
    table = analysis.cycle(4)
    curves = cycle_curves(analysis.mechanism, analysis.linkage, table["crank_angle_rad"])
    assert [*table.columns] == [curve.name + curve.kind.si_display_unit.suffix for curve in curves]
    assert isinstance(table, pd.DataFrame)
    for curve in curves:
        np.testing.assert_array_equal(table[curve.name + curve.kind.si_display_unit.suffix], curve.values)
        if curve.name not in ("slider_jerk", "power"):
            assert curve.kind.metric.suffix.strip("_") in curve.field


def test_crank_angles_may_be_any(problem: sc.Problem) -> None:
    table = problem.analyse(DESIGN).cycle([0.5, -7.0])
    assert table["crank_angle_rad"].tolist() == [0.5, -7.0]
    for angles, words in (
        (3, "4 to 100000"),
        ([[0.1]], "a list of real numbers"),
        ([np.nan], "finite"),
        ("all", "got 'all'"),
    ):
        with pytest.raises(InputError, match=words):
            problem.analyse(DESIGN).cycle(angles)


def test_designs_that_are_none_are_refused(problem: sc.Problem) -> None:
    with pytest.raises(AssemblyError, match="rod must exceed"):
        problem.analyse([0.08, 0.1, 0.03])
    wrong: list[Any] = [[0.04, 0.1], [0.04, np.nan, 0.02], [DESIGN], "first", ["40 mm", 0.1, 0.02]]
    for design in wrong:
        with pytest.raises(InputError, match=r"3 (finite )?numbers|real numbers.* of each"):
            problem.analyse(design)


def test_problem_with_choices_is_asked_by_its_parts() -> None:
    found = sc.problem(
        {
            "name": "Catalogue",
            "mechanism": {"speed": "60 rpm", "slider": {"mass": 1.0}},
            "variables": {
                "crank": {"choices": ["40 mm", "50 mm"]},
                "rod": ["100 mm", "200 mm"],
                "offset": "10 mm",
            },
            "objectives": {"peak_torque": "minimise"},
        }
    )
    with pytest.raises(InputError, match=r"use one of problem.parts\(\)"):
        found.analyse(DESIGN)
    with pytest.raises(InputError, match=r"use one of problem.parts\(\)"):
        found.evaluate([DESIGN])
    assert found.parts()[0].analyse(DESIGN)["peak_torque"] > 0.0


def test_it_is_a_mapping_also_where_a_quantity_is_not_defined() -> None:
    found = sc.analyse(Mechanism(), [0.04, 0.1, 0.02])
    assert "position_error" not in found
    assert found.get("position_error") is None
    assert found.get("position_error", 7) == 7
    assert found.get("no such thing", "none") == "none"
    assert found.get("stroke", 0.0) == found["stroke"]
    assert found.cycle(np.int64(4)).equals(found.cycle(4))


def test_a_quantity_without_value_for_a_design_is_undefined_with_a_reason() -> None:
    loads = [{"force": "200 N", "direction": "outward"}, {"force": "100 N", "opposes": "motion"}]
    tables: dict[str, object] = {
        "name": "Driven by its load",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "1 kg"}},
        "load": loads,
        "friction": {"guide": 0.1},
        "variables": {"crank": "40 mm", "rod": "100 mm", "offset": "10 mm"},
        "objectives": {"time_ratio": "maximise"},
    }
    assert 0.0 < sc.problem(tables).analyse([0.04, 0.1, 0.01])["efficiency"] < 1.0
    analysis = sc.problem({**tables, "load": loads[:1]}).analyse([0.04, 0.1, 0.01])
    assert "efficiency" not in analysis
    assert analysis.undefined["efficiency"].startswith("an efficiency needs a load that absorbs or supplies net work")
    assert not any(np.isnan(value) for value in analysis.values())


def test_the_curves_of_a_figure_close() -> None:
    figure = sc.analyse(sc.Mechanism(speed=3.0, slider_mass=1.0), DESIGN).plot()
    for axes in figure.axes:
        angles, values = (np.asarray(part) for part in axes.lines[0].get_data())
        assert (angles[0], angles[-1]) == (0.0, 360.0)
        assert values[-1] == pytest.approx(values[0], rel=1e-9, abs=1e-9)


def test_a_cycle_of_two_turns_is_told_whole() -> None:
    load = {"bore": "54 mm", "compression_ratio": 8, "intake": "1 bar", "peak_pressure": "40 bar", "cycle": "720 deg"}
    engine = sc.problem(
        {
            "name": "Four strokes",
            "mechanism": {"speed": "3000 rpm", "slider": {"mass": "0.3 kg"}, "rod": {"mass": "0.2 kg"}},
            "load": [load],
            "variables": {"crank": "30 mm", "rod": "120 mm", "offset": "2 mm"},
            "objectives": {"peak_torque": "minimise"},
        }
    )
    analysis = engine.analyse([0.03, 0.12, 0.002])
    cycle = analysis.cycle(1440)
    assert cycle["crank_angle_rad"].iloc[-1] == pytest.approx(np.radians(719.5))
    assert cycle["torque_Nm"].abs().max() == pytest.approx(analysis["peak_torque"], rel=1e-3)
    assert cycle["torque_Nm"].mean() == pytest.approx(analysis["mean_torque"], rel=1e-3)
    figure = analysis.plot()
    angles, torque = (np.asarray(part) for part in figure.axes[3].lines[0].get_data())
    assert angles[-1] == 720.0
    assert np.abs(torque).max() == pytest.approx(analysis["peak_torque"], rel=1e-2)


@pytest.mark.parametrize("angles", [1.0, "360", True, [[0.0, 1.0]], [1j], None])
def test_crank_angles_that_are_none_are_refused(angles: Any) -> None:
    with pytest.raises(InputError, match="crank angle"):
        sc.analyse(sc.Mechanism(speed=3.0), DESIGN).cycle(angles)


def swinging() -> sc.Analysis:
    """Return a design whose crank swings within two seconds, driven by a torque."""
    tables: dict[str, Any] = {
        "name": "Swing",
        "mechanism": {"slider": {"mass": "3 kg"}},
        "load": [{"force": "40 N", "opposes": "motion"}],
        "motion": {"kind": "swing", "from": "30 deg", "to": "110 deg", "law": "harmonic", "duration": "2 s"},
        "variables": {"crank": ["30 mm", "60 mm"], "rod": ["120 mm", "200 mm"], "offset": "10 mm"},
        "objectives": {"peak_actuator_torque": "minimise", "swing_transmission_angle": "maximise"},
    }
    return sc.problem(tables).analyse([0.05, 0.15, 0.01])


def test_curves_of_a_swing_are_consistent_with_themselves_and_its_quantities() -> None:
    analysis = swinging()
    curves = analysis.cycle(4000)
    time, forth = curves["time_s"], curves["way"] == "forth"
    assert len(curves) == 4000
    assert forth.sum() == 2001
    assert curves["crank_angle_rad"].iloc[[0, 2000]].tolist() == pytest.approx(np.radians([30.0, 110.0]))
    for value, rate in (("crank_angle_rad", "crank_speed_rad_s"), ("slider_position_m", "slider_velocity_m_s")):
        inside = slice(1, 2000)
        slope = np.gradient(curves[value], time)[inside]
        assert slope == pytest.approx(curves[rate].to_numpy()[inside], abs=1e-5 * np.abs(curves[rate]).max())
    power = curves["drive_Nm"] * curves["crank_speed_rad_s"]
    assert curves["power_W"].to_numpy() == pytest.approx(power.to_numpy())
    assert np.abs(curves["drive_Nm"]).max() == pytest.approx(analysis["peak_actuator_torque"], rel=1e-5)
    assert "slider_position_error_m" not in curves  # no tolerances


def test_a_figure_of_a_swing_has_both_strokes() -> None:
    axes = swinging().plot().axes
    assert [axis.get_ylabel().partition(",")[0] for axis in axes][-1] == "torque on the crank"
    assert [len(axis.lines) for axis in axes] == [2, 2, 2, 2]


@pytest.mark.parametrize("points", [[0.0, 1.0], 7, 2, 10**6])
def test_points_of_a_swing_that_are_none_are_refused(points: Any) -> None:
    with pytest.raises(InputError, match="the same number in both strokes; got"):
        swinging().cycle(points)


def test_measured_curves_of_a_swing_are_refused_because_it_passes_each_angle_twice() -> None:
    with pytest.raises(InputError, match="which passes each angle twice"):
        swinging().deviations({"crank_angle_deg": [40.0], "slider_position_mm": [150.0]})
