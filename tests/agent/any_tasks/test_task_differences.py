"""Tasks that are one decision process are found, certain or not; tasks that differ are not called one."""

import gymnasium
import pytest
from gymnasium.envs.toy_text.frozen_lake import generate_random_map

from lifelore.agent.any_tasks.live_in import live_in
from lifelore.agent.any_tasks.moves import MoveCodes, counted
from lifelore.agent.any_tasks.task_differences import TaskDifferences
from lifelore.agent.external_world.episode import Step
from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld


def lake(number, slippery):
    return gymnasium.make("FrozenLake-v1", desc=generate_random_map(4, seed=number), is_slippery=slippery)


def told(*tasks):
    """Whether tasks of transitions are called one."""
    differences, codes = TaskDifferences(), MoveCodes()
    for transitions in tasks:
        steps = [Step(codes.states[a], 0, act, paid, codes.states[b], end) for a, act, b, paid, end in transitions]
        differences.end_task(counted(steps, codes))
    return differences.one_task


def test_other_states_and_a_reward_alone_tell_tasks_apart_and_few_transitions_decide_nothing():
    def ring(states, paid=1.0):
        n = len(states)
        return [(states[k % n], 0, states[(k + 1) % n], paid if k % n == 4 else 0.0, False) for k in range(10 * n)]

    one, other, third = range(30), range(30, 60), range(60, 90)
    assert told(ring(one), ring(one))
    assert not told(ring(one), ring(one, 2.0))
    assert not told(ring(one), ring(other), ring(third))
    assert not told(ring("abcde"), ring("abcde"))
    assert not told([("a", 0, "b", 0.0, True)], [("a", 0, "b", 0.0, True)])


@pytest.mark.parametrize("slippery", [False, True])
def test_a_life_on_one_map_warns_and_on_several_does_not(slippery):
    once = GymnasiumWorld(lake(3, slippery))
    with pytest.warns(UserWarning, match="Nothing that was observed tells the . tasks of FrozenLake-v1 apart"):
        report = live_in(once, tasks=3, episodes=80)
    assert len(report["warnings"]) == 1
    maps = GymnasiumWorld(lambda task: lake((3, 3, 4)[task], slippery), context=lambda place: place % 4)
    assert not [text for text in live_in(maps, tasks=3, episodes=80)["warnings"] if "apart" in text]
