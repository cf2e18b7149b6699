"""The front door: every public name has an example in the guide, and every example runs."""

import doctest
import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

import slidercrank as sc

FRAMEWORKS = {"jax": "jax", "torch": "torch", "openmdao_component": "openmdao", "pymoo": "pymoo"}
"""Examples that need a framework have these words in them."""


@pytest.fixture(scope="module")
def guide(pytestconfig: pytest.Config) -> str:
    return (pytestconfig.rootpath / "docs/python.md").read_text(encoding="utf-8")


def blocks(guide: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```$", guide, re.MULTILINE | re.DOTALL)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::optuna.exceptions.ExperimentalWarning")
def test_every_example_of_the_guide_runs(guide: str) -> None:
    absent = [word for word, module in FRAMEWORKS.items() if importlib.util.find_spec(module) is None]
    shown = [block for block in blocks(guide) if not any(word in block for word in absent)]
    names: dict[str, object] = {}
    told: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    for number, block in enumerate(shown):
        test = doctest.DocTestParser().get_doctest(block, names, f"block {number}", "python.md", 0)
        runner.run(test, out=told.append, clear_globs=False)
        names = test.globs
    if "jax" in sys.modules:
        sys.modules["jax"].config.update("jax_enable_x64", False)
    assert told == [], "".join(told)
    assert runner.tries > 50


def test_every_public_name_has_an_example(guide: str) -> None:
    code = "\n".join(blocks(guide))
    assert [name for name in sc.__all__ if not re.search(rf"\bsc\.{name}\b", code)] == []
    assert len([name for name in sc.__all__ if name != "__version__"]) <= 30


def test_help_lists_every_public_name() -> None:
    assert sc.__doc__ is not None
    missing = [name for name in sc.__all__ if not re.search(rf"\b{name}\b", sc.__doc__)]
    assert missing == ["__version__"]


@pytest.mark.parametrize("name", [name for name in sc.__all__ if name != "__version__"])
def test_every_public_name_explains_itself(name: str) -> None:
    text = getattr(sc, name).__doc__
    assert text is not None
    assert text.split("\n")[0].endswith((".", "):")), text.split("\n")[0]


def test_docstring_examples_of_the_front_door_run() -> None:
    modules = {sys.modules[getattr(sc, name).__module__] for name in sc.__all__ if name != "__version__"}
    found = [doctest.testmod(module, raise_on_error=False) for module in modules]
    assert sum(result.attempted for result in found) >= 8
    assert sum(result.failed for result in found) == 0


def test_a_framework_that_is_missing_is_named_with_its_extra(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules.update(dict.fromkeys(['jax', 'torch', 'openmdao', 'openmdao.api', 'pymoo']))\n"
        "import slidercrank as sc\n"
        "p = sc.problem({'name': 'a', 'mechanism': {'speed': '10 rpm'}, 'objectives': {'stroke': 'maximise'},\n"
        "    'variables': {'crank': 0.04, 'rod': [0.1, 0.2], 'offset': 0.0}})\n"
        "for make in (sc.jax_function, sc.torch_function, sc.openmdao_component, sc.pymoo_problem):\n"
        "    try: make(p)\n"
        "    except sc.InputError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert re.findall(r"slidercrank\[(\w+)\]", done.stdout) == ["jax", "torch", "openmdao", "pymoo"]
