"""Designs in the store as the search left them: SI dimensions and slopes, bit for bit; older stores are opened."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.errors import RunError
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.designs.selection import result_with_rows
from slidercrank.service.designs.stored_designs import design_of_row, front_of_result, stored_design
from slidercrank.service.designs.trade_offs import trade_offs_of
from slidercrank.service.runs.result import ExactDesigns, Result, result_of
from slidercrank.service.store import Store
from slidercrank.service.store.database import Database
from slidercrank.service.store.schema import exact as exact_table
from slidercrank.service.store.serialisation import packed_exact, unpacked_exact
from tests.service import test_variables
from tests.service.store.contents import add


def made_up(count: int, seed: int) -> ExactDesigns:
    """Return random designs: some without pieces, constraints or unknowns, some numbers not finite."""
    rng = np.random.default_rng(seed)
    goals, active = [], []
    for _ in range(count):
        pieces, edges, free = rng.integers(0, 4, 3)
        goals.append((rng.integers(0, 3, pieces).astype(float), rng.normal(size=(pieces, free))))
        active.append(rng.choice([np.nan, np.inf, -0.0, 1e-310, 3.0], size=(edges, free)))
    return ExactDesigns(
        rng.normal(size=(count, 5)), tuple(rng.integers(0, 9, count).tolist()), tuple(goals), tuple(active)
    )


def are_identical(one: ExactDesigns, other: ExactDesigns) -> bool:
    """Whether all numbers are the same, bit for bit, in arrays of the same shapes."""

    def arrays(exact: ExactDesigns) -> list[tuple[tuple[int, ...], bytes]]:
        slopes = [
            part
            for (owner, slope), edge in zip(exact.goals, exact.active, strict=True)
            for part in (owner, slope, edge)
        ]
        return [(part.shape, part.tobytes()) for part in (exact.dimensions, *slopes)]

    return one.variants == other.variants and arrays(one) == arrays(other)


@pytest.mark.parametrize("count", [0, 1, 7])
def test_exact_designs_come_back_bit_for_bit(count: int) -> None:
    given = made_up(count, seed=count)
    assert are_identical(unpacked_exact(packed_exact(given)), given)


def test_damaged_exact_designs_are_refused() -> None:
    whole = packed_exact(made_up(5, seed=1))
    for end in (0, 10, len(whole) // 2, len(whole) - 1):
        with pytest.raises(ValueError, match=r"."):
            unpacked_exact(whole[:end])


def test_exact_designs_belong_to_as_many_rows() -> None:
    given = made_up(3, seed=2)
    with pytest.raises(ValueError, match="dimensions of 3 designs, slopes of 2, 3"):
        ExactDesigns(given.dimensions, given.variants, given.goals[:2], given.active)


@pytest.fixture(scope="module")
def front() -> ParetoFront:
    return solve(parse_job(tomllib.loads(test_variables.JOB)))


@pytest.fixture(scope="module")
def stored(front: ParetoFront, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """Return a store with the front, and what it gives back."""
    path = tmp_path_factory.mktemp("exact") / "store.db"
    with Store(path) as store:
        number = add(store).id
        claim = store.claim("worker")
        assert claim is not None
        claim.finish(result_of(front, "x"))
        return path, store.result(number)


def test_a_stored_front_is_the_one_that_was_found(front: ParetoFront, stored: tuple[Path, Result]) -> None:
    _, result = stored
    again = front_of_result(front.problem, result)
    assert again.dimensions.tobytes() == front.dimensions.tobytes()
    assert again.variants == front.variants
    assert len(set(front.variants)) > 1
    for row in range(len(front)):
        design = stored_design(front.problem, result, row + 1)
        assert design.values == tuple(front.dimensions[row].tolist())
        assert design.mechanism == front.mechanism(row)
        assert trade_offs_of(again, row, design) == front.trade_offs(row)


def test_a_part_of_a_front_has_the_exact_designs_of_its_rows(front: ParetoFront, stored: tuple[Path, Result]) -> None:
    rows = [len(front) - 1, 0]
    part = result_with_rows(stored[1], rows)
    assert part.exact is not None
    assert part.exact.dimensions.tobytes() == front.dimensions[rows].tobytes()


def test_a_front_read_from_shown_columns_alone_is_the_same_to_rounding(front: ParetoFront) -> None:
    result = result_of(front, "x")
    for row, shown in enumerate(result.designs):
        assert design_of_row(front.problem, shown).values == pytest.approx(front.dimensions[row], rel=1e-15)


def test_exact_designs_that_are_damaged_in_the_store_are_told(stored: tuple[Path, Result]) -> None:
    path, _ = stored
    database = Database(str(path))
    with database.writing() as connection:
        before = connection.execute(exact_table.select()).one().content
        connection.execute(exact_table.update().values(content=before[:-40]))
    with Store(path) as store, pytest.raises(RunError, match="damaged"):
        store.result(1)
    with database.writing() as connection:
        connection.execute(exact_table.update().values(content=before))
    database.close()


def test_exact_designs_go_with_their_job(front: ParetoFront, tmp_path: Path) -> None:
    with Store(tmp_path / "store.db") as store:
        number = add(store).id
        claim = store.claim("worker")
        assert claim is not None
        claim.finish(result_of(front, "x"))
        store.delete(number)
    database = Database(str(tmp_path / "store.db"))
    with database.reading() as connection:
        assert connection.execute(exact_table.select()).all() == []
    database.close()
