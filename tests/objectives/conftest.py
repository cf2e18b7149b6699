"""Set up for tests of all quantities: what these have in common is computed once."""

from collections.abc import Iterator

import pytest

from slidercrank.model.machine import memoise


@pytest.fixture(scope="module")
def shared_batches() -> Iterator[None]:
    """Keep what was asked about some hundred batches of designs: each quantity of a file asks about the same ones."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(memoise, "_BATCHES", 200)
        yield
