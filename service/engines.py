"""Where a worker has heavy work done: in itself, in processes beside it, or on a Dask cluster."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..model.errors import InputError

if TYPE_CHECKING:
    from ..optimise.engine.engine import Engine


@dataclass(frozen=True, kw_only=True)
class EngineSettings:
    """Which engine a worker has.

    scheduler: address of a Dask cluster, "tcp://host:8786" or "tls://host:8786"; certificates: for tls, the files of
    the authority, of the own certificate and of its key. processes: how many there are without a cluster; one is the
    worker itself.
    """

    scheduler: str | None = None
    certificates: tuple[str, str, str] | None = None
    processes: int = 1


def open_engine(settings: EngineSettings) -> Engine | None:
    """Return the engine, which connects or starts when it is first needed; None for the worker itself.

    Raises `InputError` for an address that is none, or certificates that do not go with it.
    """
    from ..optimise.engine.cluster import Cluster, Tls
    from ..optimise.engine.processes import Processes

    if settings.scheduler is not None:
        files = settings.certificates
        return Cluster(settings.scheduler, tls=None if files is None else Tls(*map(Path, files)))
    return Processes(settings.processes) if settings.processes > 1 else None


def engine_settings(
    scheduler: str | None, authority: Path | None, certificate: Path | None, key: Path | None, *, processes: int
) -> EngineSettings:
    """Return what the options --scheduler, --tls-ca, --tls-cert and --tls-key say.

    processes: for the worker, without a scheduler. Raises `InputError` where they contradict each other.
    """
    files = (authority, certificate, key)
    if any(files) and not all(files):
        raise InputError("--tls-ca, --tls-cert and --tls-key belong together; got some of them; give all three or none")
    paths = tuple(str(Path(file).absolute()) for file in files if file is not None)
    if scheduler is None and paths:
        raise InputError("certificates are for a cluster; got them without --scheduler; give its address")
    certificates = (paths[0], paths[1], paths[2]) if paths else None
    settings = EngineSettings(scheduler=scheduler, certificates=certificates, processes=max(1, processes))
    open_engine(settings)  # for what it refuses; nothing is started
    return settings
