"""`slidercrank export` of one design, drawing and motion, and `slidercrank report`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from ezdxf.filemanagement import readfile

from slidercrank.service.render.numerals import format_cell
from slidercrank.service.runs.result import rows_from_csv
from tests.service.conftest import Command


def test_a_design_is_written_in_all_ways_at_once(kept: Path, tmp_path: Path, command: Command) -> None:
    names = {option: tmp_path / f"a.{option}" for option in ("dxf", "svg", "gif")} | {"motion": tmp_path / "a.html"}
    options = [part for name, file in names.items() for part in (f"--{name}", file)]
    done = command("export", "latest", "--runs", kept, "--design", 3, *options, "--csv", tmp_path / "a.csv")
    assert (done.exit_code, done.stdout) == (0, ""), done.stderr
    assert done.stderr.count("design 3") == 4
    designs = json.loads(command("front", "latest", "--runs", kept, "--json").stdout)["designs"]
    document = readfile(names["dxf"])
    assert document.audit().errors == []
    radii = [circle.dxf.radius for circle in document.modelspace().query('CIRCLE[layer=="PATHS"]')]
    assert radii == [pytest.approx(designs[2]["crank_mm"], rel=1e-12)]
    assert "Short test [job], design 3" in names["svg"].read_text(encoding="utf-8")
    assert "Short test [job], design 3" in names["motion"].read_text(encoding="utf-8")
    assert names["gif"].read_bytes()[:6] == b"GIF89a"
    assert (tmp_path / "a.csv").read_text().startswith("number,crank_mm")


def test_the_knee_and_a_crank_angle_may_be_asked_for(kept: Path, tmp_path: Path, command: Command) -> None:
    front = json.loads(command("front", "latest", "--runs", kept, "--json").stdout)
    done = command(
        *("export", "latest", "--runs", kept, "--knee", "--at", "100 deg", "--svg", tmp_path / "knee.svg"),
    )
    assert done.exit_code == 0
    text = (tmp_path / "knee.svg").read_text(encoding="utf-8")
    assert f"design {front['knee'] + 1}<" in text
    assert "Drawn at crank angle 100 deg" in text


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--dxf", "a.dxf"), "choose one design with --design NO, --knee"),
        (("--dxf", "a.dxf", "--design", 99), "the run has designs 1 to 8; got 99"),
        (("--dxf", "a.dxf", "--design", 0), "the run has designs 1 to 8; got 0"),
        (("--dxf", "a.dxf", "--design", 1, "--knee"), "a design must be chosen in one way"),
        (("--dxf", "a.dxf", "--knee", "--topsis", "time_ratio=1"), "a design must be chosen in one way"),
        (("--design", 1), "one design needs at least one of --dxf, --svg, --motion, --gif, --cycle"),
        (("--design", 1, "--csv", "a.csv"), "one design needs at least one of --dxf, --svg, --motion, --gif, --cycle"),
        (("--csv", "a.csv", "--at", "5 deg"), "--at needs --dxf or --svg"),
        (("--design", 1, "--svg", "a.svg", "--at", "5"), "--at must be an angle with its unit"),
        (("--design", 1, "--gif", "-"), "--gif must name a file"),
        (("--design", 1, "--cycle", "-"), "--cycle must name a file"),
        (("--cycle", "a.csv"), "choose one design with --design NO, --knee"),
        (("--design", 1, "--cycle", "a.csv", "--sort", "crank"), "--sort and --reverse need --csv or --json"),
        (("--design", 1, "--cycle", "a.csv", "--where", "stroke > 1 mm"), "a design must be chosen in one way"),
        (("--design", 1, "--dxf", "x.dwg"), "the file of --dxf must end with .dxf; got x.dwg; name it x.dxf"),
        (("--design", 1, "--svg", "x.png"), "name it x.svg"),
        (("--design", 1, "--motion", "x.gif"), "the file of --motion must end with .html or .htm; got x.gif"),
        (("--design", 1, "--gif", "x.webp"), "name it x.gif"),
        (("--csv", "x.xlsx"), "the file of --csv must end with .csv; got x.xlsx; name it x.csv"),
        (("--json", "x.csv"), "name it x.json"),
        (("--csv", "a.csv", "--sort", "torqe"), "did you mean"),
        (("--design", 1, "--svg", "none/there/a.svg"), "must be a writable folder"),
    ],
)
def test_a_wrong_request_is_exit_code_2_and_writes_nothing(
    arguments: tuple[object, ...],
    words: str,
    kept: Path,
    tmp_path: Path,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    done = command("export", "latest", "--runs", kept, *arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_cycle_of_a_design_is_written_by_export_and_by_analyse(
    kept: Path, tmp_path: Path, command: Command
) -> None:
    of_export, of_analyse = tmp_path / "export.csv", tmp_path / "analyse.csv"
    done = command("export", "latest", "--runs", kept, "--design", 3, "--cycle", of_export)
    assert (done.exit_code, done.stdout) == (0, ""), done.stderr
    done = command("analyse", "latest", "--runs", kept, "--design", 3, "--cycle", of_analyse, "--json")
    assert done.exit_code == 0, done.stderr
    assert of_export.read_bytes() == of_analyse.read_bytes()
    rows = rows_from_csv(of_export.read_text())
    front = json.loads(command("front", "latest", "--runs", kept, "--design", 3, "--json").stdout)
    (design,) = front["designs"]
    assert json.loads(done.stdout)["peak_torque_Nm"] == pytest.approx(design["peak_torque_Nm"], rel=1e-12)
    assert [row["crank_angle_deg"] for row in rows] == pytest.approx(range(360))
    stroke = max(row["slider_position_mm"] for row in rows) - min(row["slider_position_mm"] for row in rows)  # type: ignore[operator, type-var]
    assert stroke == pytest.approx(design["stroke_mm"], rel=1e-3)
    torque = max(abs(row["torque_Nm"]) for row in rows)  # type: ignore[arg-type]
    assert 0.98 * design["peak_torque_Nm"] <= torque <= design["peak_torque_Nm"] * (1.0 + 1e-9)


def test_a_cycle_without_a_machine_is_motion_alone(tmp_path: Path, command: Command) -> None:
    file = tmp_path / "cycle.csv"
    done = command("analyse", "--crank", "40 mm", "--rod", "64 mm", "--offset", "20 mm", "--cycle", file)
    assert done.exit_code == 0, done.stderr
    header = file.read_text().splitlines()[0].split(",")
    assert {"crank_angle_deg", "slider_position_mm", "transmission_angle_deg"} <= set(header)
    assert not [key for key in header if "torque" in key or key.endswith("_N")]
    inch = tmp_path / "inch.csv"
    lengths = ("--crank", "40 mm", "--rod", "64 mm", "--offset", "20 mm")
    assert command("analyse", *lengths, "--cycle", inch, "--units", "inch").exit_code == 0
    for one, other in zip(rows_from_csv(file.read_text()), rows_from_csv(inch.read_text()), strict=True):
        assert one["slider_position_mm"] == pytest.approx(25.4 * other["slider_position_in"], rel=1e-12)  # type: ignore[operator]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("latest", "--design", 99), "the run has designs 1 to 8; got 99"),
        (("--design", 1), "--design needs a run; got none"),
        (("latest", "--design", 1, "--crank", "40 mm"), "got --design and --crank; leave out one"),
        (("latest", "--design", 1, "--set", "mechanism.speed=1 rpm"), "got --design and --set"),
        (("nothing", "--design", 1), "there is no run 'nothing'"),
        (("latest", "--design", 1, "--cycle", "-"), "--cycle must name a file"),
        (("latest", "--design", 1, "--cycle", "none/there/a.csv"), "must be a writable folder"),
    ],
)
def test_a_wrong_analysis_of_a_run_is_refused(
    arguments: tuple[object, ...],
    words: str,
    kept: Path,
    tmp_path: Path,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    done = command("analyse", "--runs", kept, *arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_report_is_written_as_html_and_as_pdf(
    kept: Path, tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    front = json.loads(command("front", "latest", "--runs", kept, "--json").stdout)
    done = command("report", "latest", "--runs", kept, "--design", 3)
    assert (done.exit_code, done.stdout) == (0, ""), done.stderr
    (file,) = tmp_path.iterdir()
    assert file.name.endswith("short-test-job-design-3.html")
    assert done.stderr == f"report: {file.name}\n"
    page = file.read_text(encoding="utf-8")
    assert all(format_cell(value) in page for value in front["designs"][2].values() if isinstance(value, float))
    assert "Trade-offs here, to first order: " in page
    assert "<script" not in page
    monkeypatch.setattr("slidercrank.service.report.pdf.pdf_file", lambda report: report.title.encode())
    number = front["knee"] + 1
    for arguments, name in (
        (("--out", "knee.PDF"), "knee.PDF"),
        (("--pdf",), file.name.replace("3.html", f"{number}.pdf")),
    ):
        done = command("report", "latest", "--runs", kept, "--knee", *arguments)
        assert done.exit_code == 0, done.stderr
        assert (tmp_path / name).read_bytes() == f"Short test [job]: design {number} of 8".encode()


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ((), 2, "choose one design with --design NO"),
        (("--design", 9), 2, "the run has designs 1 to 8; got 9"),
        (("--design", 1, "--where", "time_ratio > 1"), 2, "a design must be chosen in one way"),
        (("--knee", "--where", "time_ratio > 9"), 3, "none of the 8 designs meets time_ratio > 9"),
        (("--knee", "--pdf", "--out", "a.html"), 2, "with --pdf the file name must end in .pdf; got --out a.html"),
        (("--knee", "--out", "a.docx"), 2, "the file of --out must end with .html or .htm or .pdf; got a.docx"),
        (("--knee", "--out", "none/there/a.html"), 2, "must be a writable folder"),
    ],
)
def test_a_report_that_cannot_be_written_is_refused(
    arguments: tuple[object, ...],
    code: int,
    words: str,
    kept: Path,
    tmp_path: Path,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    done = command("report", "latest", "--runs", kept, *arguments)
    assert (done.exit_code, done.stdout) == (code, "")
    assert words in done.stderr
    assert list(tmp_path.iterdir()) == []
