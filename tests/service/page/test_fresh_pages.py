"""Pages of one context: each is as in a new browser."""

from __future__ import annotations

from slidercrank.service.store import Store
from tests.service.api.fixed_front import served
from tests.service.page.conftest import Pages

FOUND = "[localStorage.length, sessionStorage.length, document.cookie, history.length]"
SENT = "performance.getEntriesByName(new URL('page/app.js', location).href).map((one) => one.transferSize)"


def test_nothing_is_left_of_a_page_whoever_has_its_address_next(pages: Pages, store: Store) -> None:
    found, sent = [], []
    with served(store) as address:
        for _ in range(2):
            with pages.fresh(address) as page:
                page.goto(address)
                found.append(page.evaluate(FOUND))
                sent.append(page.evaluate(SENT))
                page.evaluate("localStorage.setItem('units', 'inch'); sessionStorage.setItem('draft', '{}')")
                page.evaluate("document.cookie = 'token=known'; location.hash = '#/new'")
    assert found[0] == found[1]
    assert sent[0] == sent[1] > [100_000]
