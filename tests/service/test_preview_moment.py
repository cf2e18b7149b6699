"""Work that has a moment."""

from __future__ import annotations

import threading
import time

import pytest

from slidercrank.service.preview.possible_values import run_within


def test_what_is_done_in_time_is_returned() -> None:
    assert run_within(5.0, lambda: 7) == 7


def test_what_takes_longer_is_done_without_and_so_is_what_comes_meanwhile() -> None:
    end = threading.Event()
    begin = time.monotonic()
    assert run_within(0.05, end.wait) is None
    assert run_within(0.05, lambda: 7) is None
    assert time.monotonic() - begin < 2.0
    end.set()
    assert run_within(5.0, lambda: 7) == 7


def test_what_fails_is_raised_where_it_was_asked_for() -> None:
    with pytest.raises(ZeroDivisionError):
        run_within(5.0, lambda: 1 // 0)
    assert run_within(5.0, lambda: 7) == 7
