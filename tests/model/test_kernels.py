"""Kernels: as the Python functions they are written as, without numba, from disk, compiled once, never stale."""

from __future__ import annotations

import errno
import json
import os
import re
import resource
import subprocess
import sys
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from threading import Thread
from types import FunctionType, ModuleType
from typing import Any

import numba
import numpy as np
import psutil
import pytest
from numba.core import event

from slidercrank.model.errors import SlidercrankError
from slidercrank.model.kernel import compile_all, compiler, disk_cache
from slidercrank.model.kernel.arithmetic import arcsine
from slidercrank.model.kernel.batches import interrupted_by
from slidercrank.model.kernel.compile_all import compile_missing
from slidercrank.model.kernel.disk_cache import (
    KernelSource,
    read_machine_code,
    report_compilation_progress,
    store_machine_code,
)
from slidercrank.model.kernel.kernel import KERNELS, Integers, Kernel, Row, Table, kernel
from slidercrank.model.kernel.kernel_digest import kernel_digest
from slidercrank.model.kernel.machine_code import Leaf, MachineCode, load_entry_point
from slidercrank.model.kinematics import closed_forms
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.cases import random_designs, random_friction, random_machine

SOURCE = """
import sys
from slidercrank.model.kernel.arithmetic import analytic
from slidercrank.model.kernel.kernel import kernel

@analytic
def twice(x):
    return 2.0 * x

@kernel
def four_times(x: float) -> float:
    return twice(twice(x))

if __name__ == "__main__":
    import program
    print(sum(program.four_times(float(x)) for x in range(3)), "numba" in sys.modules)
"""


@pytest.fixture
def program(tmp_path: Path) -> list[str]:
    """Return a command that runs a kernel of its own."""
    (tmp_path / "program.py").write_text(SOURCE)
    return [sys.executable, str(tmp_path / "program.py")]


def started(command: list[str], cache: Path) -> subprocess.Popen[str]:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.slow
def test_a_kernel_that_several_processes_need_is_compiled_and_told_once(program: list[str], tmp_path: Path) -> None:
    running = [started(program, tmp_path) for _ in range(4)]
    said = [process.communicate() for process in running]
    assert [process.returncode for process in running] == [0] * 4, said
    assert {output for output, _ in said} == {"12.0 False\n"}
    lines = [line for _, messages in said for line in messages.splitlines()]
    # On a busy machine they are told how far it is, too.
    told = [
        line for line in lines if not re.fullmatch(r".* its formulas: 0 of 1 done, now four_times; \d+ s so far", line)
    ]
    assert told == ["slidercrank is compiling its formulas (only once after installation)"]
    assert len(list((tmp_path / "slidercrank/kernels").glob("program.four_times.*"))) == 2  # and a lock
    again = started(program, tmp_path)
    assert again.communicate() == ("12.0 False\n", "")


@pytest.mark.slow
def test_compiling_ahead_is_told_by_who_waits_for_it(program: list[str], tmp_path: Path) -> None:
    begin = "from slidercrank.model.kernel.disk_cache import compile_ahead; compile_ahead('program', ['program'])"
    source = SOURCE.replace("    print(", f"    {begin}\n    print(")
    Path(program[-1]).write_text(source)
    found, said = started(program, tmp_path).communicate()
    assert found == "12.0 False\n"
    assert said.splitlines()[0] == "slidercrank is compiling its formulas (only once after installation)"
    assert said.count("once after installation") == 1
    Path(program[-1]).write_text(source.replace("    print(", "    sys.exit(3)\n    print("))
    for folder in (tmp_path, tmp_path / "empty"):  # where it is there already, and where nobody waits for it
        ended = started(program, folder)
        assert ended.communicate() == ("", "")
        assert ended.returncode == 3


