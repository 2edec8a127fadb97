"""Tasks derive from seed and number."""

import numpy as np

from lifelore.agent.live.task_stream import TaskStream
from lifelore.domains.worlds import make_world

from .flat_settings import flat_settings

LATTICE = make_world("lattice")


def stream_of(**settings) -> TaskStream:
    return TaskStream(LATTICE, flat_settings(**settings))


def test_goals_depend_on_seed_and_number_alone():
    one, again, other = stream_of(seed=1), stream_of(seed=1, tasks=3), stream_of(seed=2)
    goals = [one.goal(i) for i in range(20)]
    assert goals == [again.goal(i) for i in range(20)]
    assert goals != [other.goal(i) for i in range(20)]
    assert len(set(goals)) > 10


def test_destinations_recur():
    goals = {stream_of(destinations=3).goal(i) for i in range(60)}
    # Missing one of three in 60 draws has probability 3 (2/3)^60 < 1e-10.
    assert len(goals) == 3


def test_starts_are_anywhere_but_the_goal_or_the_given_start():
    task = stream_of().task(0)
    assert set(task.starts) == set(range(LATTICE.n_states)) - {task.goal}
    fixed = TaskStream(LATTICE, flat_settings(), start=2)
    assert fixed.task(0).starts.tolist() == [2]
    assert fixed.task(0, goal=7).goal == 7


def test_agents_share_their_streams():
    stream = stream_of()
    assert np.array_equal(stream.own_stream(4).random(3), stream_of().own_stream(4).random(3))
    assert not np.array_equal(stream.own_stream(4).random(3), stream.world_stream(4).random(3))
