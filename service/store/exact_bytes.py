"""Exact designs of a front as one file of NumPy's .npz form, and back, bit for bit."""

from __future__ import annotations

import io
import zipfile
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from ..runs.result import Exact

if TYPE_CHECKING:
    from ...optimise.front.stationarity import Array

_FORM = 1


def packed_exact(exact: Exact) -> bytes:
    """Return the file: all slopes one after the other, with the shapes of each design's."""
    import numpy as np

    shapes = [(len(owner), len(edges), slopes.shape[1]) for (owner, slopes), edges in _slopes(exact)]
    numbers = [part.ravel() for (owner, slopes), edges in _slopes(exact) for part in (owner, slopes, edges)]
    out = io.BytesIO()
    np.savez(
        out,
        form=np.array(_FORM),
        dimensions=exact.dimensions,
        variants=np.array(exact.variants, dtype=np.int64),
        shapes=np.array(shapes, dtype=np.int64).reshape(-1, 3),
        slopes=np.concatenate([np.zeros(0), *numbers]),
    )
    return out.getvalue()


def unpacked_exact(content: bytes) -> Exact:
    """Return the designs that `packed_exact` packed. Raises ValueError if the content is damaged."""
    import numpy as np

    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            if file["form"] != _FORM:
                raise ValueError(f"its form is {file['form']}, not {_FORM}")
            dimensions, variants, slopes = file["dimensions"], file["variants"].tolist(), file["slopes"]
            goals: list[Any] = []
            active: list[Any] = []
            at = 0
            for pieces, edges, free in file["shapes"].tolist():
                ends = np.cumsum([at, pieces, pieces * free, edges * free])
                owner, slope, edge = (slopes[a:b] for a, b in pairwise(ends))
                goals.append((owner, slope.reshape(pieces, free)))
                active.append(edge.reshape(edges, free))
                at = int(ends[-1])
            if at != len(slopes):
                raise ValueError(f"{len(slopes)} numbers of slopes, {at} expected")
    except (OSError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise ValueError(f"{type(error).__name__}: {error}") from error
    return Exact(dimensions, tuple(variants), tuple(goals), tuple(active))


def _slopes(exact: Exact) -> zip[tuple[tuple[Array, Array], Array]]:
    return zip(exact.goals, exact.active, strict=True)