def test_progress_stays_on_one_line_of_a_notebook(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    report_compilation_progress("1 of 2 done")
    assert caplog.messages == ["1 of 2 done"]
    monkeypatch.setitem(sys.modules, "ipykernel", ModuleType("ipykernel"))
    capsys.readouterr()
    for text in ("0 of 2 done, now long_name", "1 of 2 done"):
        report_compilation_progress(text)
    first, second = capsys.readouterr().err.split("\r")[1:]
    assert (first.rstrip(), second.rstrip()) == ("0 of 2 done, now long_name", "1 of 2 done")
    assert len(first) == len(second)
    assert caplog.messages == ["1 of 2 done"]


def test_a_kernel_is_compiled_where_nothing_can_be_kept_and_no_process_started(
    program: list[str], tmp_path: Path
) -> None:
    (tmp_path / "cache").write_text("a file")
    (tmp_path / "home").write_text("another one")
    environment = {"XDG_CACHE_HOME": str(tmp_path / "home"), "TMPDIR": str(tmp_path)}
    command = ["env", *(f"{name}={value}" for name, value in environment.items()), *program]
    found, messages = started(command, tmp_path / "cache").communicate()
    assert found in ("12.0 True\n", "12.0 False\n")
    assert "cannot be written" in messages


def test_on_a_full_disk_a_process_compiles_what_it_needs_and_no_other_is_started_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else all kernels were compiled beside for each that was needed, in vain: no end after ten minutes."""
    code = MachineCode("name", (), (), b"code")
    begun: list[Path] = []
    compiled: list[str] = []
    needed = [of_source(PLAIN.format(**SAME | {"c": float(number)})) for number in range(3)]
    tasks = [compile_all._task_of_kernel(each, tmp_path) for each in needed]

    def compiles(wanted: KernelSource) -> MachineCode:
        compiled.append(wanted.name)
        return code

    monkeypatch.setattr(KernelSource, "compile", compiles)
    monkeypatch.setattr(disk_cache, "kernel_folder", lambda: tmp_path)
    monkeypatch.setattr(disk_cache, "compile_in_processes", lambda *given: begun.append(given[2]))
    monkeypatch.setattr(compile_all, "_tasks_of_packages", lambda *_: tasks)
    write = Path.write_bytes

    def full(file: Path, content: bytes) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    assert [disk_cache.load_or_compile(each.compilation_source()) for each in needed] == [code] * 3
    assert len(begun) == 1
    assert len(compiled) == 3
    compile_missing(tmp_path, "")
    assert len(compiled) == 4  # a compiling process ends after the first that it could not keep
    monkeypatch.setattr(Path, "write_bytes", write)
    compile_missing(tmp_path, "")
    assert len(compiled) == 7
    assert [disk_cache.load_or_compile(each.compilation_source()) for each in needed] == [code] * 3
    assert len(compiled) == 7


def test_a_wait_for_a_kernel_is_interrupted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop() -> None:
        raise TimeoutError

    compiling = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    monkeypatch.setattr(disk_cache, "_start_compilers", lambda *_: [compiling])
    try:
        with interrupted_by(stop), pytest.raises(TimeoutError):
            disk_cache.compile_in_processes(tmp_path, "some.package", tmp_path / "never")
    finally:
        compiling.kill()
        compiling.wait()


def test_who_compiles_ends_with_who_asked_for_it() -> None:
    ends = (
        "import os; from slidercrank.model.kernel.compile_all import end_with_parent; parent = os.getppid();"
        "print(flush=True); end_with_parent(parent)"
    )
    asks = f"""
import os, subprocess, sys
compiling = subprocess.Popen([sys.executable, "-c", {ends!r}], stdout=subprocess.PIPE)
compiling.stdout.readline()
print(compiling.pid, flush=True)
os._exit(0)
"""
    asked = subprocess.run([sys.executable, "-c", asks], stdout=subprocess.PIPE, text=True, check=True)
    with suppress(psutil.NoSuchProcess):
        psutil.Process(int(asked.stdout)).wait(timeout=10.0)


@pytest.mark.parametrize("harm", ["cut", "a bit turned", "no head", "empty"])
def test_a_damaged_file_counts_as_none(harm: str, tmp_path: Path) -> None:
    file = tmp_path / "some.kernel"
    store_machine_code(file, MachineCode("name", ("ptr", "i64"), ("sin",), bytes(range(256))))
    assert read_machine_code(file) == MachineCode("name", ("ptr", "i64"), ("sin",), bytes(range(256)))
    whole = file.read_bytes()
    turned = whole[:-7] + bytes([whole[-7] ^ 4]) + whole[-6:]
    file.write_bytes({"cut": whole[:-1], "a bit turned": turned, "no head": whole[20:], "empty": b""}[harm])
    assert read_machine_code(file) is None


def test_of_earlier_machine_codes_the_last_ones_stay(tmp_path: Path) -> None:
    for number in range(12):
        file = tmp_path / f"module.kernel.{number:02d}"
        store_machine_code(file, MachineCode("name", (), (), b"code"))
        os.utime(file, (number, number))
    store_machine_code(tmp_path / "module.other.00", MachineCode("name", (), (), b"code"))
    assert sorted(file.name for file in tmp_path.glob("module.kernel.*"))[-1] == "module.kernel.11"
    assert len(list(tmp_path.glob("module.kernel.*"))) == disk_cache._STATES
    assert len(list(tmp_path.glob("*.unfinished"))) == 0


def test_a_function_that_is_not_there_is_said_and_not_called() -> None:
    with pytest.raises(SlidercrankError, match="no_such_function"):
        load_entry_point(MachineCode("name", (), ("sin", "no_such_function"), b""), [])


def test_a_kernel_that_takes_other_arguments_is_said_and_not_called() -> None:
    with pytest.raises(SlidercrankError, match="must take the types that it declares"):
        load_entry_point(MachineCode("name", ("i64", "i64"), (), b""), [Leaf("double"), Leaf("i64")])


def of_source(source: str) -> Kernel:
    names: dict[str, Any] = {"kernel": kernel, "Row": Row, "__name__": "made"}
    exec(source, names)
    found: Kernel = names["f"]
    KERNELS.remove(found)
    return found


PLAIN = """
c = {c}
def g(x):
    return {inner}

@kernel
def f(x: float) -> float:
    {comment}
    return c * g(x) + {k}
"""
SAME = {"c": 2.0, "inner": "x", "comment": "y = 1", "k": 1.0}


@pytest.mark.parametrize(
    ("change", "same"),
    [
        ({}, True),
        ({"comment": "# a word\n\n    y = 1"}, True),
        ({"c": 3.0}, False),
        ({"c": -2.0}, False),
        ({"c": "(2.0)"}, True),
        ({"inner": "-x"}, False),
        ({"inner": "1.0 * x"}, False),
        ({"inner": "(lambda y: y)(x)"}, False),
        ({"k": 1.5}, False),
        ({"k": "-0.0"}, False),
    ],
)
def test_a_digest_follows_what_a_kernel_does(change: dict[str, Any], same: bool) -> None:
    first, second = (of_source(PLAIN.format(**given)) for given in (SAME, SAME | change))
    digests = [kernel_digest(found.function, (0.0,)) for found in (first, second)]
    assert (digests[0] == digests[1]) == same
    assert digests[0] != kernel_digest(first.function, (0,))


MAKES = """
import numpy as np
from slidercrank.model.kernel.arithmetic import analytic

@analytic
def g(x):
    {body}

@kernel
def f(x: float) -> float:
    return g(x)[0]
"""


@pytest.mark.parametrize("body", ["return np.zeros(3) + x", "a = np.zeros(3)\n    return a, x"])
def test_a_formula_that_makes_an_array_is_refused(body: str) -> None:
    with pytest.raises(numba.TypingError, match="returning of array passed into the function"):
        of_source(MAKES.format(body=body)).compilation_source().compile()


def test_a_formula_that_hands_an_array_on_is_refused() -> None:
    found = of_source(MAKES.format(body="return x").replace("x: float", "x: Row"))
    with pytest.raises(TypeError, match="must not return an array; g does"):
        found.compilation_source().compile()


def test_digests_do_not_depend_on_the_process() -> None:
    code = (
        "import json; import slidercrank.model.cycle.cycle, slidercrank.model.signals.averages;"
        "import slidercrank.model.signals.peaks;"
        "import slidercrank.model.signals.fast_torque_and_error, slidercrank.model.signals.complex_forces;"
        "from slidercrank.model.kernel.kernel import KERNELS;"
        "from slidercrank.model.kernel.kernel_digest import kernel_digest;"
        "sources = [kernel.compilation_source() for kernel in KERNELS];"
        "print(json.dumps({source.name: kernel_digest(source.function, source.examples) for source in sources}))"
    )
    found = []
    for seed in ("1", "2"):
        environment = os.environ | {"PYTHONHASHSEED": seed, "NUMBA_NUM_THREADS": seed}
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        found.append(json.loads(done.stdout))
    assert found[0] == found[1]
    assert len(found[0]) >= 6


@kernel
def _mixed(row: Row, table: Table, numbers: Integers, both: tuple[int, float], which: bool) -> float:
    found = float(row[0] + table[1, 2] + numbers[1] + both[0] * both[1])
    return found if which else -found


def test_arguments_of_every_kind_arrive() -> None:
    random = np.random.default_rng(5)
    for _ in range(50):
        row, table = random.normal(size=3), random.normal(size=(2, 4))
        numbers, both = random.integers(-9, 9, 5), (int(random.integers(-9, 9)), float(random.normal()))
        for which in (True, False):
            given = (row[random.integers(0, 2) :], table, numbers, both, which)
            assert isinstance(_mixed, Kernel)
            assert isinstance(_mixed.function, FunctionType)
            assert _mixed(*given) == pytest.approx(_mixed.function(*given), rel=1e-13, abs=1e-13)


@pytest.mark.parametrize(
    "wrong",
    [np.zeros(3, np.float32), np.zeros((3, 1)), np.zeros(6)[::2], np.zeros(3, np.int64), np.zeros(3, complex)],
    ids=["single", "table", "not contiguous", "integers", "complex"],
)
def test_an_array_of_another_kind_is_refused_and_not_read(wrong: Any) -> None:
    with pytest.raises(TypeError, match="row must be a contiguous array of float64 in 1 dimensions"):
        _mixed(wrong, np.zeros((2, 4)), np.zeros(2, np.int64), (1, 2.0), True)


def test_the_peaks_of_a_machine_are_those_of_the_functions_in_python(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(11)
    for rubbing in (False, True):
        machine = random_machine(random)
        if rubbing:
            machine = replace(machine, friction=random_friction(random))
        designs = random_designs(2, seed=3, least_margin=0.5)
        for kind in (Signal.TORQUE, Signal.SLIDER_JERK):
            compiled = find_peaks(machine, kind, designs, gradients=True)
            with monkeypatch.context() as patched:
                patched.setattr("slidercrank.model.kernel.kernel._AS_PYTHON", True)
                python = find_peaks(machine, kind, designs, gradients=True)
            np.testing.assert_allclose(compiled.values[:, 0], python.values[:, 0], rtol=1e-12)
            assert compiled.gradients is not None
            assert python.gradients is not None
            scale = np.abs(python.gradients[:, 0]).max()
            np.testing.assert_allclose(compiled.gradients[:, 0], python.gradients[:, 0], atol=1e-9 * scale)


@pytest.mark.slow
def test_formulas_that_are_only_linked_give_the_same_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slidercrank.model.kernel.kernel.load_or_compile", lambda wanted, modules: wanted.compile())
    designs = random_designs(200, seed=4)
    assert isinstance(closed_forms._fill_values_and_gradients, Kernel)
    found = []
    for tried in (compiler._TRIED, "another version"):
        monkeypatch.setattr(compiler, "_TRIED", tried)
        own = Kernel(closed_forms._fill_values_and_gradients.function)
        values, gradients = np.empty((7, 200)), np.empty((7, 200, 3))
        for kind in range(7):
            own(kind, designs, values[kind], gradients[kind])
        found.append((values, gradients))
    np.testing.assert_allclose(found[0][0], found[1][0], rtol=1e-14)
    np.testing.assert_allclose(found[0][1], found[1][1], rtol=1e-12, atol=1e-12)


def test_what_another_thread_compiles_meanwhile_is_whole() -> None:
    found: list[float] = []
    with compiler._compiled_for_linking("a kernel"):
        other = Thread(target=lambda: found.append(numba.njit(lambda x: 2.0 * x)(21.0)))
        other.start()
        other.join()
    assert found == [42.0]
    assert numba.njit(lambda x: 3.0 * x)(2.0) == 6.0


@kernel
def _arcs(sines: Row, out: Row) -> None:
    for i in range(sines.shape[0]):
        out[i] = arcsine(sines[i])


def test_the_arc_sine_of_kernels_is_that_of_numpy_to_two_units_in_the_last_place() -> None:
    random = np.random.default_rng(8)
    edges = [0.0, -0.0, 0.5, -0.5, 1.0, -1.0, 1e-300, -1e-20, 1.0 - 1e-16, np.nextafter(0.5, 0.0), 1.5, np.nan]
    sines = np.concatenate([random.uniform(-1.0, 1.0, 20_000), 1.0 - random.random(5_000) ** 8, np.array(edges)])
    found = np.empty_like(sines)
    _arcs(sines, found)
    with np.errstate(invalid="ignore"):
        wanted = np.arcsin(sines)
    np.testing.assert_allclose(found, wanted, rtol=2.0 * np.finfo(float).eps, atol=0.0)
    assert (np.signbit(found) == np.signbit(wanted))[np.isfinite(wanted)].all()


ONCE = """
from slidercrank.model.kernel.arithmetic import analytic

@analytic
def g(x, j):
    return x + j

@analytic
def h(x, j):
    return 2.0 * g(x, j)

@kernel
def f(x: float, j: int) -> float:
    return g(x, j) + g(x, 3) + h(x, j) + h(x, 4)
"""


def test_a_formula_is_compiled_once_whoever_calls_it_with_a_variable_or_a_number() -> None:
    found = of_source(ONCE)
    with event.install_recorder("numba:run_pass") as recorder:
        found.compilation_source().compile()
    passes = [each.data for _, each in recorder.buffer if each.is_start]
    assert sorted(each["qualname"] for each in passes if each["name"].startswith("native_lowering")) == ["f", "g", "h"]


def test_the_frames_of_the_compiler_do_not_fetch_memory_at_every_call() -> None:
    def faults(depth: int) -> int:
        if depth:
            return faults(depth - 1)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
        of_source(ONCE).compilation_source().compile()
        return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

    faults(0)  # what numba fetches once
    assert sum(faults(depth) for depth in range(0, 30, 3)) < 3000  # 1,300; else 7,000, by the depth 200 to 1,200
