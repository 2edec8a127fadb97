"""Sessions of the play study in memory: open, store, export and forget.

    play_session/SESSION        about: settings, first method, seed, other players, time
    play_round/SESSION/NUMBER   slots: the moves, row by row; about: the round and its result
    play_losses/PACE, PLAYER    rounds, moves and collisions by size and speed; values of players add up
    play_moves/PACE, PLAYER     moves by speed, signal and size; values of players add up

SESSION is an anonymous identifier, drawn at random. All records of a session are contributions of one robot, so
that forgetting it takes its share out of the sums. Thesis: §4.8.5.
"""

import csv
import io
import secrets
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from lifelore.agent.play_study.ball_round import COLUMNS
from lifelore.agent.play_study.round_result import FIELDS, RoundResult
from lifelore.agent.play_study.scripted_player import scripted_others
from lifelore.agent.play_study.study_models import Others, TrainingTotals
from lifelore.agent.play_study.study_plan import METHODS, TRAINING, Round
from lifelore.agent.play_study.study_session import StudySession
from lifelore.agent.play_study.study_settings import PERSON, StudySettings
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from lifelore.domains.ball_game.moves import N_SIGNALS
from lifelore.memory import Memory

SESSION, ROUND, LOSSES, MOVES, VERSION = "play_session", "play_round", "play_losses", "play_moves", 1
CONSENT = (
    "You play a ball game for some minutes. The service stores your moves, the results of your rounds, the "
    "settings and the time of the session under a random identifier. It does not store your name, address or "
    "browser. You may stop at any time. You can download your record and delete it. This text informs you. It is "
    "not the approval of an ethics committee, which a study with people needs before it begins."
)
"""The text that a player agrees to."""


def robot_of(session: str) -> str:
    """The name under which memory has all that is stored of a session."""
    return f"play: {session}"


def open_new_session(
    memory: Memory, settings: StudySettings, *, consent: bool, seed: int = 0, name: str | None = None
) -> StudySession:
    """Begin a session and store it.

    Parameters
    ----------
    name : str, optional
        Identifier, letters and digits; default: drawn at random. A name and a seed give the same rounds again.

    Raises
    ------
    InputError
        The player does not consent, or the memory has a session of the name.
    """
    if consent is not True:
        raise InputError(
            "consent must be given before anything is recorded; agree to the text, or play a free round"
        )
    name = secrets.token_hex(8) if name is None else name
    others = other_players(memory, settings)
    about = {
        "settings": settings.document,
        "first": _sessions_of(memory, settings.player) % len(METHODS),
        "seed": seed,
        "others": {"player": others.player, "players": others.players},
        "consent": CONSENT,
        "time": int(time.time()),
    }
    record = Record(SESSION, name, VERSION, "newest", _ONE, _ONE, about)
    if not _contribute(memory, name, [record], 0, {"play": "session"}):
        raise InputError(f"name must be new, got '{name}', which memory has; choose another name or seed")
    return StudySession(name, settings, others, first=about["first"], seed=seed)


def open_free_session(memory: Memory, layout: str, seed: int = 0) -> StudySession:
    """A session for free rounds; nothing of it is ever stored."""
    settings = StudySettings(layout=layout, speeds=SPEEDS)
    return StudySession(secrets.token_hex(8), settings, other_players(memory, settings), seed=seed)


def open_session(memory: Memory, name: str) -> StudySession:
    """The session of a name, as its stored rounds leave it; NotFoundError where there is none."""
    about = session_about(memory, name)
    settings = StudySettings.from_document(about["settings"])
    done = stored_results(memory, name)
    others = other_players(memory, settings, TrainingTotals.of(done), name)
    return StudySession(name, settings, others, first=about["first"], seed=about["seed"], done=done)


def session_about(memory: Memory, name: str) -> dict[str, Any]:
    """What is stored of a session beside its rounds; NotFoundError where there is no such session."""
    record = memory.recall(SESSION, name, VERSION) if 0 < len(name) <= 100 and name.isalnum() else None
    if record is None:
        raise NotFoundError(f"no session '{name[:40]}'; begin one, or check the identifier")
    return dict(record.about)


def store_round(memory: Memory, session: StudySession, result: RoundResult) -> bool:
    """Store a round that is over, with its share of the sums; False where it is stored already."""
    settings = session.settings
    planned, table = result.planned, result.moves.ravel()
    about = {**result.row, "player": settings.player, "pace": settings.pace, "time": int(time.time())}
    key = _round_key(session.name, result.number)
    records = [Record(ROUND, key, VERSION, "newest", np.arange(len(table)), table, about)]
    if planned.phase == TRAINING:
        records += _sums(TrainingTotals.of([result]), _sum_key(settings, settings.player))
    return _contribute(memory, session.name, records, result.number + 1, {"play": planned.phase, **result.row})


