"""The page as it is served: its files, what it may do, and who is let in."""

from __future__ import annotations

import httpx
from playwright.sync_api import expect

from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Store
from tests.service.api.fixed_front import served
from tests.service.api.serving import TOKEN
from tests.service.page.conftest import Open


def test_every_file_comes_with_a_policy_that_allows_nothing_from_elsewhere(store: Store) -> None:
    with served(store) as address, httpx.Client(base_url=address) as client:
        for name in ("", "page/app.js", "page/style.css", "page/icon.svg"):
            response = client.get(f"/{name}")
            assert response.status_code == 200, name
            policy = response.headers["content-security-policy"]
            assert "default-src 'none'" in policy
            assert "unsafe" not in policy
            assert "http" not in policy
            again = client.get(f"/{name}", headers={"If-None-Match": response.headers["etag"]})
            assert (again.status_code, again.content) == (304, b"")


def test_nothing_but_the_files_of_the_page_is_served(store: Store) -> None:
    with served(store) as address, httpx.Client(base_url=address) as client:
        for name in ("router.py", "../router.py", "..%2Frouter.py", "%2Fetc%2Fpasswd", "style", "", "app.js%00"):
            assert client.get(f"/page/{name}").status_code in (400, 404), name


def test_without_the_token_a_browser_is_told_where_it_is(open_page: Open, store: Store) -> None:
    page = open_page(store, settings=Settings(token=TOKEN), expected=("401",))
    expect(page.get_by_role("heading")).to_have_text("Open the address that the service printed")


def test_the_printed_address_lets_in_also_to_a_view_of_a_link(open_page: Open, store: Store) -> None:
    page = open_page(store, f"?token={TOKEN}#/help", settings=Settings(token=TOKEN))
    expect(page.get_by_role("heading", level=1)).to_have_text("Help")
    assert "token" not in page.url


def test_an_address_of_no_view_is_said(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/nowhere")
    expect(page.get_by_role("main")).to_contain_text("There is no such page.")
