"""Tasks that are one decision process are found, certain or not; tasks that differ are not called one."""

from itertools import combinations

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.toy_text.frozen_lake import generate_random_map

from lifelore.agent.any_tasks.live_in import live_in
from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld
from lifelore.agent.external_world.task_differences import CERTAIN, TaskDifferences, homogeneity


def lake(number, slippery):
    return gymnasium.make("FrozenLake-v1", desc=generate_random_map(4, seed=number), is_slippery=slippery)


def walked(task_maps, slippery, steps=2000):
    """Random walks over a map for each task."""
    differences, random = TaskDifferences(), np.random.default_rng(0)
    for number in task_maps:
        env = lake(number, slippery).unwrapped
        state, _ = env.reset(seed=int(random.integers(2**31)))
        for action in random.integers(4, size=steps).tolist():
            following, reward, terminated, _, _ = env.step(action)
            differences.see(state, action, following, float(reward), terminated)
            state = env.reset()[0] if terminated else following
        differences.end_task()
    return differences


@pytest.mark.parametrize("slippery", [False, True])
def test_one_map_met_again_is_one_task_and_two_maps_are_two(slippery):
    assert walked([3] * 5, slippery).one_task
    for other in (4, 6):
        assert lake(3, False).unwrapped.desc.tobytes() != lake(other, False).unwrapped.desc.tobytes()
        assert not walked([3, other], slippery).one_task
        assert not walked([3, 3, other], slippery).one_task


def told(*tasks):
    """Whether tasks of transitions are called one."""
    differences = TaskDifferences()
    for transitions in tasks:
        for transition in transitions:
            differences.see(*transition)
        differences.end_task()
    return differences.one_task


def test_other_states_and_a_reward_alone_tell_tasks_apart_and_few_transitions_decide_nothing():
    def ring(states, paid=1.0):
        return [(states[k % 5], 0, states[(k + 1) % 5], paid if k % 5 == 4 else 0.0, False) for k in range(200)]

    assert told(ring("abcde"), ring("abcde"))
    assert not told(ring("abcde"), ring("abcde", 2.0))
    assert not told(ring("abcde"), ring("fghij"), ring("klmno"))
    assert not told([("a", 0, "b", 0.0, True)], [("a", 0, "b", 0.0, True)])


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
    with pytest.warns(UserWarning, match="Nothing that was observed tells the . tasks of FrozenLake-v1 apart"):
        report = live_in(once, tasks=3, episodes=80)
    assert len(report["warnings"]) == 1
    maps = GymnasiumWorld(lambda task: lake(task, False), context=lambda place: place % 4)
    assert not [text for text in live_in(maps, tasks=3, episodes=80)["warnings"] if "apart" in text]
