"""Loads from files: as if their points stood in the job; any zero, order and unit; thinned within a bound."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.loads.load import Load
from slidercrank.optimise.job import load_job, needed_files, parse_job, read_job, with_file_contents
from slidercrank.optimise.job.curve_file import MOST_POINTS, SHARE
from slidercrank.optimise.job.job_notes import file_summaries

RANGES = {"crank": ["20 mm", "80 mm"], "rod": ["120 mm", "300 mm"], "offset": ["0 mm", "60 mm"]}


def job(load: dict[str, Any], speed: str = "60 rpm", **parts: Any) -> dict[str, Any]:
    return {
        "name": "Trace",
        "mechanism": {"speed": speed, "slider": {"mass": "1 kg"}},
        "load": [load],
        "variables": RANGES,
        "objectives": {"peak_torque": "minimise"},
        **parts,
    }


def read(text: str | bytes, speed: str = "60 rpm", **keys: Any) -> Load:
    """Return the load of a file that is sent with a job."""
    filled = with_file_contents(job({"file": "trace.csv", **keys}, speed), {"trace.csv": text})
    return parse_job(filled).mechanism.loads[0]


def given(**keys: Any) -> Load:
    return parse_job(job(keys)).mechanism.loads[0]


ANGLES = ["0 deg", "90 deg", "200 deg"]
FORCES = ["-20 N", "0 N", "5 N"]


@pytest.mark.parametrize(
    ("text", "keys", "same"),
    [
        ("crank angle (deg);force (N)\n0;-20\n90;0\n200;5\n", {}, {"crank_angles": ANGLES, "forces": FORCES}),
        ("force_N,angle_deg\n-20,0\n0,90\n5,200\n", {}, {"crank_angles": ANGLES, "forces": FORCES}),
        (
            "Winkel [°]\tKraft [kN]\tNote\n0\t-0,02\ta\n90\t0\tb\n200\t0,005\t\n",
            {},
            {"crank_angles": ANGLES, "forces": FORCES},
        ),
        (
            "position [mm];force [N]\n60;-20\n30;0\n0;5\n",
            {"measured_from": "outer dead centre", "during": "outward stroke"},
            {
                "positions": ["0 mm", "30 mm", "60 mm"],
                "forces": FORCES[::-1],
                "measured_from": "outer dead centre",
                "during": "outward stroke",
            },
        ),
        (
            "angle_deg torque_Nm\n0 -20\n90 0\n200 5\n",
            {},
            {"torque_angles": ANGLES, "torques": ["-20 N m", "0 N m", "5 N m"]},
        ),
        (
            "angle_deg,pressure_bar,# note\n0,8,x\n180,1,y\n",
            {"bore": "70 mm"},
            {"pressure_angles": ["0 deg", "180 deg"], "pressures": ["8 bar", "1 bar"], "bore": "70 mm"},
        ),
        (
            "z (mm),p (bar)\n0,8\n50,1\n",
            {"bore": "70 mm"},
            {"pressure_positions": ["0 mm", "50 mm"], "pressures": ["8 bar", "1 bar"], "bore": "70 mm"},
        ),
    ],
)
def test_the_columns_say_which_table_a_file_is(text: str, keys: dict[str, Any], same: dict[str, Any]) -> None:
    assert read(text, **keys) == given(**same)


def test_angles_may_be_radians_begin_anywhere_wrap_and_repeat_the_first_point() -> None:
    expected = given(crank_angles=["100 deg", "200 deg", "300 deg", "370 deg"], forces=["1 N", "2 N", "-3 N", "0 N"])
    rows = [(100, 1), (200, 2), (300, -3), (10, 0)]
    for lines in (rows, [*rows, (100, 1)]):
        text = "angle_deg,force_N\n" + "\n".join(f"{a},{b}" for a, b in lines)
        assert read(text).knots() == expected.knots()
        turned = "angle (rad),force (N)\n" + "\n".join(f"{math.radians(a)!r},{b}" for a, b in lines)
        for values, same in zip(read(turned).knots(), expected.knots(), strict=True):
            np.testing.assert_allclose(values, same, rtol=1e-13, atol=1e-13)


def test_a_time_is_a_crank_angle_at_the_speed_of_the_job() -> None:
    times = "time_ms,force_N\n" + "\n".join(f"{t},{f}" for t, f in ((0, 1), (250, 2), (500, -3), (1000, 1)))
    expected = {"crank_angles": ["0 deg", "90 deg", "180 deg", "360 deg"], "forces": ["1 N", "2 N", "-3 N", "1 N"]}
    assert read(times) == given(**expected)
    assert read(times, "-60 rpm", measured_from="inner dead centre") == given(
        **expected, measured_from="inner dead centre"
    )
    backwards = given(crank_angles=["-360 deg", "-180 deg", "-90 deg", "0 deg"], forces=["1 N", "-3 N", "2 N", "1 N"])
    assert read(times, "-60 rpm") == backwards
    # A record of a little more than a turn, as times always are: its first turn counts.
    longer = "time_s,force_N\n" + "\n".join(f"{0.01 * n:.2f},{n % 100}" for n in range(130))
    first = read(longer, cycle="360 deg")
    assert first.knots()[1] == [*map(float, range(100)), 0.0] or list(first.knots()[1]) == [*range(100), 0.0]
    for tables, words in (
        ({"mechanism": {"cycle_time": "1 s", "speed_profile": {"cosines": [0.1]}}}, "needs a constant crank speed"),
        ({"mechanism": {}}, "needs the crank speed; got none"),
        ({"variables": {**RANGES, "mechanism.speed": ["30 rpm", "60 rpm"]}}, "needs a constant crank speed"),
    ):
        with pytest.raises(JobError, match=words):
            with_file_contents(job({"file": "a.csv"}) | tables, {"a.csv": times})


def test_a_file_of_two_turns_has_a_cycle_of_720_deg() -> None:
    rows = [(a, math.sin(math.radians(0.5 * a))) for a in range(0, 720, 5)]
    text = "angle_deg,force_N\n" + "\n".join(f"{a},{f!r}" for a, f in rows)
    same = {"crank_angles": [f"{a} deg" for a, _ in rows], "forces": [f"{f!r} N" for _, f in rows]}
    assert read(text) == read(text, cycle="720 deg") == given(**same, cycle="720 deg")
    again = "angle_deg,force_N\n" + "\n".join(f"{a % 360},{f!r}" for a, f in rows)  # a counter that begins again
    assert read(again) == read(text)
    first = {key: values[:72] for key, values in same.items()}
    assert read(text, cycle="360 deg") == given(**first)
    with pytest.raises(JobError, match=r"must cover one or two turns unless the job gives the cycle; got 1\.319 turns"):
        read("\n".join(text.splitlines()[:97]))


def noisy(random: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a press-like trace: a smooth part, two steps and some noise."""
    at = np.arange(count) * 360.0 / count
    force = -2000.0 * (1.0 + np.sin(np.radians(at)) ** 3) + random.uniform(0.0, 8.0) * random.normal(size=count)
    force[(at > 100.0) & (at < 130.0)] -= 6e4
    return at, force


