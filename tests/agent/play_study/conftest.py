"""Sessions of the play study that a script plays."""

from collections.abc import Callable

import pytest

from lifelore.agent.play_study.scripted_player import play_next_round
from lifelore.agent.play_study.study_records import open_new_session, store_round
from lifelore.agent.play_study.study_session import StudySession
from lifelore.agent.play_study.study_settings import StudySettings
from lifelore.memory import Memory


@pytest.fixture
def play_all() -> Callable[[Memory, StudySettings], StudySession]:
    """Play and store a whole session."""

    def play_all(memory: Memory, settings: StudySettings, rounds: int | None = None) -> StudySession:
        session = open_new_session(memory, settings, consent=True)
        while session.next_round is not None and (rounds is None or len(session.done) < rounds):
            result = play_next_round(session)
            assert store_round(memory, session, result)
            session.accept(result)
        return session

    return play_all
