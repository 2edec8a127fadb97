"""The environment of a task whose outcomes are random equals its tables under the same numbers."""

import numpy as np
from gymnasium.utils import seeding

from lifelore import Domain, Task
from lifelore.core import NOTHING, TERMINAL
from lifelore.domains import TaskEnvironment


def drift(params, s, a, u):
    """On a line of six: the step slips back in three of ten cases, the right end is the end."""
    (reward,) = params
    s2 = min(max(s + (2 * a - 1) * (1 if u >= 0.3 else -1), 0), 5)
    return s2, reward * s2, TERMINAL if s2 == 5 else NOTHING


def test_a_rollout_equals_the_tables_under_the_same_uniforms():
    task = Task(Domain("line", 6, 2, drift, 0.9, outcome_probs=(0.3, 0.7)), (0.1,), np.array([0, 1, 2], np.int32))
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
