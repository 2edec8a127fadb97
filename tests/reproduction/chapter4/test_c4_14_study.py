"""The study of C4.14: its rounds, their order, blinding, models by hand, records, and numbers of the figures."""

import json
from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, ball_game
from reproduction.chapter4.ball_game.moves import N_SIGNALS, read_moves
from reproduction.chapter4.c4_14_people.ball_round import BallRound, column
from reproduction.chapter4.c4_14_people.losses import STEPS, losses_by_diversity, losses_by_speed, ratio_by_move
from reproduction.chapter4.c4_14_people.records import new_session, other_players, recorded_sessions, store_round
from reproduction.chapter4.c4_14_people.scripted_player import heading_of_script, play_session, scripted_others
from reproduction.chapter4.c4_14_people.study_plan import (
    BEAT,
    METHODS,
    PERSON,
    PRACTICE,
    SCRIPTED,
    STATIC,
    TEST,
    TRAINING,
    Round,
    StudySettings,
    plan_rounds,
)
from reproduction.chapter4.c4_14_people.study_session import StudySession
from reproduction.chapter4.c4_14_people.training_models import (
    TrainingTotals,
    best_static_speed,
    expected_values,
    pairs_of,
)

GAME = ball_game()
SMALL = StudySettings(sizes=(2, 60), speeds=(30, 70), practice=1, training=1, test=2, frames_per_move=3)


@pytest.fixture(scope="module")
def played() -> StudySession:
    return play_session(StudySession("ada", SMALL, scripted_others(SMALL.layout)))


def new_round(size: int = 20, sigma: float = 4.0) -> BallRound:
    return BallRound(GAME, Round(TRAINING, size, 50), sigma, stream(1, "test"))


def test_signals_are_those_of_the_batched_reader():
    one, before = new_round(), []
    while not one.over:
        before.append((one.x, one.y))
        one.move(heading_of_script(one), len(one.moves) % len(SPEEDS))
    table = np.array(one.moves)
    signal = np.empty(len(table), np.int64)
    heading, speed, x, y = (np.ascontiguousarray(table[:, i]) for i in (2, 3, 0, 1))
    read_moves(GAME.field, np.array(before), heading, speed, x, y, signal)
    assert table[:, 5].tolist() == signal.tolist()
    assert one.reached
    assert one.hits == table[:, 4].sum()


@pytest.mark.parametrize("heading", [-1, 4, "north", None, True, 1.0])
def test_a_wrong_direction_changes_nothing(heading):
    one = new_round()
    with pytest.raises(InputError, match="heading"):
        one.move(heading, 0)
    assert not one.moves


@pytest.mark.parametrize("first", [0, 1])
def test_a_plan_has_every_pair_and_every_block(first: int):
    settings = StudySettings()
    plan = plan_rounds(settings, stream(0, "test"), first)
    assert len(plan) == settings.rounds == 92
    phases = [one.phase for one in plan]
    assert phases == sorted(phases, key=[PRACTICE, TRAINING, TEST].index)
    pairs = Counter((one.size, one.speed) for one in plan if one.phase == TRAINING)
    assert pairs == {(b, z): settings.training for b in settings.sizes for z in settings.speeds}
    test = [one for one in plan if one.phase == TEST]
    assert Counter((one.size, one.method) for one in test) == {
        (size, method): settings.test for size in settings.sizes for method in METHODS
    }
    firsts = [one.method for one in test[:: 2 * settings.test]]
    assert firsts[0] == METHODS[first]
    assert all(a != b for a, b in pairwise(firsts))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("player", "robot"), ("sizes", ()), ("sizes", (2, 2)), ("speeds", (35,)), ("training", 0), ("test", 11),
        ("practice", -1), ("frames_per_move", 0),
    ],
)  # fmt: skip
def test_a_wrong_setting_is_named(name, value):
    with pytest.raises(InputError, match=name):
        StudySettings(**{name: value})


def test_a_session_goes_from_practice_to_the_end(played):
    assert [row["phase"] for row in played.done] == [PRACTICE] + 4 * [TRAINING] + 8 * [TEST]
    assert played.next_round is None
    with pytest.raises(InputError, match="finished"):
        played.begin()


def test_a_blinded_player_is_shown_neither_method_nor_speed():
    session = StudySession("ada", SMALL, scripted_others(SMALL.layout))
    shown = []
    while (following := session.next_round) is not None:
        answers = [session.view()["next"], session.begin(), session.move(2)]
        if following.phase == TEST:
            shown.append([set(answer) for answer in answers])
            assert not {"speed", "method", "block"} & set().union(*shown[-1])
        session.begin()
        while not session.playing.over:
            session.move(heading_of_script(session.playing))
        session.finish()
    assert shown == [shown[0]] * 8


def test_a_round_that_begins_again_has_the_same_noise():
    session = StudySession("ada", SMALL, scripted_others(SMALL.layout))
    with pytest.raises(InputError, match="begin one first"):
        session.move(2)
    again = [(session.begin(), [session.move(2) for _ in range(9)]) for _ in range(2)]
    assert again[0] == again[1]
    with pytest.raises(InputError, match="not over"):
        session.finish()


