"""Cells of claim C4.14: a session of a scripted player each, and the sessions of people in a memory.

The memory is one that `lifelore serve` has recorded on the page /play (docs/pages.md).
"""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from lifelore.agent.play_study.round_result import RoundResult
from lifelore.agent.play_study.scripted_player import play_next_round, scripted_others
from lifelore.agent.play_study.study_plan import BEAT, METHODS
from lifelore.agent.play_study.study_records import SESSION, stored_results
from lifelore.agent.play_study.study_results import ratio_by_move
from lifelore.agent.play_study.study_session import StudySession
from lifelore.agent.play_study.study_settings import PERSON, SCRIPTED, StudySettings
from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.ball_game.ball_game import SIZES
from lifelore.memory import open_memory

COLUMNS = ("phase", "size", "speed", "method", "loss")
"""What of each round the measures read."""


def cells(settings: Mapping) -> list[dict]:
    """One cell for each scripted session, and one for the memory of people, if the settings name it."""
    found: list[dict] = [{"player": SCRIPTED, "session": k} for k in range(settings["sessions"])]
    if settings["people"]:
        content = Path(settings["people"]).read_bytes()
        digest = hashlib.sha256(content).hexdigest()[:16]
        found.append({"player": PERSON, "memory": settings["people"], "digest": digest})
    return found


def check(settings: Mapping) -> None:
    """Refuse settings of no session, and a memory that is no file."""
    study_settings(settings, SCRIPTED)
    if len(settings["sizes"]) < 2 or len(settings["speeds"]) < 2:
        raise InputError(
            f"sizes and speeds must be at least two each, got {settings['sizes']} and {settings['speeds']}"
        )
    if settings["people"] and not Path(settings["people"]).is_file():
        raise NotFoundError(
            f"people '{settings['people']}' is not a file; name a memory in which people have played"
        )


def study_settings(settings: Mapping, player: str) -> StudySettings:
    """The settings of a session."""
    return StudySettings(
        player,
        tuple(settings["sizes"]),
        tuple(settings["speeds"]),
        settings["practice"],
        settings["training"],
        settings["test"],
        settings["frames_per_move"],
        settings["layout"],
    )


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The rounds of the players of a cell, and what BEAT named in the first round of each of its blocks."""
    if cell["player"] == PERSON:
        return {"player": PERSON, "sessions": _recorded(settings, cell["memory"])}
    number = cell["session"]
    session = StudySession(
        f"C4.14 {number}",
        study_settings(settings, SCRIPTED),
        scripted_others(settings["layout"]),
        first=number % len(METHODS),
        seed=seed,
    )
    while session.next_round is not None:
        session.accept(play_next_round(session))
    return {"player": SCRIPTED, "sessions": [_summary(session.done)]}


def _recorded(settings: Mapping, path: str) -> list[dict]:
    """The finished sessions of people at the pace, with the sizes and the speeds of the settings."""
    own, found = study_settings(settings, PERSON), []
    with open_memory(path) as memory:
        for name, _, about in memory.keys(SESSION):
            theirs = StudySettings.from_document(about["settings"])
            if _design(theirs) == _design(own):
                done = stored_results(memory, name)
                found += [_summary(done)] if len(done) == theirs.rounds else []
    return found


def _design(settings: StudySettings) -> tuple:
    return settings.player, settings.pace, sorted(settings.sizes), sorted(settings.speeds)


def _summary(done: Sequence[RoundResult]) -> dict:
    firsts: dict[int, RoundResult] = {}
    for result in done:
        if result.planned.method == BEAT:
            firsts.setdefault(result.planned.block, result)
    return {
        "rounds": [[result.row[name] for name in COLUMNS] for result in done],
        "named": [
            {
                "size": result.planned.size,
                "last": SIZES[int(result.column("named")[-1])],
                "ratio": ratio_by_move(result).round(3).tolist(),
            }
            for result in firsts.values()
        ],
    }