@pytest.mark.parametrize("seed", range(4))
def test_a_long_table_is_thinned_within_the_stated_bound_and_its_steps_stay(seed: int) -> None:
    random = np.random.default_rng([35, seed])
    at, force = noisy(random, 3600)
    step = int(random.integers(10, 3590))
    at[step] = at[step - 1]  # two points at one place
    text = "angle_deg,force_N\n" + "\n".join(f"{a!r},{f!r}" for a, f in zip(at.tolist(), force.tolist(), strict=True))
    data = with_file_contents(job({"file": "trace.csv"}), {"trace.csv": text})
    angles, forces = map(np.array, parse_job(data).mechanism.loads[0].knots())
    kept = np.degrees(angles[:-1])
    assert 2 <= len(kept) < 2000
    again = int(np.flatnonzero(np.diff(kept) == 0.0)[0])
    assert forces[[again, again + 1]].tolist() == force[[step - 1, step]].tolist()
    bound = SHARE * np.ptp(force)
    for part in (slice(0, step), slice(step, None)):  # with an interpolation that knows of no step
        own = (kept <= at[part][-1] + 1e-9) & (kept >= at[part][0] - 1e-9)
        own[again + (part.start == 0)] = False
        error = np.abs(np.interp(at[part], kept[own], forces[:-1][own]) - force[part])
        assert error.max() <= bound * (1.0 + 1e-9)
    (said,) = file_summaries(data)
    assert f"3,600 rows of angle_deg, force_N; first 0, {force[0]:.6g}; last 359.9, {force[-1]:.6g}" in said
    assert f"{len(kept):,} points kept; no value changes by more than {bound:.3g} N, 0.05 % of its range" in said


