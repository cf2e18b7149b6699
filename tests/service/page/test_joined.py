"""Modules as one script: what it does, in the browser's own words, and what is refused."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser

from slidercrank.service.page.router import joined_modules, joined_styles

SOURCES = {
    "app.js": 'import { twice as double, one } from "./lib/sums.js";\n'
    "window.found = [one, double(2)];\n"
    'import("./views/late.js").then(({ Late }) => window.found.push(new Late().told));\n',
    "lib/sums.js": "export const one = 1;\nexport function twice(n) {\n  return n * 2;\n}\nconst own = 3;\n",
    "views/late.js": 'import {\n  one,\n} from "../lib/sums.js";\nexport class Late {\n  told = `late ${one}`;\n}\n',
    "views/never.js": "window.never = true;\n",
}


def test_the_script_does_what_the_modules_do(browser: Browser) -> None:
    page = browser.new_page()
    page.add_script_tag(type="module", content=joined_modules(SOURCES, "app.js"))
    page.wait_for_function("window.found?.length === 3")
    assert page.evaluate("[window.found, window.never]") == [[1, 4, "late 1"], None]
    page.close()


def test_what_explains_and_types_a_module_is_not_sent() -> None:
    explained = """/** Sums. */
/** @import { Late } from "../views/late.js" */
/**
 * Return twice a number.
 * @param {number} n
 */
"""
    source = "export function twice(n) {\n  /** @type {number} */\n  const two = 2; /** two */\n"
    source += "  // why\n  return /** @type {number} */ (two * n);\n}\n"
    source += "/** @type {number} */ (window.own).kept = 1;\n/** @type {number} */\nwindow.last = 2;\n"
    plain = source.replace("  /** @type {number} */\n", "").replace("\n/** @type {number} */\n", "\n")
    plain = plain.replace("  // why\n", "").replace("return /** @type {number} */ (", "return (")
    assert ".kept = 1" in joined_modules({"app.js": source}, "app.js")
    assert joined_modules({"app.js": explained + source}, "app.js") == joined_modules({"app.js": plain}, "app.js")


@pytest.mark.parametrize(
    ("sources", "said"),
    [
        ({"app.js": 'import all from "./b.js";\n', "b.js": ""}, "import all from"),
        ({"app.js": "export let count = 0;\n"}, "export let count"),
        ({"app.js": "const later = import(name);\n"}, r"import\(name"),
        ({"app.js": 'import { b } from "./b.js";\n'}, "b.js, which does not exist"),
        (
            {"app.js": 'import { b } from "./b.js";\n', "b.js": 'import { a } from "./app.js";\n'},
            "app.js -> b.js -> app.js",
        ),
    ],
)
def test_what_is_not_understood_is_refused(sources: dict[str, str], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        joined_modules(sources, "app.js")


def test_the_style_of_all_views_comes_first() -> None:
    assert joined_styles({"style/a.css": "a", "style/shell.css": "s", "style/b.css": "b"}) == "s\na\nb"
