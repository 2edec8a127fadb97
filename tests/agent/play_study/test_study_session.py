"""The session of a player: its phases, its blinding, its frames, and coming back to it."""

import json

import numpy as np
import pytest

from lifelore.agent.play_study.scripted_player import heading_of_script, play_next_round, scripted_others
from lifelore.agent.play_study.study_models import (
    TrainingTotals,
    beat_for,
    best_static_speed,
    expected_values,
    pairs_of,
)
from lifelore.agent.play_study.study_plan import BEAT, STATIC
from lifelore.agent.play_study.study_session import StudySession
from lifelore.agent.play_study.study_settings import StudySettings
from lifelore.core.errors import InputError
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS

OTHERS = scripted_others("s-maze 160")

SMALL = StudySettings(sizes=(2, 60), speeds=(30, 70), practice=1, training=1, test=2, frames_per_move=3)


def new_session(**options) -> StudySession:
    return StudySession("ada", SMALL, OTHERS, **options)


def played(session: StudySession) -> StudySession:
    while session.next_round is not None:
        session.accept(play_next_round(session))
    return session


def test_a_session_goes_from_practice_to_the_end():
    session, phases = new_session(), []
    while session.next_round is not None:
        phases.append(session.phase)
        session.accept(play_next_round(session))
    assert phases == ["practice"] + 4 * ["training"] + 8 * ["test"]
    assert session.phase == "finished"
    with pytest.raises(InputError, match="finished"):
        session.begin()


def test_a_blinded_player_is_shown_neither_method_nor_speed():
    session = new_session()
    while session.phase != "test":
        session.accept(play_next_round(session))
    scenes = []
    while session.next_round is not None:
        view, scene = session.view(), session.begin()
        session.steer(2)
        frame = session.frame()
        text = json.dumps([view["next"], scene, frame])
        assert "speed" not in text
        assert "method" not in text
        assert "block" not in text
        scenes.append((set(view["next"]), set(scene), set(frame)))
        with pytest.raises(InputError, match="blinded"):
            session.belief()
        with pytest.raises(InputError, match="test"):
            session.begin_free(60)
        session.leave()
        session.accept(play_next_round(session))
    assert scenes == [scenes[0]] * 8


def test_blocks_keep_to_their_method():
    session = played(new_session())
    for result in session.done:
        speeds, named = set(result.column("speed").tolist()), result.column("named")
        if result.planned.method == BEAT:
            assert result.speed is None
            assert (named >= 0).all()
            assert speeds <= {SPEEDS.index(speed) for speed in SMALL.speeds}
        else:
            expected = session.static_speed if result.planned.method == STATIC else result.planned.speed
            assert speeds == {SPEEDS.index(expected)}
            assert (named == -1).all()


def test_a_session_goes_on_where_it_was_left():
    whole = played(new_session())
    for cut in (1, 6, 8):
        again = played(new_session(done=whole.done[:cut]))
        assert [r.row for r in again.done] == [r.row for r in whole.done]
        assert all((a.moves == b.moves).all() for a, b in zip(again.done, whole.done, strict=True))


def test_a_round_that_was_left_begins_again_with_the_same_noise():
    session = new_session()
    session.begin()
    session.steer(2)
    first = [session.frame() for _ in range(9)]
    session.leave()
    with pytest.raises(InputError, match="begin"):
        session.frame()
    session.begin()
    session.steer(2)
    assert [session.frame() for _ in range(9)] == first


def test_frames_glide_from_place_to_place():
    session = new_session()
    scene = session.begin()
    waiting = session.frame()
    assert (waiting["x"], waiting["y"], waiting["moves"]) == (scene["x"], scene["y"], 0)
    session.steer(2)
    frames = [session.frame() for _ in range(3)]
    assert [frame["moves"] for frame in frames] == [1, 1, 1]
    end = session.playing.x
    steps = np.diff([scene["x"], *(frame["x"] for frame in frames)])
    assert frames[-1]["x"] == end
    assert steps == pytest.approx([steps[0]] * 3, abs=0.2)
    assert session.frame()["moves"] == 2


def test_a_free_round_shows_its_belief_and_leaves_no_result():
    session = new_session()
    session.begin_free(60)
    assert session.belief() == pytest.approx({"2": 0.5, "60": 0.5})
    over = False
    while not over:
        session.steer(heading_of_script(session.playing))
        frame = session.frame()
        over = frame["over"]
        assert frame["speed"] in SMALL.speeds
    assert session.belief()["60"] > 0.9
    assert session.result() is None
    assert not session.done
    with pytest.raises(InputError, match="size"):
        session.begin_free(20)


def test_best_static_speed_and_values_by_hand():
    zeros = np.zeros((len(SIZES), len(SPEEDS)), np.int64)
    totals = TrainingTotals(zeros + 2, zeros + 200, zeros.copy(), np.zeros((5, 2352, 6), np.int64))
    totals.hits[SIZES.index(60), SPEEDS.index(70)] = 40
    assert totals.mean_loss[0, 0] == pytest.approx(100 / 400)
    assert best_static_speed(totals, SMALL) == 30
    totals.steps[SIZES.index(2), SPEEDS.index(70)] = 0
    assert totals.mean_loss[pairs_of(SMALL)].tolist() == [[0.25, 0.0], [0.25, 1.25]]
    own = TrainingTotals(zeros, zeros, zeros, totals.moves)
    assert expected_values(own, totals, SMALL).tolist() == [[-0.25, 0.0], [-0.25, -1.25]]
    once = own._replace(rounds=zeros + 1, steps=zeros + 400)
    assert expected_values(once, totals, SMALL).tolist() == [[-0.625, -0.5], [-0.625, -1.125]]


def test_beat_learns_a_large_ball_from_moves_alone():
    beat = beat_for(TrainingTotals.of([]), OTHERS.totals, SMALL)
    session = played(new_session())
    for result in session.done:
        if result.planned.method == BEAT:
            named = result.column("named")[-1]
            assert SIZES[named] == result.planned.size
    assert beat.belief.tolist() == [0.5, 0.5]