def test_a_thousand_points_stay_as_they_are() -> None:
    at, force = noisy(np.random.default_rng(3), MOST_POINTS)
    lines = [f"{a!r},{f!r}" for a, f in zip(at.tolist(), force.tolist(), strict=True)]
    angles, forces = read("\n".join(["angle_deg,force_N", *lines])).knots()
    assert forces[:-1] == tuple(force.tolist())
    np.testing.assert_array_equal(angles[:-1], [float(np.float64(a)) for a in angles[:-1]])
    assert len(angles) == MOST_POINTS + 1


def test_a_thinned_load_changes_quantities_by_no_more_than_the_bound_allows() -> None:
    at, force = noisy(np.random.default_rng(8), 3600)
    lines = [f"{a!r},{f!r}" for a, f in zip(at.tolist(), force.tolist(), strict=True)]
    thin = parse_job(
        with_file_contents(
            job({"file": "a.csv"}, objectives={"rms_torque": "minimise"}),
            {"a.csv": "\n".join(["angle_deg,force_N", *lines])},
        )
    )
    keys = {"crank_angles": [f"{a!r} deg" for a in at.tolist()], "forces": [f"{f!r} N" for f in force.tolist()]}
    whole = parse_job(job(keys, objectives={"rms_torque": "minimise"}))
    assert len(whole.mechanism.loads[0].knots()[0]) == 3601
    random = np.random.default_rng(9)
    designs = np.column_stack(
        [random.uniform(0.03, 0.07, 20), random.uniform(0.2, 0.3, 20), random.uniform(0, 0.05, 20)]
    )
    differ = np.abs(thin.evaluate(designs) - whole.evaluate(designs))[:, 0]
    # RMS of differences, each |dT| = |dF dx/dtheta|, and |dx/dtheta| <= r (1 + tan of the greatest rod angle)
    crank, rod, offset = designs.T
    slope = crank * (1.0 + np.tan(np.arcsin((crank + offset) / rod)))
    assert (differ <= SHARE * np.ptp(force) * slope).all()
    assert differ.max() > 0.0


@pytest.mark.parametrize(
    ("text", "keys", "words"),
    [
        (
            "angle,force_N\n0,1\n9,2",
            {},
            r"one column of a length \(mm\) or an angle \(deg\) or a time \(s\), with its unit",
        ),
        (
            "time_s,position_mm,force_N\n0,1,2\n1,2,3",
            {},
            r'got "time_s" and "position_mm"; let the names of the others',
        ),
        ("angle_deg,F1_N,F2_N\n0,1,2\n9,2,3", {}, r'got "F1_N" and "F2_N"; let the names of the others begin with #'),
        ("angle_deg,force_N,torque_Nm\n0,1,2\n9,2,3", {}, r'got "force_N" and "torque_Nm"; let the names'),
        ("position_mm,torque_Nm\n0,1\n9,2", {}, "must be a table of a load; .* give torques over the crank angle"),
        ("position_mm,force_N\n0,1\n9,2\n5,3", {}, '"position_mm" must increase; got 5 after 9; sort the rows'),
        ("angle_deg,force_N\n0,1\n9,2\n9,3\n9,4", {}, "must increase, except for two equal ones at a step"),
        ("angle_deg,force_N\n0,1\n9,", {}, 'row 3, column "force_N": must be a number; got an empty cell'),
        ("angle_deg,force_N\n0,1\n9,2", {"forces": ["1 N"]}, "#1.forces: a load with file must not have this key"),
        ("crank angle (mm),force (N)\n0,1\n9,2", {}, 'column "crank angle .mm.": must have the unit of an angle'),
        ("angle in deg,torque in N\n0,1\n9,2", {}, "must have the unit of a torque, .* got N, which is a force"),
        ("angle_deg,pressure_N\n0,1\n9,2", {}, "must have the unit of a pressure, .* got N, which is a force"),
        ("angle_deg,force_N\n0,1", {}, "must have at least two points; got 1; add rows"),
        ("angle_deg,force_N\n0,1\n0,1", {}, "must have at least two points; got 1; add rows"),
        ("Winkel [Grad];Kraft [N]\n0;1\n9;2", {}, 'the unit "Grad" is not known; write deg'),
        ("angle (Deg),force (N)\n0,1\n9,2", {}, 'the unit "Deg" is not known; write deg'),
        ("angle_deg,force_KN\n0,1\n9,2", {}, 'the unit "KN" is not known; write kN'),
        ("angle_deg,force (n)\n0,1\n9,2", {}, 'the unit "n" is not known; write N'),
        ("angle_deg,#force (N)\n0,1\n9,2", {}, "name the unit"),
    ],
)
def test_a_file_that_could_mean_something_else_is_refused(text: str, keys: dict[str, Any], words: str) -> None:
    with pytest.raises(JobError, match=words):
        read(text, **keys)


