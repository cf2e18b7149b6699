"""A job that has what its designs are sized by: bars, a load, tolerances, their costs, a material."""

from __future__ import annotations

import tomllib
from typing import Any

from tests.service import fronts

NEEDED: dict[str, Any] = {
    "tolerances": {"crank": "0.02 mm", "rod": "0.05 mm", "offset": "0.05 mm", "crank_angle": "0.1 deg"},
    "costs": {name: {"cost": 8.0, "at": "0.05 mm"} for name in ("crank", "rod", "offset")}
    | {"crank_angle": {"cost": 10.0, "at": "0.1 deg"}},
    "sections": {
        "pins": {"crank_pivot": "15 mm", "crank_pin": "12 mm", "slider_pin": "10 mm"},
        "material": {
            "density": "7800 kg/m^3",
            "elasticity": "207 GPa",
            "yield_strength": "350 MPa",
            "ultimate_strength": "520 MPa",
            "endurance": "150 MPa",
            "bearing_pressure": "20 MPa",
        },
    },
}
"""What `balance`, `allocate` and `sections` need besides a machine."""
_BAR = {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"}
_SMALL = tomllib.loads(fronts.JOB)
TABLES: dict[str, Any] = {
    **_SMALL,
    **NEEDED,
    "mechanism": {**_SMALL["mechanism"], "crank": _BAR, "rod": _BAR},
    "load": [{"force": "200 N", "opposes": "inward stroke"}],
}
