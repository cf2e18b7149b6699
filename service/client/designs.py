"""Single designs for a client: their numbers, questions about them, and their bookmarks."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from ...model.errors import InputError
from ...objectives.kinds import System
from ..questions.discovery import FRONT_OR_JOB_QUESTIONS, QUESTION_COMMANDS
from .connection import Connection, Record, without_none

if TYPE_CHECKING:
    import pandas as pd

    from ..questions.front_or_job_question import FrontOrJobQuestion


class Designs:
    """Questions about the designs of a job."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def analysis(self, number: int, design: int, *, show: Collection[str] = ()) -> Record:
        """Return all numbers for a design, with an object for each topic in `show`, as printed by `analyse --json`."""
        return self._ask_design(number, design, "analysis", {"show": list(show)})

    def ask(self, number: int, design: int | None, question: str, /, **inputs: object) -> Record:
        """Return the answer to a question, which is a topic of `analyse --show` or a command, as printed by `--json`.

        design: number of the design, or None for the whole front: `client.ask(7, None, "certify", epsilon=0.02)`.
        inputs: inputs of the question by API name, which ends with the metric unit: touch_distance_mm=12.
        """
        if question in FRONT_OR_JOB_QUESTIONS:
            if not FRONT_OR_JOB_QUESTIONS[question].path:
                raise InputError(f"a service cannot answer {question}; use the command of that name, or problem.ask")
            if FRONT_OR_JOB_QUESTIONS[question].subject == "runs":
                raise InputError(f"{question} needs several jobs; got one; call client.comparison([1, 2])")
            return self._ask_front_question(FRONT_OR_JOB_QUESTIONS[question], number, design, inputs)
        if design is None:
            raise InputError(f"{question} needs a design; got none; give its number")
        if question in QUESTION_COMMANDS:
            return self._ask_design(number, design, question, without_none(**inputs))
        path = f"jobs/{number}/designs/{design}/topics/{quote(question, safe='')}"
        numbers: Record = self._connection.ask(path, without_none(**inputs))["numbers"]
        return numbers

    def inverse(
        self,
        number: int,
        design: int,
        *,
        position_mm: float,
        velocity_m_s: float | None = None,
        acceleration_m_s2: float | None = None,
    ) -> Record:
        """Return every crank angle of a design for a slider position, as printed by `slidercrank inverse --json`."""
        rates = {"slider_velocity_m_s": velocity_m_s, "slider_acceleration_m_s2": acceleration_m_s2}
        return self.ask(number, design, "inverse", slider_position_mm=position_mm, **rates)

    def swing(self, number: int, design: int, **motion: float | str | None) -> Record:
        """Return the numbers for a swing of a design, as printed by `slidercrank swing --json`.

        motion: inputs by API name, such as start_deg=30, end_deg=90, driver="slider". Omitted inputs come from the job.
        """
        return self.ask(number, design, "swing", **motion)

    def wish(self, number: int, at: Mapping[str, str], *, design: int | None = None) -> Record:
        """Return the optimal design nearest to wishes, as printed by `slidercrank wish --json`.

        at: for each objective a value ("110 N m"), "improve", "keep", "may worsen to 120 N m" or "free". design: number
        of the reference design for these classes.
        """
        return self.ask(number, design, "wish", at=dict(at))

    def wishes(self, number: int) -> list[Record]:
        """Return the wishes recorded for the front of a job, newest first, with design and time."""
        made: list[Record] = self._connection.ask(f"jobs/{number}/wishes")["made"]
        return made

    def bookmarks(self, number: int) -> list[Record]:
        """Return the bookmarks of a job, each with name, note, star, decision and all its numbers."""
        designs: list[Record] = self._connection.ask(f"jobs/{number}/kept")["designs"]
        return designs

    def bookmark_history(self, number: int) -> list[Record]:
        """Return the notes, reasons, decisions and deletions of a job's bookmarks, oldest first."""
        history: list[Record] = self._connection.ask(f"jobs/{number}/kept")["history"]
        return history

    def keep(
        self,
        number: int,
        design: int | None = None,
        *,
        dimensions: Mapping[str, float | str] | None = None,
        **remarks: Any,
    ) -> Record:
        """Bookmark a design on a front, or one with other dimensions such as {"rod_mm": 330}, and return the bookmark.

        remarks: name, note, star, decided, reason, author. An existing bookmark of the same design takes them over.
        """
        body = {"design": design, "dimensions": dict(dimensions or {}), **remarks}
        return self._connection.post(f"jobs/{number}/kept", body, again=False)

    def change_bookmark(self, number: int, bookmark: int, **changes: Any) -> Record:
        """Change name, note, star, decided or reason of a bookmark and return it; author: of the change."""
        path = f"jobs/{number}/kept/{bookmark}"
        changed: Record = self._connection.request("PATCH", path, again=True, json=changes).json()
        return changed

    def delete_bookmark(self, number: int, bookmark: int) -> None:
        """Delete a bookmark."""
        self._connection.delete(f"jobs/{number}/kept/{bookmark}")

    def measured(self, number: int, design: int, csv: str | PathLike[str]) -> Record:
        """Return the deviation of measured curves from those of a design, as printed by `analyse --measured --json`.

        csv: path of a CSV file, or its text, which is recognised by its line breaks.
        """
        from ..designs.measured_curves_file import text_of_measured_file

        text = csv if isinstance(csv, str) and "\n" in csv else text_of_measured_file(Path(csv))
        return self._ask_design(number, design, "measured", body={"csv": text})

    def rounded(
        self,
        number: int,
        design: int,
        to: str | Collection[str],
        *,
        allow: str | Collection[str] = (),
        count: int = 5,
        units: System = "metric",
    ) -> Record:
        """Return the best rounded neighbours of a design, as printed by `slidercrank round --json`.

        to: step for all lengths, "0.5 mm", or several steps, also by name: ["0.5 mm", "rod=1 mm"]. allow: amounts by
        which designs may miss requirements, "stroke=0.1 mm".
        """
        return self._ask_front_question(
            FRONT_OR_JOB_QUESTIONS["round"], number, design, {"to": to, "allow": allow, "count": count}, units
        )

    def curves(self, number: int, design: int, *, angles: int = 360) -> pd.DataFrame:
        """Return slider motion, torque, transmission angle and joint forces of a design over a crank revolution."""
        import pandas as pd

        columns = self._ask_design(number, design, "curves", {"angles": angles})
        return pd.DataFrame(columns).set_index("crank_angle_deg")

    def _ask_front_question(
        self, question: FrontOrJobQuestion, number: int, design: int | None, inputs: Record, units: System = "metric"
    ) -> Record:
        """Return the answer for a front, or for one of its designs."""
        query = question.read(inputs, design) | (without_none(design=design) if question.row == "may" else {})
        path = question.path.format(number=number, design=design)
        record = self._connection.ask(path, *(({"units": units}, query) if question.posted else (query,)))
        return record[question.key] if question.key else record

    def _ask_design(
        self, number: int, design: int, topic: str, query: Record | None = None, body: Record | None = None
    ) -> Record:
        """Return the answer to a question about a design, posted if the question has a body."""
        path = f"jobs/{number}/designs/{design}/{topic}"
        record: Record = self._connection.ask(path, query, body)[topic]
        return record
