"""Options that say where heavy evaluation is done."""

from pathlib import Path

import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.engine.cluster import Cluster
from slidercrank.optimise.engine.engine import Serial
from slidercrank.optimise.engine.processes import Processes
from slidercrank.service.workers.engines import EngineOptions, engine_of


def test_the_options_name_the_engine() -> None:
    with engine_of(EngineOptions(cores=1).validated()) as alone, engine_of(EngineOptions(cores=3).validated()) as three:
        assert isinstance(alone, Serial)
        assert isinstance(three, Processes)
        assert three.workers == 3
    with engine_of(EngineOptions(scheduler="tcp://127.0.0.1:8786").validated()) as cluster:
        assert isinstance(cluster, Cluster)


def test_certificates_reach_the_cluster(tmp_path: Path) -> None:
    files = [tmp_path / name for name in ("ca.pem", "own.pem", "own.key")]
    for file in files:
        file.touch()
    with engine_of(EngineOptions(None, "tls://127.0.0.1:8786", *files).validated()) as cluster:
        assert isinstance(cluster, Cluster)
        assert cluster.tls is not None
        assert [cluster.tls.authority, cluster.tls.certificate, cluster.tls.key] == files


def test_workers_share_the_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os.cpu_count", lambda: 8)
    assert [EngineOptions().divided_among(workers).cores for workers in (1, 3, 16)] == [8, 2, 1]
    assert EngineOptions(cores=5).divided_among(3).cores == 5


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"cores": 2, "scheduler": "tcp://127.0.0.1:8786"}, "keep one"),
        ({"tls_ca": Path("ca.pem")}, "need --scheduler"),
        ({"scheduler": "tls://127.0.0.1:8786", "tls_ca": Path("ca.pem")}, "give all three"),
        ({"scheduler": "somewhere"}, "must look like tcp://host:8786"),
        (
            {"scheduler": "tls://h:1", "tls_ca": Path("a"), "tls_cert": Path("b"), "tls_key": Path("c")},
            "must exist; got a;",
        ),
    ],
)
def test_options_that_do_not_go_together_are_refused(options: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        EngineOptions(**options).validated()  # type: ignore[arg-type]
