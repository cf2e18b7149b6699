"""The recipe of a new view, followed to the letter, gives a view that the page shows."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import expect

from slidercrank.service.page import router
from slidercrank.service.store import Store
from tests.service.page.accessibility import require_accessible
from tests.service.page.conftest import Open


def test_a_view_in_one_file_and_one_entry_is_shown(
    open_page: Open, store: Store, tmp_path: Path, pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch
) -> None:
    recipe = (pytestconfig.rootpath / "docs" / "architecture.md").read_text(encoding="utf-8")
    module, entry = re.findall(r"```js\n(.*?)```", recipe.partition("## A new view of the page")[2], re.DOTALL)
    folder = tmp_path / "static"
    shutil.copytree(pytestconfig.rootpath / "service" / "page" / "static", folder)
    (folder / "views" / "shipped.js").write_text(module, encoding="utf-8")
    shell = (folder / "app.js").read_text(encoding="utf-8")
    assert shell.count("const VIEWS = [\n") == 1
    (folder / "app.js").write_text(shell.replace("const VIEWS = [\n", f"const VIEWS = [\n{entry}"), encoding="utf-8")
    monkeypatch.setattr(router, "_FILES", router.page_files(folder))
    page = open_page(store, "#/shipped")
    expect(page.get_by_role("main")).to_contain_text("Vibrating sieve")
    expect(page).to_have_title("Shipped jobs · slidercrank")
    require_accessible(page)
