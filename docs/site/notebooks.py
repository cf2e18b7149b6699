"""The notebooks of docs/notebooks as pages of the documentation site: text, code and stored outputs."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parents[1] / "notebooks"


def notebook_files() -> list[Path]:
    """Return the notebooks in order."""
    return sorted(FOLDER.glob("*.ipynb"))


def notebook_page(file: Path) -> str:
    """Return a notebook as Markdown. Its pictures are files beside the page; answers can be opened."""
    parts = []
    for number, cell in enumerate(_cells(file)):
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source.replace("<details>", '<details markdown="1">'))
            continue
        if not source:  # room for the answer to an exercise
            continue
        code = "\n".join([f"```python\n{source}\n```", *_outputs(file, number, cell)])
        hidden = "answer" in cell["metadata"].get("tags", ())
        parts.append(
            f'<details markdown="1">\n<summary>Answer in Python</summary>\n\n{code}\n\n</details>' if hidden else code
        )
        if number == 1:
            parts.append(f"The notebook itself: [{file.name}]({file.name}).")
    return "\n\n".join(parts) + "\n"


def notebook_pictures(file: Path) -> dict[str, bytes]:
    """Return the pictures in a notebook by their file names beside its page."""
    return {
        _picture(file, number): base64.b64decode(output["data"]["image/png"])
        for number, cell in enumerate(_cells(file))
        for output in cell.get("outputs", ())
        if "image/png" in output.get("data", {})
    }


def _cells(file: Path) -> list[dict[str, Any]]:
    cells: list[dict[str, Any]] = json.loads(file.read_text(encoding="utf-8"))["cells"]
    return cells


def _outputs(file: Path, number: int, cell: dict[str, Any]) -> list[str]:
    """Return the printed output and the figure of a cell as Markdown."""
    blocks = []
    for output in cell["outputs"]:
        if "text" in output:
            blocks.append(f"```text\n{''.join(output['text']).rstrip()}\n```")
        elif "image/png" in output["data"]:
            blocks.append(f"\n![Figure of the code above]({_picture(file, number)})")
    return blocks


def _picture(file: Path, number: int) -> str:
    """Return the file name of a cell's figure."""
    return f"{file.stem}_{number}.png"
