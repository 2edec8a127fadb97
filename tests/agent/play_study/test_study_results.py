"""Numbers of Figures 4.18-4.20: by hand, and from sessions that a script played."""

from dataclasses import replace

import numpy as np
import pytest

from lifelore.agent.play_study.round_result import RoundResult
from lifelore.agent.play_study.study_plan import BEAT, STATIC, Round
from lifelore.agent.play_study.study_results import (
    STEPS,
    block_differences,
    losses_by_diversity,
    losses_by_speed,
    ratio_by_move,
    study_results,
)
from lifelore.agent.play_study.study_settings import StudySettings
from lifelore.memory import open_memory

SMALL = StudySettings(sizes=(2, 60), speeds=(30, 70), practice=1, training=1, test=2, frames_per_move=3)


def row(size, speed, loss, method="", number=0):
    return {"size": size, "speed": speed, "loss": loss, "method": method, "number": number}


def test_losses_by_speed_by_hand():
    found = losses_by_speed([row(2, 30, 1.0), row(2, 30, 3.0), row(60, 70, 0.5)])
    assert found == [
        {"size": 2, "speed": 30, "loss": 2.0, "interval": pytest.approx(1.96), "rounds": 2},
        {"size": 60, "speed": 70, "loss": 0.5, "interval": None, "rounds": 1},
    ]


def test_losses_by_diversity_by_hand():
    training = [row(2, 30, 1.0), row(2, 70, 0.0), row(60, 30, 1.0), row(60, 70, 4.0), row(20, 30, 9.0)]
    test = [row(2, None, 0.2, BEAT), row(60, None, 1.2, BEAT), row(60, 30, 1.0, STATIC)]
    found = losses_by_diversity(training, test)
    # One type: the best speeds lose 0 and 1. Both types: 30 loses 1 on average, 70 loses 2.
    assert found == [
        {"types": 1, "static": 0.5, "beat": pytest.approx(0.7), "populations": 2},
        {"types": 2, "static": 1.0, "beat": pytest.approx(0.7), "populations": 1},
    ]


def test_block_differences_by_hand():
    own = {size: [row(size, None, 1.0, BEAT), row(size, 30, 1.5 + size, STATIC)] for size in (2, 5, 10)}
    sessions = {"ada": own[2] + own[5] + [row(20, None, 0.0, BEAT)], "ben": own[10]}
    found = block_differences(sessions)
    assert found["pairs"] == 3
    assert found["difference"] == pytest.approx(1.0 - 1.5 - (2 + 5 + 10) / 3)
    assert found["interval"][0] <= found["difference"] <= found["interval"][1]
    assert block_differences({})["pairs"] == 0


def test_the_ratio_stays_at_its_last_value():
    moves = np.zeros((3, 7), np.int64)
    moves[:, 6] = [0, 5, 3]
    result = RoundResult(0, Round("test", 20, None, BEAT, 0), None, 1.0, moves, True)
    assert ratio_by_move(result)[:4].tolist() == [0.1, 3.0, 1.0, 1.0]
    assert ratio_by_move(result).shape == (STEPS,)


def test_people_stay_untested_while_scripts_play(tmp_path, play_all):
    with open_memory(tmp_path / "m.db") as memory:
        assert study_results(memory) == {"people_untested": True, "groups": []}
        play_all(memory, replace(SMALL, player="scripted"))
        play_all(memory, SMALL, rounds=5)
        found = study_results(memory)
        assert found["people_untested"]
        by_player = {group["player"]: group for group in found["groups"]}
        assert by_player["scripted"]["finished"] == by_player["scripted"]["sessions"] == 1
        assert by_player["person"]["finished"] == 0
        script = by_player["scripted"]
        assert script["sizes"] == [2, 60]
        assert {(cell["size"], cell["speed"]) for cell in script["losses"]} == {
            (2, 30),
            (2, 70),
            (60, 30),
            (60, 70),
        }
        assert [point["types"] for point in script["diversity"]] == [1, 2]
        assert [(one["size"], one["rounds"]) for one in script["named"]] == [(2, 1), (60, 1)]
        assert script["blocks"]["pairs"] == 2
        play_all(memory, SMALL)
        assert not study_results(memory)["people_untested"]
