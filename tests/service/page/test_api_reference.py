"""The page that describes the API, which a browser can read and try."""

from __future__ import annotations

import re

import httpx
import pytest
from playwright.sync_api import expect

from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Store
from tests.service.api.fixed_front import client_of
from tests.service.page.conftest import Open

TOKEN = "a token of sixteen letters or more"
PLACE = "/api/v1/docs"


@pytest.mark.slow
def test_every_request_is_listed_and_can_be_tried(open_page: Open, store: Store) -> None:
    page = open_page(store, settings=Settings(token=TOKEN), expected=("401",))
    service = page.url.split("/?")[0].rstrip("/#")
    page.goto(f"{service}/?token={TOKEN}")
    page.goto(service + PLACE)
    described = httpx.get(
        f"{service}/api/v1/openapi.json", headers={"Authorization": f"Bearer {TOKEN}"}, timeout=60.0
    ).json()
    operations = [method for path in described["paths"].values() for method in path]
    expect(page.locator(".opblock")).to_have_count(len(operations))
    block = page.locator(".opblock", has_text=re.compile(r"^GET\s*/api/v1/quantities"))
    block.locator("button").first.click()
    block.get_by_role("button", name="Try it out").click()
    block.get_by_role("button", name="Execute").click()
    expect(block.locator(".live-responses-table")).to_contain_text("peak_torque")


def test_it_needs_the_token_and_brings_its_files(store: Store) -> None:
    with client_of(store, Settings(token=TOKEN)) as client:
        for part in ("", "/swagger-ui-bundle.js", "/swagger-ui.css"):
            assert client.get(PLACE + part).status_code == 401
            answer = client.get(PLACE + part, headers={"Authorization": f"Bearer {TOKEN}"})
            assert answer.status_code == 200
            assert len(answer.content) > 500
        assert (
            "script-src 'self' 'sha256-"
            in client.get(PLACE, headers={"Authorization": f"Bearer {TOKEN}"}).headers["content-security-policy"]
        )
