"""A browser for what is measured and tested on the page."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, sync_playwright

# The first draws pages as the others do; without windows and what fills forms in it takes a quarter of the time.
# Letters keep the widths of the font: rounded to pixels they differ between browsers.
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")

# With the last one, no process stands in reserve for a further page: a tenth of the processor time of each.
_OPTIONS = ("--no-sandbox", "--disable-dev-shm-usage", "--font-render-hinting=none", "--renderer-process-limit=1")


def browser_path() -> str | None:
    """Return where a browser is; None where there is none."""
    return next(filter(None, map(shutil.which, BROWSERS)), None)


@contextmanager
def chromium() -> Iterator[Browser]:
    """Give a headless browser. Ends the program with a sentence where there is none."""
    found = browser_path()
    if found is None:
        raise SystemExit(f"no browser; install one of {', '.join(BROWSERS)}")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=found, args=_OPTIONS)
        yield browser
        browser.close()
