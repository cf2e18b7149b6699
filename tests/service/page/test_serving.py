"""The page as it is served: its files, what it may do, and who is let in."""

from __future__ import annotations

import importlib.metadata
import io
from urllib.parse import urlsplit

import httpx
from fontTools.ttLib import TTFont
from playwright.sync_api import expect

from slidercrank.service.api.settings import Settings
from slidercrank.service.page.router import typeface
from slidercrank.service.store import Store
from tests.service.api.fixed_front import Solved, served
from tests.service.api.serving import TOKEN
from tests.service.page.accessibility import findings, require_accessible
from tests.service.page.conftest import Open


def test_every_file_comes_with_a_policy_that_allows_nothing_from_elsewhere(store: Store) -> None:
    with served(store) as address, httpx.Client(base_url=address, timeout=30.0) as client:
        for name in ("", "page/app.js", "page/style.css", "page/icon.svg", "page/inter.woff"):
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


def test_the_page_weighs_less_than_250_kB_and_brings_its_own_typeface(open_page: Open, store: Store) -> None:
    page = open_page(store)
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    assert page.evaluate("document.fonts.ready.then(() => document.fonts.check('16px Inter'))")
    loaded = page.evaluate(
        "[...document.fonts].filter(({ status }) => status === 'loaded').map(({ family }) => family)"
    )
    assert loaded == ["Inter"]
    weight = page.evaluate(
        "[...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')]"
        ".filter(({ name }) => !name.includes('/api/')).reduce((sum, one) => sum + one.encodedBodySize, 0)"
    )
    assert 100_000 < weight < 250_000


def test_the_typeface_has_the_letters_of_the_page_in_its_weights_under_its_open_licence() -> None:
    with TTFont(io.BytesIO(typeface())) as font:
        assert set("äéßµθωφΔ·°²₁−×→≤≥√∞") <= {chr(code) for code in font.getBestCmap()}
        assert {axis.axisTag: (axis.minValue, axis.maxValue) for axis in font["fvar"].axes}["wght"] == (400, 700)
        said = " ".join(str(name) for name in font["name"].names)
    # A copy needs its copyright and licence with it; the metadata of the font may hold them (OFL 1.1, condition 2).
    assert "The Inter Project Authors" in said
    assert "SIL Open Font License, Version 1.1" in said
    assert "https://openfontlicense.org" in said
    licence = importlib.metadata.files("fontpkg-inter") or []
    texts = [file.read_text() for file in licence if file.name == "LICENSE"]
    assert all("SIL OPEN FONT LICENSE Version 1.1" in text for text in texts)
    assert texts


def test_without_the_token_a_browser_is_told_where_it_is(open_page: Open, store: Store) -> None:
    page = open_page(store, settings=Settings(token=TOKEN), expected=("401",))
    expect(page.get_by_role("heading")).to_have_text("This service requires a token")
    host = urlsplit(page.url).netloc
    expect(page.get_by_role("main")).to_contain_text(f"http://{host}/?token=…")
    expect(page.locator(".masthead .brand")).to_have_css("display", "flex")
    field, button = page.get_by_label("Token").bounding_box(), page.get_by_role("button").bounding_box()
    assert field is not None
    assert button is not None
    assert button["x"] - (field["x"] + field["width"]) >= 4.0


def test_who_gives_the_token_comes_to_the_view_that_was_asked_for(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/help/peak_torque", settings=Settings(token=TOKEN), expected=("401",))
    page.get_by_label("Token").fill("wrong")
    page.get_by_role("button", name="Open").click()
    expect(page.get_by_role("alert")).to_have_text("That was not the token of this service.")
    assert page.url.endswith("/#/help/peak_torque")  # without what was given
    page.get_by_label("Token").fill(TOKEN)
    page.get_by_role("button", name="Open").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("peak torque", ignore_case=True)
    assert page.url.endswith("/#/help/peak_torque")
    # Whoever loses the cookie, as when the service starts anew, is asked once more, in front of the view.
    page.context.clear_cookies()
    page.evaluate("location.hash = '#/'")
    page.get_by_role("dialog", name="This service requires a token").get_by_label("Token").fill(TOKEN)
    page.get_by_role("button", name="Open").click()
    expect(page.get_by_role("heading", name="No runs yet")).to_be_visible()


def test_what_is_typed_as_the_token_is_lost_stays_and_is_answered(open_page: Open, solved: Solved) -> None:
    view = f"#/jobs/{solved.number}/designs/3"
    page = open_page(solved.store, view, settings=Settings(token=TOKEN), expected=("401",), reduced_motion="reduce")
    page.get_by_label("Token").fill(TOKEN)
    page.get_by_role("button", name="Open").click()
    crank = page.locator("#what-if-crank_mm")
    expect(crank).to_be_visible()
    page.context.clear_cookies()
    own = float(crank.input_value())
    crank.fill(str(own - 1.0))
    dialog = page.get_by_role("dialog", name="This service requires a token")
    dialog.get_by_label("Token").fill("wrong")
    dialog.get_by_label("Token").press("Enter")
    expect(dialog.get_by_role("alert")).to_have_text("That was not the token of this service.")
    require_accessible(page)
    dialog.get_by_label("Token").fill(TOKEN)
    dialog.get_by_label("Token").press("Enter")
    expect(dialog).to_have_count(0)
    expect(page.get_by_role("table", name="Objectives before and after the change")).to_be_visible()
    assert float(crank.input_value()) == own - 1.0


def test_the_page_that_asks_for_the_token_is_for_everybody(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/jobs/7", settings=Settings(token=TOKEN), expected=("401",))
    assert findings(page) == []
    page.evaluate("localStorage.setItem('scheme', 'dark')")
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-scheme", "dark")


def test_the_token_leads_nowhere_else(store: Store) -> None:
    with (
        served(store, Settings(token=TOKEN, hosts=("*",))) as address,
        httpx.Client(base_url=address, headers={"Accept": "text/html"}) as client,
    ):
        for rest in ("&next=http://attacker.example", "&next=//attacker.example", "#//attacker.example"):
            assert client.get(f"/?token={TOKEN}{rest}").headers["location"] == "/"
        client.cookies.clear()
        asked = client.get("/", headers={"Host": '"><script>alert(1)</script>'})
        assert asked.status_code == 401
        assert "<script>alert" not in asked.text


def test_the_printed_address_lets_in_also_to_a_view_of_a_link(open_page: Open, store: Store) -> None:
    page = open_page(store, f"?token={TOKEN}#/help", settings=Settings(token=TOKEN))
    expect(page.get_by_role("heading", level=1)).to_have_text("Help")
    assert "token" not in page.url


def test_an_address_of_no_view_is_said(open_page: Open, store: Store) -> None:
    page = open_page(store, "#/nowhere")
    expect(page.get_by_role("main")).to_contain_text("There is no such page.")
