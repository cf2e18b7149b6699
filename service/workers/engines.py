"""Engine for expensive evaluations: command-line options, and the engine that they select."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

import typer

from ...model.errors import InputError
from ...model.optional_packages import import_extra
from ..text.options import File

if TYPE_CHECKING:
    from ...optimise.engine.engine import Engine


@dataclass(frozen=True)
class EngineOptions:
    """Engine for expensive evaluations. cores: local processes, None for one per processor. scheduler: Dask address."""

    cores: Annotated[
        int | None,
        typer.Option(min=1, max=1024, metavar="N"),
        "Processes for expensive evaluations; 1 uses only this one. [default: one per processor]",
    ] = None
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS"),
        "Dask cluster for expensive evaluations, such as tcp://host:8786.",
    ] = None
    tls_ca: Annotated[File, "Certificate of the authority, for tls://."] = None
    tls_cert: Annotated[File, "Certificate of this client, for tls://."] = None
    tls_key: Annotated[File, "Key of that certificate, for tls://."] = None

    def validated(self) -> EngineOptions:
        """Return the options. Raises `InputError` for options that exclude each other."""
        files = (self.tls_ca, self.tls_cert, self.tls_key)
        if self.scheduler is None and any(files):
            raise InputError(
                "--tls-ca, --tls-cert and --tls-key need --scheduler tls://...; give it, or leave them out"
            )
        if self.scheduler is not None and self.cores is not None:
            raise InputError(
                "expensive evaluations may run either here or on a cluster; got --cores and --scheduler; keep one"
            )
        if any(files) and not all(files):
            raise InputError("an encrypted connection needs --tls-ca, --tls-cert and --tls-key; give all three")
        for file in files:
            if file is not None and not file.is_file():
                raise InputError(f"the files of an encrypted connection must exist; got {file}; correct the path")
        if self.scheduler is not None:
            _make_engine(self)  # raises an error for an invalid address
            import_extra("distributed", "a Dask cluster needs")
        return self

    def divided_among(self, workers: int) -> EngineOptions:
        """Return the options for each of several workers on this machine, which share the processors."""
        return replace(self, cores=self.cores or max(1, (os.cpu_count() or 1) // workers))


@contextlib.contextmanager
def engine_of(options: EngineOptions) -> Iterator[Engine]:
    """Enter the selected engine; it ends with the block. Nothing is started before it is needed."""
    engine = _make_engine(options)
    try:
        yield engine
    finally:
        engine.close()


def _make_engine(options: EngineOptions) -> Engine:
    if options.scheduler is not None:
        from ...optimise.engine.cluster import Cluster, Tls

        tls = None
        if options.tls_ca is not None and options.tls_cert is not None and options.tls_key is not None:
            tls = Tls(options.tls_ca, options.tls_cert, options.tls_key)
        return Cluster(options.scheduler, tls=tls)
    if (options.cores or os.cpu_count() or 1) == 1:
        from ...optimise.engine.engine import Serial

        return Serial()
    from ...optimise.engine.processes import Processes

    return Processes(options.cores)
