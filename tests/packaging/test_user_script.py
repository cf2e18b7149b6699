"""Types of the front door: pyright agrees with what mypy finds in a user's script, which `make lint` checks."""

import json
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
def test_misspelt_names_fail_and_the_others_have_types(tmp_path: Path, pytestconfig: pytest.Config) -> None:
    root = pytestconfig.rootpath
    program = root / ".javascript/node_modules/.bin/pyright"
    if not program.exists():
        pytest.skip("pyright is not installed; make lint installs it where there is npm")
    # It does not see what is installed in place, hence the folder for type checkers.
    settings = {"extraPaths": [str(root / ".package/typing")], "reportUnnecessaryTypeIgnoreComment": "error"}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    script = root / "tests/packaging/user_script.py"
    (tmp_path / script.name).write_bytes(script.read_bytes())
    command = [str(program), "--pythonpath", sys.executable, "--project", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout.splitlines()[-1] == "0 errors, 0 warnings, 0 informations", done.stdout
