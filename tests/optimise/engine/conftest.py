"""The engines under test."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from slidercrank.optimise.engine.cluster import Cluster
from slidercrank.optimise.engine.engine import Engine, Serial
from slidercrank.optimise.engine.processes import Processes
from tests.faults.dask_cluster import DaskCluster


@pytest.fixture(scope="session")
def processes() -> Iterator[Processes]:
    made = Processes(2)
    yield made
    made.close()


@pytest.fixture(scope="module")
def cluster() -> Iterator[Cluster]:
    """Cluster for the tests of a file: idle, it takes a tenth of a processor."""
    with DaskCluster(2) as dask:
        made = Cluster(dask.address, patience=60.0)
        yield made
        made.close()


@pytest.fixture(params=["serial", "processes", "cluster"])
def engine(request: pytest.FixtureRequest) -> Engine:
    made: Engine = Serial() if request.param == "serial" else request.getfixturevalue(request.param)
    return made