def stored_results(memory: Memory, name: str) -> list[RoundResult]:
    """The stored rounds of a session, in order."""
    records = (record for _, records in memory.history(robot_of(name)) for record in records)
    return [_result_of(record) for record in records if record.kind == ROUND]


def stored_result(memory: Memory, key: str) -> RoundResult:
    """The round of a key ``SESSION/NUMBER``."""
    record = memory.recall(ROUND, key, VERSION)
    if record is None:
        raise NotFoundError(f"no round '{key[:40]}' is stored")
    return _result_of(record)


def _result_of(record: Record) -> RoundResult:
    about = record.about
    planned = Round(
        about["phase"], about["size"], about["speed"] if about["phase"] != "test" else None, about["method"],
        about["block"],
    )  # fmt: skip
    moves = record.values.reshape(-1, len(COLUMNS))
    return RoundResult(about["number"], planned, about["speed"], about["sigma"], moves, about["reached"])


def other_players(
    memory: Memory, settings: StudySettings, own: TrainingTotals | None = None, name: str = ""
) -> Others:
    """The people on record other than this one, or scripted players where these do not cover the session.

    The moves of scripted players always count in the totals.

    Parameters
    ----------
    own : TrainingTotals, optional
        Training of the player, which the sums in memory hold too.
    name : str
        The player's own session.
    """
    totals = _recalled(memory, _sum_key(settings, PERSON))
    if own is not None and settings.player == PERSON:
        totals = totals.plus(own, -1)
    scripted = scripted_others(settings.layout)
    if not totals.covers(settings):
        return scripted
    # What a ball does after a command depends on its size, not on who commands: scripted moves count as well.
    moves = totals.moves + scripted.totals.moves
    return Others(totals._replace(moves=moves), PERSON, _trained_people(memory, settings, name))


def export_session(memory: Memory, name: str) -> dict[str, Any]:
    """All that is stored of a session as JSON data."""
    about = session_about(memory, name)
    results = stored_results(memory, name)
    rounds = [{**result.row, "path": result.moves.tolist()} for result in results]
    return {"session": name, **about, "columns": list(COLUMNS), "rounds": rounds}


def export_csv(memory: Memory, name: str) -> str:
    """The rounds of a session as CSV, a line for each, with a head line."""
    session_about(memory, name)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("session", *FIELDS))
    writer.writerows((name, *result.row.values()) for result in stored_results(memory, name))
    return text.getvalue()


def forget_session(memory: Memory, name: str) -> int:
    """Delete all that is stored of a session, for ever; the number of contributions removed."""
    session_about(memory, name)
    return memory.forget(robot_of(name))


def _trained_people(memory: Memory, settings: StudySettings, name: str) -> int:
    """Number of people other than this one with a training round at the pace of the session."""
    found = 0
    for other, _, about in memory.keys(SESSION):
        theirs = StudySettings.from_document(about["settings"])
        if other != name and theirs.player == PERSON and theirs.pace == settings.pace:
            found += memory.recall(ROUND, _round_key(other, theirs.practice), VERSION) is not None
    return found


def _round_key(session: str, number: int) -> str:
    return f"{session}/{number:03}"


_ONE = np.zeros(1, np.int64)


def _sessions_of(memory: Memory, player: str) -> int:
    return sum(about["settings"]["player"] == player for _, _, about in memory.keys(SESSION))


def _sum_key(settings: StudySettings, player: str) -> str:
    return f"{settings.pace}, {player}"


def _sums(totals: TrainingTotals, key: str) -> Iterator[Record]:
    about = {"sizes": list(SIZES), "speeds": list(SPEEDS)}
    losses = np.stack([totals.rounds, totals.steps, totals.hits], axis=-1)
    for kind, array in ((LOSSES, losses), (MOVES, totals.moves)):
        slots = np.flatnonzero(array)
        yield Record(kind, key, VERSION, "add", slots, array.ravel()[slots], about)


def _recalled(memory: Memory, key: str) -> TrainingTotals:
    def array(kind: str, shape: tuple[int, ...]) -> np.ndarray:
        found, record = np.zeros(int(np.prod(shape)), np.int64), memory.recall(kind, key, VERSION)
        if record is not None:
            found[record.slots] = record.values
        return found.reshape(shape)

    losses = array(LOSSES, (len(SIZES), len(SPEEDS), 3))
    moves = array(MOVES, (len(SPEEDS), N_SIGNALS, len(SIZES)))
    return TrainingTotals(losses[..., 0], losses[..., 1], losses[..., 2], moves)


def _contribute(memory: Memory, name: str, records: list[Record], seq: int, task: dict[str, Any]) -> bool:
    return memory.contribute(robot_of(name), records, process="play", seq=seq, task=task)
