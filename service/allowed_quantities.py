"""Which functions of their own jobs of others may name."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from ..model.errors import JobError


def require_allowed(tables: Mapping[str, Any], allowed: Collection[str]) -> None:
    """Raise `JobError` if a job names a function, as [quantity], that is not one of `allowed` ("module:function")."""
    from ..optimise.units import shown

    parts = tables.get("quantity", {})
    for name, part in parts.items() if isinstance(parts, Mapping) else ():
        function = part.get("function") if isinstance(part, Mapping) else None
        if not (isinstance(function, str) and function in allowed):
            remedy = f"choose from {', '.join(sorted(allowed))}" if allowed else "leave the table out"
            raise JobError(
                f"quantity.{name[:60]}: only functions that the operator allows are run here; got {shown(function)}; "
                f"{remedy}"
            )
