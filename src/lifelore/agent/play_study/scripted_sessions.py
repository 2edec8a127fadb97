"""Whole sessions of the study that a script plays and memory stores; the same seed gives the same rounds."""

from lifelore.agent.play_study.scripted_player import play_next_round
from lifelore.agent.play_study.study_records import open_new_session, store_round
from lifelore.agent.play_study.study_session import StudySession
from lifelore.agent.play_study.study_settings import SCRIPTED, StudySettings
from lifelore.core.errors import InputError
from lifelore.memory import Memory


def play_scripted_sessions(
    memory: Memory, number: int, settings: StudySettings, seed: int = 0
) -> list[StudySession]:
    """The sessions after their last round.

    Parameters
    ----------
    memory : Memory
        Has none of these sessions yet. The method that begins alternates with the sessions that it has.
    number : int
        Number of sessions, at least 1.
    settings : StudySettings
        Of the player "scripted".
    seed : int
        Names the sessions and draws their rounds.

    Raises
    ------
    InputError
        The settings are those of a person, or a session is in memory already.
    """
    if settings.player != SCRIPTED:
        raise InputError(f"player must be {SCRIPTED}: a script's rounds are no person's, got {settings.player!r}")
    if number < 1:
        raise InputError(f"number must be at least 1 session, got {number}")
    return [_play(memory, settings, seed, f"script{seed}number{k}") for k in range(number)]


def _play(memory: Memory, settings: StudySettings, seed: int, name: str) -> StudySession:
    session = open_new_session(memory, settings, consent=True, seed=seed, name=name)
    while session.next_round is not None:
        result = play_next_round(session)
        store_round(memory, session, result)
        session.accept(result)
    return session