@pytest.mark.parametrize(
    "heads",
    [
        "crank angle in deg;force in N",
        "crank_angle_in_deg;force_in_N",
        "Winkel in deg;Kraft (in N)",
        "angle (deg);force [N] (filtered)",
        "angle (deg);force_N (raw)",
    ],
)
def test_units_stand_after_in_and_among_other_brackets(heads: str) -> None:
    rows = "\n0;-20\n90;0\n200;5\n"
    assert read(heads + rows) == given(crank_angles=ANGLES, forces=FORCES)
    torques = {"torque_angles": ANGLES, "torques": [f.replace("N", "lbf in") for f in FORCES]}
    for torque in ("torque in lbf", "M (in-lbf)", "torque_lbf_in"):
        assert read(f"angle_deg;{torque}{rows}") == given(**torques)


def test_a_coarse_record_between_one_turn_and_two_is_refused_and_two_turns_are_reported() -> None:
    with pytest.raises(JobError, match=r"must cover one or two turns .* got 1\.4 turns"):
        read("time_s,force_N\n0,1\n0.1,2\n0.3,3\n0.7,4\n", "120 rpm")
    data = with_file_contents(job({"file": "a.csv"}), {"a.csv": "angle_deg,force_N\n0,1\n180,2\n360,3\n540,4\n"})
    assert data["load"][0]["cycle"] == "720 deg"
    assert file_summaries(data)[0].endswith("two turns, a cycle of 720 deg")


def test_a_file_and_a_force_in_one_load_are_refused_before_the_file_is_read() -> None:
    with pytest.raises(JobError, match=r'load #1\.force: a load with file must not have this key; got "3 N"; possible'):
        with_file_contents(job({"file": "a.csv", "force": "3 N"}), {"a.csv": "angle_deg,force_N\n0,1\n9,2"})


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("0,60\n90,61", r"must have at least [34] different points; got 2; add rows"),
        ("0,60\n90,61\n360,60", r"must have at least [34] different points; got 2; add rows"),
        ("0,60\n90,61\n90,62\n180,60", '"angle_deg" must increase; got 90 deg twice; leave out one of the two'),
    ],
)
def test_refusals_of_a_profile_or_a_motion_name_its_file(rows: str, words: str) -> None:
    motion = job({}, target_motion={"file": "a.csv"})
    profile = job({}, mechanism={"speed": "60 rpm", "speed_profile": {"file": "a.csv"}})
    for data, head in ((motion, "position_mm"), (profile, "speed_rpm")):
        with pytest.raises(JobError, match=rf'file: "a\.csv":? {words}'):
            with_file_contents(data, {"a.csv": f"angle_deg,{head}\n{rows}\n"})


def test_a_file_beside_a_job_is_read_named_and_told(tmp_path: Path) -> None:
    (tmp_path / "trace.csv").write_bytes("Winkel [°];Kraft [N]\n0;-2\n90;1.000,5\n".encode("latin-1"))
    (tmp_path / "job.toml").write_text(
        'name = "Trace"\nmechanism = { speed = "60 rpm", slider = { mass = "1 kg" } }\n'
        'load = [{ file = "trace.csv" }]\n[objectives]\npeak_torque = "minimise"\n'
        '[variables]\ncrank = "50 mm"\nrod = ["120 mm", "300 mm"]\noffset = "0 mm"\n',
        encoding="utf-8",
    )
    loads = load_job(tmp_path / "job.toml").mechanism.loads
    assert loads == (given(crank_angles=["0 deg", "90 deg"], forces=["-2 N", "1000.5 N"]),)
    assert needed_files(tmp_path / "job.toml") == [tmp_path / "trace.csv"]
    assert file_summaries(read_job(tmp_path / "job.toml")) == [
        "load #1, trace.csv: 2 rows of Winkel [°], Kraft [N]; first 0, -2; last 90, 1000.5; separated by semicolons; "
        "decimal comma"
    ]
    with pytest.raises(JobError, match="load #1: a file must be in the folder of the job file, or be sent"):
        parse_job(job({"file": "trace.csv"}))
    with pytest.raises(
        JobError, match=re.escape('load #1.file: "a.csv" not found among the files sent with the job (b.csv)')
    ):
        with_file_contents(job({"file": "a.csv"}), {"b.csv": ""})
    assert parse_job(with_file_contents(job({"file": "trace.csv"}), tmp_path)).mechanism.loads == loads
