"""Records, designs, exact designs and job tables as bytes and text, and back, without losing a bit."""

from __future__ import annotations

import hashlib
import io
import json
import math
import zipfile
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from ...model.errors import RunError
from ..runs.result import Cell, ExactDesigns, Result, Row, json_ready

if TYPE_CHECKING:
    from numpy.lib.npyio import NpzFile

    from ...optimise.search.checkpoints import Record

_LONGEST = 4000
_FORM = 1
_POINTS = 64


def packed_record(record: Record) -> bytes:
    """Return a search record as a file in NumPy's .npz format, without pickles."""
    import numpy as np

    return _npz_bytes(
        problem=np.array(record.identity.problem),
        versions=np.array(record.identity.versions),
        counts=np.array([record.number, record.rounds], dtype=np.int64),
        seconds=np.array(record.seconds),
        words=record.words,
    )


def unpacked_record(content: bytes) -> Record:
    """Return the record that was passed to `packed_record`. Raises `RunError` if the content is damaged."""
    import numpy as np

    from ...optimise.search.checkpoints import Identity, Record

    try:
        with _load_npz(content) as file:
            number, rounds = file["counts"].tolist()
            words = file["words"]
            if words.dtype != np.int64 or words.ndim != 1:
                raise ValueError(f"its words are {words.dtype} of {words.ndim} dimensions")
            identity = Identity(str(file["problem"]), str(file["versions"]))
            return Record(identity, number, rounds, float(file["seconds"]), words)
    except (OSError, ValueError, TypeError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise RunError(
            f"a stored record must be intact; got {type(error).__name__}: {error}; submit its job again"
        ) from error


def packed_exact(exact: ExactDesigns) -> bytes:
    """Return exact designs as an .npz file: concatenated derivatives, with the shapes for each design."""
    import numpy as np

    parts_by_design = [(*pieces, edges) for pieces, edges in zip(exact.goals, exact.active, strict=True)]
    shapes = [(len(owner), len(edges), slopes.shape[1]) for owner, slopes, edges in parts_by_design]
    numbers = [part.ravel() for parts in parts_by_design for part in parts]
    return _npz_bytes(
        dimensions=exact.dimensions,
        variants=np.array(exact.variants, dtype=np.int64),
        shapes=np.array(shapes, dtype=np.int64).reshape(-1, 3),
        slopes=np.concatenate([np.zeros(0), *numbers]),
    )


def unpacked_exact(content: bytes) -> ExactDesigns:
    """Return the designs that were passed to `packed_exact`. Raises ValueError if the content is damaged."""
    import numpy as np

    try:
        with _load_npz(content) as file:
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
    return ExactDesigns(dimensions, tuple(variants), tuple(goals), tuple(active))


def _npz_bytes(**arrays: Any) -> bytes:
    import numpy as np

    out = io.BytesIO()
    np.savez(out, form=np.array(_FORM), **arrays)
    return out.getvalue()


def _load_npz(content: bytes) -> NpzFile:
    import numpy as np

    file: NpzFile = np.load(io.BytesIO(content), allow_pickle=False)
    if file["form"] != _FORM:
        raise ValueError(f"its form is {file['form']}, not {_FORM}")
    return file


def checksum(*parts: str | bytes | None) -> str:
    """Return the SHA-256 of some parts, each with its length; None is an empty part."""
    digest = hashlib.sha256()
    for part in parts:
        content = part.encode() if isinstance(part, str) else bytes(part or b"")
        digest.update(len(content).to_bytes(8))
        digest.update(content)
    return digest.hexdigest()


def compact_json(value: Any) -> str:
    """Return strict, compact JSON in ASCII. Raises ValueError for a non-finite number."""
    return json.dumps(value, allow_nan=False, separators=(",", ":"))


def database_text(text: str) -> str:
    """Return a text that every database accepts: without NUL and lone surrogates, at most a page long."""
    text = text.replace("\0", "?").encode(errors="replace").decode()
    return text if len(text) <= _LONGEST else text[: _LONGEST - 4] + " ..."


def cells_json(row: Mapping[str, Cell]) -> str:
    """Return the cells of a design as a JSON array: infinities as "inf" and "-inf", undefined values as null."""
    return compact_json([_stored_cell(cell) for cell in row.values()])


def rows_from_cells(columns: Sequence[str], texts: Sequence[str]) -> list[Row]:
    """Return the designs passed to `cells_json`; undefined values become NaN, as in a table read from CSV.

    Raises ValueError for a text that is not such an array. Optimised for fronts of 10,000 designs: pydantic's parser
    gives the same numbers as `json` in a quarter of the time. Cells are checked individually only if some may be
    infinite or undefined.
    """
    from pydantic_core import from_json

    array_text = f"[{','.join(texts)}]"
    rows = from_json(array_text, allow_inf_nan=False, cache_strings="all")
    if len(rows) != len(texts):
        raise ValueError(f"{len(texts)} designs are {len(rows)}")
    if "null" in array_text or 'inf"' in array_text:
        rows = [map(_read_cell, row) for row in rows]
    return [dict(zip(columns, row, strict=True)) for row in rows]


def result_summary(result: Result) -> dict[str, Any]:
    """Return the summary of a result for lists: counts, the best value of each objective, points of the front.

    axes: columns of the first two objectives, or of the only one; points: their values for at most 64 designs.
    """
    axes = [objective.column for objective in result.objectives[:2]]
    best = {
        objective.column: result.designs[result.extremes[objective.quantity]][objective.column]
        for objective in result.objectives
        if objective.quantity in result.extremes
    }
    return {
        "designs": len(result.designs),
        "hypervolume": json_ready(result.hypervolume),
        "evaluations": result.evaluations,
        "seconds": json_ready(result.seconds),
        "best": json_ready(best),
        "axes": axes,
        "points": [[json_ready(row[axis], gaps=True) for axis in axes] for row in _evenly_spread(result.designs)],
    }


def _evenly_spread(rows: Sequence[Row]) -> list[Row]:
    """Return at most `_POINTS` evenly spread rows, including the first and the last."""
    count = min(len(rows), _POINTS)
    return [rows[i * (len(rows) - 1) // max(count - 1, 1)] for i in range(count)]


def _stored_cell(cell: Cell) -> Cell:
    if isinstance(cell, float) and not math.isfinite(cell):
        return None if math.isnan(cell) else repr(cell)
    return cell


def _read_cell(cell: Any) -> Cell:
    if cell is None:
        return math.nan
    return float(cell) if cell in ("inf", "-inf") else cell
