"""Sessions of the study in a file of JSON lines: a line for each session, and a line for each of its rounds.

    {"session": NAME, "settings": {…}, "first": 0, "others": "scripted", "consent": TEXT, "time": SECONDS}
    {"session": NAME, "round": {…}}          see `ball_round.BallRound.row`

NAME is an anonymous identifier, drawn at random. Delete the lines of a name to forget the person.
"""

import json
import secrets
import time
from pathlib import Path
from typing import Any, NamedTuple

from lifelore.agent.advise.step_lines import read_objects
from lifelore.core.errors import InputError
from reproduction.chapter4.c4_14_people.scripted_player import scripted_others
from reproduction.chapter4.c4_14_people.study_plan import METHODS, PERSON, SCRIPTED, StudySettings
from reproduction.chapter4.c4_14_people.study_session import StudySession
from reproduction.chapter4.c4_14_people.training_models import TrainingTotals


class Recorded(NamedTuple):
    """A session of a file: its settings, and the rows of its rounds in order."""

    settings: StudySettings
    rows: list[dict[str, Any]]

    @property
    def finished(self) -> bool:
        """Whether all rounds were played."""
        return len(self.rows) == self.settings.rounds


def recorded_sessions(path: str | Path) -> list[Recorded]:
    """The sessions of a file in the order in which they began; none where there is no file.

    Raises
    ------
    InputError
        A line is no such object; the message gives its number.
    """
    if not Path(path).exists():
        return []
    found: dict[str, Recorded] = {}
    with open(path, encoding="utf-8") as lines:
        for number, line in read_objects(lines, str(path)):
            try:
                if "round" in line:
                    found[line["session"]].rows.append(line["round"])
                else:
                    found[line["session"]] = Recorded(StudySettings.from_document(line["settings"]), [])
            except (KeyError, TypeError) as error:
                raise InputError(f"{path} line {number}: no line of a session or of its round ({error})") from None
    return list(found.values())


def new_session(path: str | Path, settings: StudySettings, consent: str, seed: int = 0) -> StudySession:
    """Begin a session and write its line.

    The best static speed is that of the other people on record, or of scripted players where these do not cover
    the session. The method that begins alternates between sessions of a kind of player.

    Parameters
    ----------
    consent : str
        The text that the player has agreed to.
    """
    recorded = recorded_sessions(path)
    others, players = other_players(recorded, settings)
    first = sum(one.settings.player == settings.player for one in recorded) % len(METHODS)
    session = StudySession(secrets.token_hex(8), settings, others, first=first, seed=seed)
    about = {"first": first, "seed": seed, "others": players, "consent": consent, "time": int(time.time())}
    _append(path, {"session": session.name, "settings": settings.document, **about})
    return session


def store_round(path: str | Path, session: StudySession, row: dict[str, Any]) -> None:
    """Write the line of a round."""
    _append(path, {"session": session.name, "round": row})


def other_players(recorded: list[Recorded], settings: StudySettings) -> tuple[TrainingTotals, str]:
    """Totals of the people on record at the pace of a session, or of scripted players; and which of them it is."""
    known = [one for one in recorded if one.settings.player == PERSON and one.settings.pace == settings.pace]
    people, scripted = (
        TrainingTotals.of(row for one in known for row in one.rows),
        scripted_others(settings.layout),
    )
    if not people.covers(settings):
        return scripted, SCRIPTED
    # What a ball does after a command depends on its size, not on who commands: scripted moves count as well.
    return people._replace(moves=people.moves + scripted.moves), PERSON


def _append(path: str | Path, document: dict[str, Any]) -> None:
    with open(path, "a", encoding="utf-8") as file:
        file.write(json.dumps(document) + "\n")