def test_blocks_keep_to_their_method(played):
    for row in played.done:
        speeds, named = set(column(row, "speed").tolist()), column(row, "named")
        if row["method"] == BEAT:
            assert row["speed"] is None
            assert speeds <= {SPEEDS.index(speed) for speed in SMALL.speeds}
            assert SIZES[named[-1]] == row["size"]  # BEAT recognises the ball from its moves alone
        else:
            assert row["speed"] == (played.static_speed if row["method"] == STATIC else row["speed"])
            assert speeds == {SPEEDS.index(row["speed"])}
            assert (named == -1).all()


def test_beat_goes_on_through_the_rounds_of_a_block(played):
    """The belief is sure from the first move of the second round on, which it is not in the first round."""
    rows = [row for row in played.done if row["method"] == BEAT]
    for block in {row["block"] for row in rows}:
        _, second = (row for row in rows if row["block"] == block)
        assert SIZES[column(second, "named")[0]] == second["size"]
    assert any(SIZES[column(row, "named")[0]] != row["size"] for row in rows)


def test_best_static_speed_and_values_by_hand():
    zeros = np.zeros((len(SIZES), len(SPEEDS)), np.int64)
    totals = TrainingTotals(zeros + 2, zeros + 200, zeros.copy(), np.zeros((5, N_SIGNALS, 6), np.int64))
    totals.hits[SIZES.index(60), SPEEDS.index(70)] = 40
    assert totals.mean_loss[0, 0] == pytest.approx(100 / 400)
    assert best_static_speed(totals, SMALL) == 30
    totals.steps[SIZES.index(2), SPEEDS.index(70)] = 0
    assert totals.mean_loss[pairs_of(SMALL)].tolist() == [[0.25, 0.0], [0.25, 1.25]]
    own = TrainingTotals(zeros, zeros, zeros, totals.moves)
    assert expected_values(own, totals, SMALL).tolist() == [[-0.25, 0.0], [-0.25, -1.25]]
    once = own._replace(rounds=zeros + 1, steps=zeros + 400)
    assert expected_values(once, totals, SMALL).tolist() == [[-0.625, -0.5], [-0.625, -1.125]]


def test_a_file_has_what_was_played_and_later_sessions_know_it(tmp_path, played):
    where = tmp_path / "rounds.jsonl"
    assert recorded_sessions(where) == []
    first = new_session(where, SMALL, "consent")
    for row in played.done:
        store_round(where, first, row)
    (recorded,) = recorded_sessions(where)
    assert (recorded.settings, recorded.rows, recorded.finished) == (SMALL, played.done, True)
    totals, players = other_players([recorded], SMALL)
    own = TrainingTotals.of(played.done)
    assert (players, totals.steps.tolist()) == (PERSON, own.steps.tolist())
    assert (totals.moves >= own.moves).all()
    faster = StudySettings(sizes=(2, 60), speeds=(30, 70), frames_per_move=1)
    assert other_players([recorded], faster)[1] == SCRIPTED
    # The method that begins alternates between people.
    assert first.plan[-1].method != new_session(where, SMALL, "consent").plan[-1].method
    assert json.loads(where.read_text().splitlines()[0])["consent"] == "consent"


@pytest.mark.parametrize("line", ["[]", "{", '{"session": "a", "round": {}}', '{"session": "a"}'])
def test_a_wrong_line_of_a_file_is_named(tmp_path, line):
    (tmp_path / "rounds.jsonl").write_text(line)
    with pytest.raises(InputError, match=r"rounds\.jsonl line 1: "):
        recorded_sessions(tmp_path / "rounds.jsonl")


def row(size, speed, loss, method=""):
    return {"size": size, "speed": speed, "loss": loss, "method": method}


def test_losses_by_speed_by_hand():
    found = losses_by_speed([row(2, 30, 1.0), row(2, 30, 3.0), row(60, 70, 0.5)])
    assert found == [{"size": 2, "speed": 30, "loss": 2.0}, {"size": 60, "speed": 70, "loss": 0.5}]


def test_losses_by_diversity_by_hand():
    training = [row(2, 30, 1.0), row(2, 70, 0.0), row(60, 30, 1.0), row(60, 70, 4.0), row(20, 30, 9.0)]
    test = [row(2, None, 0.2, BEAT), row(60, None, 1.2, BEAT), row(60, 30, 1.0, STATIC)]
    # One type: the best speeds lose 0 and 1. Both types: 30 loses 1 on average, 70 loses 2.
    assert losses_by_diversity(training, test) == [
        {"types": 1, "static": 0.5, "beat": pytest.approx(0.7)},
        {"types": 2, "static": 1.0, "beat": pytest.approx(0.7)},
    ]


def test_the_ratio_stays_at_its_last_value():
    path = [[0, 0, 0, 0, 0, 0, named] for named in (0, 5, 3)]
    ratio = ratio_by_move({"size": 20, "path": path})
    assert ratio[:4].tolist() == [0.1, 3.0, 1.0, 1.0]
    assert ratio.shape == (STEPS,)
