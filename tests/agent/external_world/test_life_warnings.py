"""Sentences on lives that teach nothing or mislead, and silence on lives that do."""

import gymnasium
import numpy as np
import pytest

from lifelore.agent.any_tasks.live_in import live_in
from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld
from lifelore.agent.external_world.life_summary import summarise_life
from lifelore.agent.external_world.life_warnings import ContextNovelty, life_warnings, new_states

pytestmark = pytest.mark.filterwarnings("ignore:(Nothing that was observed|The action prior is empty)")


def warned(novelty=0.0, one_task=False, n_contexts=5, tasks=9, summary=None):
    return life_warnings("lake", tasks, n_contexts, novelty, one_task, summary or {})


def test_new_contexts_by_hand():
    """Codes 1 and 2 are known before; tasks of 2, 4, 2 and 1 states have 1, 2, 0 and 1 new ones."""
    novelty = ContextNovelty([1, 2])
    for codes in ([1, 3], [2, 3, 4, 5], [4, 4], [6]):
        novelty.end_task(codes)
    assert novelty.shares == [0.5, 0.5, 0.0, 1.0]
    assert novelty.late == 0.5  # of the last two tasks
    early = ContextNovelty([])
    for codes in ([1], [2], [3]):
        early.end_task(codes)
    assert early.late == 0.0  # three tasks say nothing


def test_a_forgotten_state_is_said():
    """CartPole's numbers never come twice, so each state and context is new."""
    with pytest.warns(UserWarning, match="Of the states met in later tasks of CartPole-v1, 100% have"):
        forgotten = live_in(GymnasiumWorld(gymnasium.make("CartPole-v1")), tasks=4, episodes=4)
    assert any("Pass context= (few, coarse features), and state=" in text for text in forgotten["warnings"])
    env = gymnasium.make("CartPole-v1")
    coarse = GymnasiumWorld(env, lambda seen: bool(seen[2] > 0), lambda seen: tuple(np.rint(10 * seen).tolist()))
    assert not any("no earlier task" in text for text in live_in(coarse, tasks=4, episodes=4)["warnings"])


@pytest.mark.parametrize("other", ["scratch", "textbook"])
def test_a_certain_loss_at_the_end_is_said(other):
    def tasks(losses):
        alike = {"first_return": 0.0, "mean_return": 0.0, "reached": True, "final_return": 0.5}
        return [
            {"agents": {**dict.fromkeys(("scratch", "textbook"), alike), "lore": alike, other: alike | {
                "final_return": 0.5 + loss}}}
            for loss in losses
        ]  # fmt: skip

    names = ("lore", "scratch", "textbook")
    certain = summarise_life(tasks([0.1, 0.2, 0.3, 0.4] * 3), names)
    (sentence,) = warned(summary=certain)
    assert sentence.startswith(
        f"The final return of lore is certainly below that of {other}: a difference of -0.25"
    )
    assert "over 4 tasks" in sentence
    assert warned(summary=summarise_life(tasks([-0.1, 0.2, -0.3, 0.4] * 3), names)) == []
    assert warned(summary=summarise_life(tasks([0.1] * 4), names)) == []  # one task of four: no interval


def test_each_trouble_has_its_sentence_and_a_good_life_none():
    assert warned() == []
    assert warned(tasks=0, n_contexts=0) == []
    assert [text.split(" ")[0] for text in warned(n_contexts=0, one_task=True, novelty=0.96)] == [
        "The", "Nothing", "Of",
    ]  # fmt: skip
    assert "96% have a context" in warned(novelty=0.96)[0]


def test_states_that_hardly_repeat():
    assert new_states("lake", range(199)) == []
    assert new_states("lake", [*range(179), *range(21)]) == []
    [said] = new_states("lake", [*range(180), *range(20)])
    assert "Of 200 moves in a task of lake, 90% began in a state that the task had not met before" in said
    assert "Pass state=" in said
