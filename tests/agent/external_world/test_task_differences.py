"""Tasks that are one decision process are found, certain or not; tasks that differ are not called one."""

from itertools import combinations

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.toy_text.frozen_lake import generate_random_map

from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld
from lifelore.agent.external_world.live_in import live_in
from lifelore.agent.external_world.task_differences import CERTAIN, TaskDifferences, homogeneity

SAME = "Nothing that was observed tells the . tasks of FrozenLake-v1 apart"


def lake(number, slippery):
    return gymnasium.make("FrozenLake-v1", desc=generate_random_map(4, seed=number), is_slippery=slippery)


def walked(task_maps, slippery, steps=2000):
    """Random walks over a map for each task."""
    differences, random = TaskDifferences(), np.random.default_rng(0)
    for number in task_maps:
        env = lake(number, slippery)
        state, _ = env.reset(seed=int(random.integers(2**31)))
        for _ in range(steps):
            action = int(random.integers(4))
            following, reward, terminated, truncated, _ = env.step(action)
            differences.see(state, action, following, float(reward), terminated)
            state = env.reset()[0] if terminated or truncated else following
        differences.end_task()
    return differences


@pytest.mark.parametrize("slippery", [False, True])
def test_one_map_met_again_is_one_task(slippery):
    assert walked([3] * 5, slippery).one_task


@pytest.mark.parametrize("slippery", [False, True])
@pytest.mark.parametrize("other", range(4, 8))
def test_two_maps_are_two_tasks(slippery, other):
    assert lake(3, False).unwrapped.desc.tobytes() != lake(other, False).unwrapped.desc.tobytes()
    assert not walked([3, other], slippery).one_task
    assert not walked([3, 3, other], slippery).one_task


def test_tasks_in_other_states_are_not_one():
    differences = TaskDifferences()
    for task in range(3):
        for step in range(300):
            differences.see((task, step % 10), 0, (task, (step + 1) % 10), 0.0, False)
        differences.end_task()
    assert not differences.one_task


def test_a_reward_alone_tells_tasks_apart_in_a_certain_world():
    for paid, one in ((1.0, True), (2.0, False)):
        differences = TaskDifferences()
        for reward in (1.0, paid):
            for step in range(200):
                differences.see(step % 5, 0, (step + 1) % 5, reward if step % 5 == 4 else 0.0, False)
            differences.end_task()
        assert differences.one_task is one


def test_few_transitions_decide_nothing():
    differences = TaskDifferences()
    for _ in range(2):
        differences.see("a", 0, "b", 0.0, True)
        differences.end_task()
    assert not differences.one_task


def test_a_row_of_uncertain_outcomes_against_all_deals():
    """The naive twin deals every subset of the outcomes to the first row: 10 over 5, 252 deals."""
    table = np.array([[5, 0], [1, 4]])
    outcomes = [0] * 6 + [1] * 4

    def chi2(first):
        expected, second = np.array([3.0, 2.0]), table.sum(axis=0) - first
        return sum(float((np.square(row - expected) / expected).sum()) for row in (first, second))

    deals = [np.bincount([outcomes[i] for i in own], minlength=2) for own in combinations(range(10), 5)]
    exact = np.mean([chi2(first) >= chi2(table[0]) - 1e-9 for first in deals])
    # 199 deals give a share with a deviation of √(p (1 - p) / 199) = 0.015 at p = 0.048; four of them are 0.06.
    assert homogeneity([table]) == pytest.approx(exact, abs=0.06)
    # Three such tables are certain together: three independent coincidences.
    assert homogeneity([table] * 3) <= CERTAIN
    assert homogeneity([np.array([[1, 0], [0, 1]])] * 50) == 1.0


def test_a_life_on_one_map_warns_and_on_several_does_not():
    once = GymnasiumWorld(gymnasium.make("FrozenLake-v1", is_slippery=False))
    with pytest.warns(UserWarning, match=SAME):
        report = live_in(once, tasks=3, episodes=80)
    assert len(report["warnings"]) == 1
    maps = GymnasiumWorld(lambda task: lake(task, False), context=lambda place: place % 4)
    assert not [text for text in live_in(maps, tasks=3, episodes=80)["warnings"] if "apart" in text]
