"""Files that are no job files: refused before they are parsed, with the file's name and the reason."""

import contextlib
import json
import os
import tempfile
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import load_job, parse_job
from slidercrank.optimise.job.job_file import toml_tables


def refusal(path: Path) -> str:
    with pytest.raises(JobError) as caught:
        load_job(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    assert "no such file" in refusal(tmp_path / "none.toml")


def test_a_directory_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    assert "got a directory; name the file in it" in refusal(folder)


@pytest.mark.skipif(os.name == "nt", reason="pipes of POSIX")
def test_a_pipe_is_refused_without_waiting_for_it(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    assert "a device or a pipe" in refusal(pipe)


CONTENTS = [
    (b"", ["empty file", "start from an example"]),
    (b" \n\t\n", ["empty file"]),
    (b"\x7fELF\x02\x01\x01\x00\x00", ["plain UTF-8 text", "binary", "save it as UTF-8"]),
    ("name = 'x'".encode("utf-16"), ["UTF-16", "save it as UTF-8"]),
    (b"name = 'x'\nunit = '5 \xb5m'\n", ["line 2: ", "got byte 0xb5", "encoding UTF-8"]),
    (b"name = 'x'\n[mechanism\n", ["line 2: ", "got [mechanism; write [mechanism]"]),
    (b"name = " + b"1" * 5000, ["got thousands; shorten it"]),
    (b"a = 1\nspeed = 60rpm # fast", ["line 2", 'write speed = "60rpm"']),
    (b'crank = ["20 mm", 200 mm]', ['write crank = ["20 mm", "200 mm"]']),
    (b"slider = { mass = 1.5 kg }", ['write slider = { mass = "1.5 kg" }']),
    (b"peak_torque = minimise", ['write peak_torque = "minimise"']),
    (b"name = Sieve, quick return", ['write name = "Sieve, quick return"']),
    (b"offset = 5%", ['write offset = "5%"']),
    (b'[a]\nx.mass = "1 kg"\nx.mass = [\n 1,\n 2\n]\n', ["line 3, a.x.mass: may be given only once", "line 2 already"]),
    (b"[friction]\r\nguide = 0,2\r\n", ["line 2, friction.guide", "got guide = 0,2; write guide = 0.2"]),
    (b'crank = [ 0,02 , 0,2 ]  # "1,5"', ["write crank = [ 0.02 , 0.2 ]"]),
    (b'x = "5 mm', ['write x = "5 mm"']),
    (b"[mechanism", ["write [mechanism]"]),
    (b"x = [" + b"1, " * 200 + b"2 mm]", ["line 1, x: ", "got ...", "1, 2 mm]; write ...", '1, "2 mm"]']),
    (b"\xff\xd8\xff\xe0" + bytes(range(1, 200)), ["line 1: ", "UTF-8; got byte 0xff"]),
]


@pytest.mark.parametrize(("content", "words"), CONTENTS)
def test_content_that_is_no_toml_is_refused(content: bytes, words: list[str], tmp_path: Path) -> None:
    file = tmp_path / "job.toml"
    file.write_bytes(content)
    message = refusal(file)
    assert all(word in message for word in words), message


JSON = [
    ("{", ['line 1: the file must be JSON; got "{"', "double quotes"]),
    ("[1, 2]", ["a JSON object", "[1, 2]", "braces"]),
    ('{"name": "a", "name": "b"}', ['got "name" twice', "remove one"]),
    ('{"name": null}', ["name: must have a value", "null", "leave the key out"]),
    ("[" * 50_000, ["nested at most 8 deep"]),
    ('{"name": ' + "9" * 5000 + "}", ["got thousands"]),
    ('{"mechanism": {"speed": NaN}, "name": "x", "variables": {}, "objectives": {}}', ["speed", "finite", "nan"]),
]


@pytest.mark.parametrize(("content", "words"), JSON)
def test_content_that_is_no_json_job_is_refused(content: str, words: list[str], tmp_path: Path) -> None:
    file = tmp_path / "job.json"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(JobError) as caught:
        load_job(file)
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize("name", ["job.txt", "job", "job.toml.bak", "job.yaml"])
def test_another_ending_is_refused(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("name = 'x'", encoding="utf-8")
    assert "must end in .toml or .json" in refusal(tmp_path / name)


def test_a_file_of_100_megabytes_is_refused_by_its_size(tmp_path: Path) -> None:
    file = tmp_path / "large.toml"
    with file.open("wb") as stream:
        stream.truncate(100_000_000)  # a hole: nothing is written to disk
    assert "at most 1 MB in size; got 100.0 MB" in refusal(file)


def test_a_path_that_no_file_can_have_is_refused() -> None:
    with pytest.raises(JobError, match=r"cannot be read"):
        load_job("a\0b.toml")
    with pytest.raises(JobError, match=r"cannot be read"):
        load_job("x" * 5000 + ".toml")
    with pytest.raises(JobError, match="must be given by its path; got dict; for tables use problem"):
        load_job({})  # type: ignore[arg-type]


@contextlib.contextmanager
def without_rights() -> Iterator[None]:
    """Give up what root may do, if this is root."""
    root = os.geteuid() == 0
    if root:
        os.seteuid(65_534)  # nobody
    try:
        yield
    finally:
        if root:
            os.seteuid(0)


@pytest.mark.skipif(os.name == "nt", reason="permissions as in POSIX")
def test_a_file_that_may_not_be_read_is_refused() -> None:
    with tempfile.TemporaryDirectory() as name:  # not `tmp_path`, into which others may not even look
        folder = Path(name)
        folder.chmod(0o755)
        file = folder / "secret.toml"
        file.write_text("name = 'x'", encoding="utf-8")
        with pytest.raises(JobError, match="mechanism: is missing"):
            load_job(file)
        file.chmod(0)
        with without_rights():
            assert file.stat().st_size > 0
            assert "the file is not readable; check its permissions" in refusal(file)


def test_a_job_file_full_of_unknown_keys_is_refused(tmp_path: Path) -> None:
    # A search for near keys over all of them would take minutes.
    file = tmp_path / "many.json"
    file.write_text(json.dumps({f"k{n}": n for n in range(9_999)}), encoding="utf-8")
    with pytest.raises(JobError, match="unknown key"):
        load_job(file)


LONG_KEYS = {
    "one key of 60,000 words": "a." * 60_000 + "a = 1",
    "quoted words": "".join(("q" * 99 + ".") * 31 + "=1\n" for _ in range(300)),
    "spaces and quotes": "a . 'b' .\t\"c\" . d.e.f.g.h.i = 1",
    "in a header": "[a.b.c.d.e.f.g.h.i]",
    "in an inline table": "x = { y = 1, a.b.c.d.e.f.g.h.i = 1 }",
    "after texts": 'x = """a.b\n\\""" """\ny = \'\'\'"\'\'\'\nz = "\\"" # "\na.b.c.d.e.f.g.h.i = 1',
}


@pytest.mark.parametrize("text", LONG_KEYS.values(), ids=LONG_KEYS)
def test_a_key_of_too_many_words_is_refused_at_once(text: str) -> None:
    begin = time.process_time()
    with pytest.raises(JobError, match="nested at most 8 deep"):
        toml_tables(text)
    assert time.process_time() - begin < 1.0  # over 60 s and 10 GB where tomllib reads the first


def test_dots_that_are_no_keys_are_left_alone() -> None:
    text = 'a.b.c.d.e.f.g.h = "a.b.c.d.e.f.g.h.i.j"\n# a.b.c.d.e.f.g.h.i.j\n'
    text += "x = \"\"\"\na.b.c.d.e.f.g.h.i.j\n\"\"\"\ny = '''\na.b.c.d.e.f.g.h.i.j'''\nz = [0.1, 0.2, 0.3, .5]\n"
    assert toml_tables(text.replace(", .5", ""))["a"]["b"]["c"]["d"]["e"]["f"]["g"]["h"] == "a.b.c.d.e.f.g.h.i.j"


def test_long_texts_that_never_close_take_no_longer_than_others() -> None:
    for part in ('"""\\', "'''a", '"', "a.b.c.d.e.f.g ", "\\", "#", "a" + " " * 500):
        begin = time.process_time()
        with contextlib.suppress(JobError):
            toml_tables(part * (1_000_000 // len(part)))
        assert time.process_time() - begin < 2.0, part


def test_a_dotted_path_of_too_many_words_is_refused(pytestconfig: pytest.Config) -> None:
    data = {
        **tomllib.loads((pytestconfig.rootpath / "runs" / "feeder.toml").read_text()),
        "variables": {"mechanism." * 10_000 + "a": ["1 mm", "2 mm"]},
    }
    with pytest.raises(JobError, match="a path must have at most 8 words"):
        parse_job(data)
