"""The commands of docs/api.md, run as they stand there."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import threading
from pathlib import Path

import pytest

from slidercrank.service.api.app import create_app
from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service.api.serving import TOKEN, serving

BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@pytest.mark.slow
def test_every_command_of_the_page_does_what_it_says(store: Store, tmp_path: Path, pytestconfig: pytest.Config) -> None:
    if os.name == "nt" or not shutil.which("curl"):
        pytest.skip("the page shows commands of curl in a shell of Unix")
    root = pytestconfig.rootpath
    start, *blocks = BLOCK.findall((root / "docs" / "api.md").read_text(encoding="utf-8"))
    assert "slidercrank serve" in start
    commands = "set -e\n" + "\n".join(blocks)
    stop = threading.Event()
    worker = threading.Thread(target=work, args=(store,), kwargs={"stop": stop.is_set})
    with serving(create_app(store, Settings(token=TOKEN))) as address:
        worker.start()
        script = commands.replace("http://127.0.0.1:8765", address).replace("--output ", f"--output {tmp_path}/")
        assert script != commands
        environment = os.environ | {"SLIDERCRANK_TOKEN": TOKEN, "no_proxy": "127.0.0.1"}
        done = subprocess.run(
            ["bash", "-c", script], cwd=root, env=environment, capture_output=True, text=True, check=False
        )
        stop.set()
        worker.join()
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    assert store.job(2).state == "done"
    assert store.job(3).name == "Heavier feeder"
    assert (tmp_path / "feeder.csv").read_text().startswith("number,crank_mm,")
    assert '"state":"done"' in done.stdout
    for name in ("linkage.dxf", "linkage.svg", "motion.html", "report.html"):
        assert (tmp_path / name).stat().st_size > 5_000, name
