"""The environment of a task that is not a grid: random outcomes, equal to its tables under the same numbers."""

import numpy as np
import pytest
from gymnasium.utils import seeding

from lifelore.core.errors import InputError
from lifelore.core.mdp import NOTHING, TERMINAL, Domain, Task
from lifelore.domains.task_environment import TaskEnvironment


def drift(params, s, a, u):
    """On a line of six: the step slips back in three of ten cases, the right end is the end."""
    (reward,) = params
    s2 = min(max(s + (2 * a - 1) * (1 if u >= 0.3 else -1), 0), 5)
    return s2, reward * s2, TERMINAL if s2 == 5 else NOTHING


@pytest.fixture
def task():
    domain = Domain("line", 6, 2, drift, 0.9, outcome_probs=(0.3, 0.7))
    return Task(domain, (0.1,), np.array([0, 1, 2], np.int32))


def test_a_rollout_equals_the_tables_under_the_same_uniforms(task):
    env, tables = TaskEnvironment(task), task.tables()
    uniforms, _ = seeding.np_random(7)
    state, _ = env.reset(seed=7)
    assert state == task.starts[int(uniforms.random() * 3)]
    ended = 0
    for action in np.random.default_rng(0).integers(2, size=300):
        outcome = np.searchsorted(tables.outcome_cum, uniforms.random(), side="right")
        expected = [table[state, action, outcome] for table in (tables.next_state, tables.reward)]
        state, reward, terminated, truncated, _ = env.step(action)
        assert [state, reward] == expected
        assert not truncated
        if terminated:
            ended += 1
            state, _ = env.reset()
            assert state == task.starts[int(uniforms.random() * 3)]
    assert ended > 3


def test_a_start_may_be_chosen(task):
    env = TaskEnvironment(task)
    assert env.reset(seed=0, options={"state": 4})[0] == 4
    for wrong in (6, -1, 1.5, "a", True):
        with pytest.raises(InputError, match=r"options\['state'\]"):
            env.reset(options={"state": wrong})


def test_misuse_is_told(task):
    env = TaskEnvironment(task)
    with pytest.raises(InputError, match="reset"):
        env.step(0)
    env.reset(seed=0)
    with pytest.raises(InputError, match=r"action must lie in \[0, 2\), got 2"):
        env.step(2)
    with pytest.raises(InputError, match="render_mode must be None or one of: none; got 'human'"):
        TaskEnvironment(task, render_mode="human")
