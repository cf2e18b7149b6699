"""Included job files, and an example design for each."""

from functools import cache
from importlib.resources import as_file, files
from typing import Any, NamedTuple

from .. import presets


@cache
def shipped_jobs() -> dict[str, dict[str, Any]]:
    """Return the jobs in runs/, which every installation includes, by file name.

    Contains the accompanying catalogues, because users who start from an included job do not have these files.
    """
    from ...optimise.job import read_job

    with as_file(files(presets)) as folder:
        return {file.stem: read_job(file) for file in sorted(folder.glob("*.toml"))}


class Design(NamedTuple):
    """Lengths, mm, and the swing range of the crank or lever, deg; None for full rotation."""

    crank_mm: float
    rod_mm: float
    offset_mm: float
    from_deg: float | None = None
    to_deg: float | None = None


DESIGNS = {
    "compressor": Design(29.81, 105.93, -11.43),
    "feeder": Design(37.62, 101.71, 31.78),
    "press": Design(26.8, 108.78, 47.02),
    "servo_press": Design(26.6, 175.54, 79.99),
    "sieve": Design(137.0, 556.3, 110.86),
    "support": Design(1360.0, 2426.8, -600.0, 11.16, 101.16),
    "tipper": Design(350.0, 900.0, 0.0, -20.0, 50.0),
}
