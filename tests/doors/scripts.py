"""Scripts of commands and requests: one per line, each after the exit code or status that it ends with.

    0 slidercrank front latest --units inch
    200 GET /jobs/1/front
    201 POST /jobs/1/kept {"design": 1}

Header fields may stand between path and body, as `Accept=text/event-stream`. A body is JSON, in which `"@turn.toml"`
stands for the tables of that job and `"@@measured.csv"` for the text of that file; or it is a whole file, `@turn.toml`.
"""

from __future__ import annotations

import json
import re
import shlex
import tomllib
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

FOLDER = Path(__file__).parent
JOBS = FOLDER / "jobs"
PREFIX = "/api/v1"
_LONGEST = 90  # characters of a name before a digest
_HEADER = re.compile(r"([A-Za-z][A-Za-z-]*)=(\S+) *")
_PARAMETER = re.compile(r"\{[^}]+\}")
_MEDIA = {".toml": "application/toml", ".json": "application/json", ".csv": "text/csv"}


@dataclass(frozen=True)
class Case:
    """One line of a script. code: the exit code or status that it ends with. typed: everything after that."""

    code: int
    typed: str

    @property
    def is_command(self) -> bool:
        """Whether it is a command, rather than a request."""
        return self.typed.startswith("slidercrank")

    @property
    def name(self) -> str:
        """Name of its file: readable, the same wherever it stands in its script."""
        plain = re.sub(r"[^A-Za-z0-9]+", "-", self.typed.removeprefix("slidercrank ").replace("--", "")).strip("-")
        digest = sha256(self.typed.encode()).hexdigest()[:8]
        return plain if len(plain) <= _LONGEST else f"{plain[:_LONGEST].rstrip('-')}-{digest}"

    @property
    def words(self) -> list[str]:
        """Words of a command after the program; those with an asterisk are names of files here, as in a shell."""
        words = shlex.split(self.typed)[1:]
        return [name for word in words for name in (_matching_paths(word) if "*" in word else [word])]

    @property
    def method(self) -> str:
        """Method of a request."""
        return self.typed.split()[0]

    @property
    def target(self) -> str:
        """Address of a request below that of the API, with its parameters."""
        return self.typed.split()[1]

    @property
    def parameters(self) -> dict[str, list[str]]:
        """Parameters in the address of a request."""
        return parse_qs(urlsplit(self.target).query, keep_blank_values=True)

    @cached_property
    def rest(self) -> tuple[dict[str, str], str]:
        """Header fields and body of a request, as they stand in the script."""
        text = (*self.typed.split(maxsplit=2), "")[2]
        headers = {}
        while found := _HEADER.match(text):
            headers[found[1]] = found[2]
            text = text[found.end() :]
        return headers, text

    def body(self) -> tuple[str, bytes] | None:
        """Return media type and content of what a request sends, None for nothing."""
        _, text = self.rest
        if not text:
            return None
        if text.startswith("@"):
            file = JOBS / text[1:]
            return _MEDIA[file.suffix], file.read_bytes()
        return _MEDIA[".json"], json.dumps(_filled(json.loads(text))).encode()

    @property
    def keys_sent(self) -> set[str]:
        """Keys of the JSON that a request sends."""
        _, text = self.rest
        return set(json.loads(text)) if text.startswith("{") else set()

    def asks(self, path: str) -> bool:
        """Return whether a request is one of a path of the description of the API, such as `/jobs/{number}`."""
        pattern = re.escape(_PARAMETER.sub("\0", path.removeprefix(PREFIX))).replace(re.escape("\0"), "[^/]+?")
        return re.fullmatch(pattern, urlsplit(self.target).path) is not None


def _matching_paths(word: str) -> list[str]:
    return sorted(map(str, Path().glob(word))) or [word]


def _filled(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _filled(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_filled(item) for item in value]
    if isinstance(value, str) and value.startswith("@@"):
        return (JOBS / value[2:]).read_text(encoding="utf-8")
    if isinstance(value, str) and value.startswith("@"):
        return tomllib.loads((JOBS / value[1:]).read_text(encoding="utf-8"))
    return value


def read_script(file: Path) -> dict[str, Case]:
    """Return the cases of a script in order, by name; repeated names get a number."""
    cases: dict[str, Case] = {}
    for line in file.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            code, _, typed = line.partition(" ")
            case = Case(int(code), typed)
            same = sum(case.name == other.name for other in cases.values())
            cases[f"{case.name}-{same + 1}" if same else case.name] = case
    return cases


def all_scripts() -> dict[str, dict[str, Case]]:
    """Return the cases of every script, by its name."""
    return {file.stem: read_script(file) for file in sorted((FOLDER / "scripts").glob("*.txt"))}
