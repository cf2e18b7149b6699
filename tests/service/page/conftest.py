"""The page in a browser: headless Chromium, on a service behind a real server."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Callable, Collection, Iterator
from functools import partial
from typing import Any, Literal
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, Page, ViewportSize, expect

from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Store
from tests.service.api.fixed_front import served
from tests.service.page.browser import BROWSERS, browser_path, chromium

Open = Callable[..., Page]
PATIENCE = 30_000.0
"""ms, for what a page is to show: a busy machine takes many times as long as an idle one."""


class Pages:
    """A browser, and pages of one context of it: one process draws all of them.

    With a context of its own, and so a process, the form takes a quarter of the processor time more to open.
    """

    def __init__(self, browser: Browser) -> None:
        self.browser = browser
        self._context = browser.new_context()
        self._kept = self._context.new_page()  # and the process with it
        self._storage = self._context.new_cdp_session(self._kept)

    @contextlib.contextmanager
    def fresh(
        self,
        address: str,
        *,
        viewport: ViewportSize | None = None,
        reduced_motion: Literal["reduce", "no-preference"] = "no-preference",
    ) -> Iterator[Page]:
        """Open a page at an address in a new browser context, which leaves nothing behind."""
        page = self._context.new_page()
        try:
            if viewport:
                page.set_viewport_size(viewport)
            page.emulate_media(reduced_motion=reduced_motion)
            yield page
        finally:
            page.close()
            self._storage.send("Storage.clearDataForOrigin", {"origin": address, "storageTypes": "all"})
            self._storage.send("Network.clearBrowserCache")
            self._context.clear_cookies()  # which are of all ports of a host

    def require_own_clock(self) -> None:
        """Fail if a test moved the clock of these pages, which all of them have in common."""
        assert self._kept.evaluate("!('__pwClock' in window)"), "open the page whose clock is moved with own_clock=True"


@pytest.fixture(scope="session")
def launched() -> Iterator[tuple[Pages, asyncio.AbstractEventLoop]]:
    """Return the pages of one browser for all files, and the event loop that its driver has running."""
    if browser_path() is None:
        pytest.skip(f"no browser: the page is not tested; install one of {', '.join(BROWSERS)}")
    expect.set_options(timeout=PATIENCE)
    with chromium() as opened:
        loop = asyncio.get_running_loop()
        pages = Pages(opened)
        with _set_running(None):
            yield pages, loop


@pytest.fixture(scope="module")
def pages(launched: tuple[Pages, asyncio.AbstractEventLoop]) -> Iterator[Pages]:
    """Return pages for the tests of a file. Tests of others must not meet the event loop of the browser's driver."""
    opened, loop = launched
    with _set_running(loop):
        yield opened
        opened.require_own_clock()


@pytest.fixture(scope="module")
def browser(pages: Pages) -> Browser:
    """Return a browser for the tests of a file."""
    return pages.browser


@contextlib.contextmanager
def _set_running(loop: asyncio.AbstractEventLoop | None) -> Iterator[None]:
    """Say which event loop runs in this thread, while entered: as the driver does between its calls."""
    before = asyncio._get_running_loop()
    asyncio._set_running_loop(loop)
    try:
        yield
    finally:
        asyncio._set_running_loop(before)


@pytest.fixture
def open_page(pages: Pages) -> Iterator[Open]:
    """Return a function that opens a view of a store's service as in a new browser, as `open_page(store, "#/jobs/1")`.

    At the end nothing may have gone wrong on any page: no exception, no error in the console, no request to elsewhere.
    A page that has to meet a refusal says so: `open_page(store, view, expected=("404",))`, parts of what is said.
    own_clock: for a test that moves the page's clock.
    """
    with contextlib.ExitStack() as stack:
        wrong: list[str] = []

        def opened(
            store: Store,
            view: str = "",
            *,
            expected: tuple[str, ...] = (),
            settings: Settings | None = None,
            own_clock: bool = False,
            **looks: Any,
        ) -> Page:
            address = stack.enter_context(served(store, settings or Settings()))
            if own_clock:
                page = stack.enter_context(contextlib.closing(pages.browser.new_context(**looks))).new_page()
            else:
                page = stack.enter_context(pages.fresh(address, **looks))
            watch(page, address, wrong, expected)
            page.goto(f"{address}/{view}")
            page.locator("h1").first.wait_for()  # what `expect` does not find yet costs it a look at the whole page
            return page

        yield opened
    assert wrong == []


@pytest.fixture
def form(open_page: Open) -> Open:
    """Return a function that opens the form with reduced motion: the sketch stands still, which saves time."""
    return partial(open_page, reduced_motion="reduce")


def ready(page: Page) -> None:
    """Wait until the form of a new run says that its job can start."""
    status = page.get_by_role("complementary").get_by_role("status")
    expect(status).to_have_text("Ready to start.", timeout=30_000)


def checked(page: Page) -> None:
    """Wait until the form of a new run says what its check found."""
    expect(page.get_by_role("complementary").get_by_role("status")).not_to_have_text("Checking …", timeout=30_000)


def text_of(page: Page) -> dict[str, Any]:
    """Return the tables of the job in the form."""
    found: dict[str, Any] = json.loads(page.locator("#job-text").input_value())
    return found


@contextlib.contextmanager
def watched(pages: Pages, store: Store, expected: Collection[str] = ()) -> Iterator[tuple[Page, str]]:
    """Open a page on a store's service, and give both; nothing may go wrong, as with `open_page`."""
    wrong: list[str] = []
    size: ViewportSize = {"width": 1280, "height": 900}
    with served(store) as address, pages.fresh(address, reduced_motion="reduce", viewport=size) as page:
        watch(page, address, wrong, expected)
        yield page, address
    assert wrong == []


def watch(page: Page, address: str, wrong: list[str], expected: Collection[str] = ()) -> None:
    """Write down what goes wrong on a page."""
    origin = urlsplit(address).netloc

    def said(text: str) -> None:
        if not any(part in text for part in expected):
            wrong.append(text)

    def asked(url: str) -> None:
        if urlsplit(url).scheme in ("http", "https", "ws", "wss") and urlsplit(url).netloc != origin:
            wrong.append(f"a request left the origin: {url}")

    page.on("pageerror", lambda error: said(f"{error.name}: {error.message}"))
    page.on("console", lambda message: said(message.text) if message.type in ("error", "warning") else None)
    page.on("request", lambda request: asked(request.url))
