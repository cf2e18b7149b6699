"""Refusal for a framework that is not installed."""

from __future__ import annotations

from ...model.errors import InputError


def require(framework: str, error: ImportError) -> InputError:
    """Return the error that names the extra which brings a framework; for any other missing import the error stays."""
    if error.name is None or error.name.partition(".")[0] != framework:
        raise error
    return InputError(f'{framework} is needed; it is not installed; run pip install "slidercrank[{framework}]"')
