"""Sessions in memory: coming back, sums over players, exports, forgetting."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.play_study.scripted_player import play_next_round
from lifelore.agent.play_study.study_models import TrainingTotals
from lifelore.agent.play_study.study_records import (
    LOSSES,
    MOVES,
    ROUND,
    export_csv,
    export_session,
    forget_session,
    open_free_session,
    open_new_session,
    open_session,
    other_players,
    store_round,
)
from lifelore.agent.play_study.study_settings import StudySettings
from lifelore.core.errors import InputError, NotFoundError
from lifelore.memory import open_memory

SMALL = StudySettings(sizes=(2, 60), speeds=(30, 70), practice=1, training=1, test=2, frames_per_move=3)


@pytest.fixture
def memory(tmp_path):
    with open_memory(tmp_path / "m.db") as memory:
        yield memory


def test_nothing_is_recorded_without_consent(memory):
    for consent in (False, None, "yes"):
        with pytest.raises(InputError, match="consent"):
            open_new_session(memory, SMALL, consent=consent)  # pyright: ignore[reportArgumentType]
    open_free_session(memory, SMALL.layout)
    assert memory.robots() == []


def test_a_session_comes_back_as_it_was(memory, play_all):
    session = play_all(memory, SMALL, rounds=7)
    again = open_session(memory, session.name)
    assert again.plan == session.plan
    assert again.view() == session.view()
    assert [r.row for r in again.done] == [r.row for r in session.done]
    assert all((a.moves == b.moves).all() for a, b in zip(again.done, session.done, strict=True))
    assert play_next_round(again).row == play_next_round(session).row


def test_a_round_is_stored_once(memory):
    session = open_new_session(memory, SMALL, consent=True)
    session.accept(play_next_round(session))
    result = play_next_round(session)
    assert store_round(memory, session, result)
    assert not store_round(memory, session, result)
    assert len(memory.keys(ROUND)) == 1


def test_other_people_are_used_once_they_cover_the_session(memory, play_all):
    assert other_players(memory, SMALL).player == "scripted"
    first = play_all(memory, SMALL)
    assert first.others.player == "scripted"
    second = open_new_session(memory, SMALL, consent=True)
    assert (second.others.player, second.others.players) == ("person", 1)
    own = TrainingTotals.of(first.done)
    assert (second.others.totals.steps == own.steps).all()
    assert (second.others.totals.moves >= own.moves).all()
    # The first player's own rounds are no rounds of others.
    assert open_session(memory, first.name).others.player == "scripted"
    faster = other_players(memory, replace(SMALL, frames_per_move=1))
    assert faster.player == "scripted"


def test_sums_add_up_over_players_and_forgetting_takes_a_share_out(memory, play_all):
    sessions = [play_all(memory, SMALL, rounds=5) for _ in range(2)]
    key = f"{SMALL.pace}, person"
    both = TrainingTotals.of(sessions[0].done).plus(TrainingTotals.of(sessions[1].done))
    assert memory.recall(LOSSES, key, 1).values.sum() == sum(int(a.sum()) for a in both[:3])
    assert memory.recall(MOVES, key, 1).values.sum() == both.moves.sum() == both.steps.sum()
    assert forget_session(memory, sessions[0].name) == 6
    left = TrainingTotals.of(sessions[1].done)
    record = memory.recall(MOVES, key, 1)
    found = np.zeros(left.moves.size, np.int64)
    found[record.slots] = record.values
    assert (found == left.moves.ravel()).all()
    for read in (open_session, export_session, export_csv, forget_session):
        with pytest.raises(NotFoundError, match="session"):
            read(memory, sessions[0].name)


def test_the_order_of_methods_alternates_between_people(memory):
    firsts = [open_new_session(memory, SMALL, consent=True).plan[-1].method for _ in range(3)]
    assert firsts[0] == firsts[2] != firsts[1]


def test_exports_hold_every_round(memory, play_all):
    session = play_all(memory, SMALL, rounds=6)
    document = export_session(memory, session.name)
    assert [row["number"] for row in document["rounds"]] == list(range(6))
    assert document["settings"] == SMALL.document
    assert all(len(row["path"]) == row["moves"] for row in document["rounds"])
    rows = list(csv.DictReader(io.StringIO(export_csv(memory, session.name))))
    assert [float(row["loss"]) for row in rows] == [row["loss"] for row in document["rounds"]]
    assert {row["session"] for row in rows} == {session.name}


@pytest.mark.parametrize("name", ["", "../x", "nobody", "a/b", "é" * 200])
def test_an_unknown_session_is_an_error(memory, name):
    with pytest.raises(NotFoundError, match="session"):
        open_session(memory, name)
