"""Scripted sessions: marked as scripted, the same again with the same seed, and those of the page guide."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.play_study.scripted_sessions import play_scripted_sessions
from lifelore.agent.play_study.study_results import study_results
from lifelore.agent.play_study.study_settings import PERSON, StudySettings
from lifelore.core.errors import InputError
from lifelore.memory import open_memory

GUIDE = Path(__file__).parents[3] / "docs" / "pages.md"
SMALL = StudySettings("scripted", sizes=(2, 60), speeds=(30, 70), practice=1, training=1, test=1)


def test_the_same_seed_plays_the_same_rounds(tmp_path):
    played = []
    for place, seed in enumerate((7, 7, 8)):
        with open_memory(tmp_path / f"{place}.db") as memory:
            played.append(play_scripted_sessions(memory, 2, SMALL, seed))
            results = study_results(memory)
        assert results["people_untested"]
        (group,) = results["groups"]
        assert (group["player"], group["sessions"], group["finished"]) == ("scripted", 2, 2)
    first, again, other = ([result for session in sessions for result in session.done] for sessions in played)
    assert [one.row for one in first] == [one.row for one in again]
    assert all(np.array_equal(one.moves, two.moves) for one, two in zip(first, again, strict=True))
    assert not all(np.array_equal(one.moves, two.moves) for one, two in zip(first, other, strict=True))
    # The method that begins alternates between sessions.
    begins = [next(r.planned.method for r in session.done if r.planned.method) for session in played[0]]
    assert len(set(begins)) == 2


def test_mistakes_are_named(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        with pytest.raises(InputError, match="player must be scripted: a script's rounds are no person's"):
            play_scripted_sessions(memory, 1, replace(SMALL, player=PERSON))
        with pytest.raises(InputError, match="number must be at least 1 session, got 0"):
            play_scripted_sessions(memory, 0, SMALL)
        play_scripted_sessions(memory, 1, SMALL)
        with pytest.raises(InputError, match="name must be new, got 'script0number0'"):
            play_scripted_sessions(memory, 1, SMALL)


@pytest.mark.slow
def test_the_page_guide_has_the_numbers_of_its_sessions(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        play_scripted_sessions(memory, 4, StudySettings.of_length("thesis", "scripted"))
        results = study_results(memory)
    (group,) = results["groups"]
    blocks, (low, high) = group["blocks"], group["blocks"]["interval"]
    text = " ".join(GUIDE.read_text(encoding="utf-8").split())
    found = re.search(
        r"four sessions of a scripted player that the picture shows \((\d+) pairs of blocks\), the mean loss was "
        r"(\S+) with BEAT and (\S+) at the static speed, a difference of (\S+) \(95 % interval (\S+) to (\S+)\)",
        text,
    )
    assert found is not None
    numbers = [blocks["beat"], blocks["static"], blocks["difference"], low, high]
    assert found.groups() == (
        str(blocks["pairs"]), *(f"{number:.2f}".replace("-", "−") for number in numbers)
    )  # fmt: skip
    assert results["people_untested"]
    assert "No person has played yet" in text
