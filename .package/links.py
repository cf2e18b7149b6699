"""Makes .package/typing: the folders under the names that they are installed by, as type checkers look for them.

Links are made where they are needed instead of being kept in the repository, which Windows could not check out. There a
folder is linked by a junction, which needs no rights, and a file is copied.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

FOLDERS = ("model", "objectives", "optimise", "service")
FILES = ("__init__.py", "__main__.py", "py.typed")


def make_links(root: Path, place: Path) -> None:
    """Make the package `slidercrank` in a folder, of the sources below root; what is there already stays."""
    package = place / "slidercrank"
    package.mkdir(parents=True, exist_ok=True)
    links = {name: root / name for name in FOLDERS}
    links |= {name: root / ".package" / "slidercrank" / name for name in FILES}
    for name, source in links.items():
        link = package / name
        if sys.platform != "win32":
            if not link.exists():
                link.unlink(missing_ok=True)  # one that leads nowhere
                link.symlink_to(os.path.relpath(source, package))  # so that a copy of the checkout checks itself
        elif source.is_file():
            shutil.copyfile(source, link)
        elif not link.exists():
            import _winapi

            _winapi.CreateJunction(str(source), str(link))


if __name__ == "__main__":
    here = Path(__file__).resolve().parent
    make_links(here.parent, Path(sys.argv[1]) if len(sys.argv) > 1 else here / "typing")
