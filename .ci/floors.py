"""The floors of pyproject.toml as constraints of pip, one a line."""

import re
import sys
import tomllib
from pathlib import Path


def floors(project: dict) -> dict[str, str]:
    """Return the least version of each package that dependencies and extras name. A package has one."""
    lines = [*project["dependencies"], *(line for extra in project["optional-dependencies"].values() for line in extra)]
    found: dict[str, str] = {}
    for line in lines:
        if given := re.match(r"([\w.-]+)(?:\[[\w,-]+\])?>=([\w.]+)", line):
            name, version = given.groups()
            if found.setdefault(name, version) != version:
                raise ValueError(f"a package has one floor; got {found[name]} and {version} of {name}")
    return found


if __name__ == "__main__":
    with (Path(__file__).parents[1] / "pyproject.toml").open("rb") as file:
        found = floors(tomllib.load(file)["project"])
    sys.stdout.writelines(f"{name}=={version}\n" for name, version in found.items())
