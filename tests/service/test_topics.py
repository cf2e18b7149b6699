"""Topics declare themselves: a folder with numbers, text and figure is found, and shown in its place."""

from importlib import import_module
from pathlib import Path

import pytest

from slidercrank.model.errors import InputError
from slidercrank.service import questions
from slidercrank.service.questions.discovery import ALL, QUESTIONS, TOPICS, chosen_topics


def test_every_topic_has_numbers_text_and_figure_in_its_folder() -> None:
    assert len(TOPICS) >= 11
    for topic in TOPICS.values():
        analysis = import_module(f"{topic.package}.analysis")
        assert all(callable(getattr(analysis, part)) for part in ("numbers", "blocks", "figure"))


def test_topics_are_shown_in_the_order_of_their_places() -> None:
    places = [topic.place for topic in TOPICS.values()]
    assert places == sorted(set(places))


def test_a_folder_that_declares_a_topic_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from slidercrank.service.questions import discovery

    folder = tmp_path / "weather"
    folder.mkdir()
    (folder / "__init__.py").write_text(
        "from slidercrank.service.questions.design_question import DesignQuestion\n"
        "QUESTION = DesignQuestion(__name__, 35, 'rain')\n"
    )
    monkeypatch.setattr(questions, "__path__", [*questions.__path__, str(tmp_path)])
    found = list(discovery._discover_questions())
    assert found.index("weather") == list(QUESTIONS).index("motor") + 1
    assert [name for name in found if name != "weather"] == list(QUESTIONS)


def test_without_a_job_all_topics_are_those_that_need_none() -> None:
    assert chosen_topics([ALL], job=False) == ("press", "polygons", "extremes")
    assert chosen_topics([ALL], job=True) == tuple(TOPICS)
    with pytest.raises(InputError, match="--show motor needs masses, loads or tolerances; no job file was given"):
        chosen_topics(["motor"], job=False)
