"""The order of rounds: every pair is trained, blocks are balanced, and settings keep their rules."""

from collections import Counter
from itertools import pairwise

import pytest

from lifelore.agent.play_study.study_plan import METHODS, PRACTICE, TEST, TRAINING, plan_rounds
from lifelore.agent.play_study.study_settings import LENGTHS, StudySettings
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream


@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("first", [0, 1])
def test_a_plan_has_every_pair_and_every_block(length: str, first: int):
    settings = StudySettings.of_length(length)
    plan = plan_rounds(settings, stream(0, "test", length), first)
    assert len(plan) == settings.rounds
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
    assert all(one.speed is None for one in test)


@pytest.mark.parametrize(
    ("wrong", "name"),
    [
        ({"player": "robot"}, "player"),
        ({"sizes": ()}, "sizes"),
        ({"sizes": (2, 2)}, "sizes"),
        ({"speeds": (35,)}, "speeds"),
        ({"training": 0}, "training"),
        ({"test": 11}, "test"),
        ({"practice": -1}, "practice"),
        ({"frames_per_move": 0}, "frames_per_move"),
    ],
)
def test_a_wrong_setting_is_named(wrong: dict, name: str):
    with pytest.raises(InputError, match=name):
        StudySettings(**wrong)


def test_settings_come_back_from_their_document():
    settings = StudySettings.of_length("short", "scripted", 2)
    assert StudySettings.from_document(settings.document) == settings
    with pytest.raises(NotFoundError, match="length"):
        StudySettings.of_length("long")
