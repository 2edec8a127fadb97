"""MiniGrid as arrays: views and ways by hand, poses solved exactly by walking, contexts as the robot sees them."""

import gymnasium
import numpy as np
import pytest
from gymnasium.spaces import Discrete
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lifelore.bridges.minigrid_view import (
    BLOCKED,
    FREE,
    GOAL,
    RIGHT,
    UNSEEN,
    SymbolicView,
    open_directions,
    solved_layout,
)
from lifelore.core.errors import InputError

minigrid = pytest.importorskip("minigrid")

CROSSING = "MiniGrid-SimpleCrossingS9N3-v0"


def cells(observation):
    """Kinds (7, 7) and the compass of one observation."""
    assert (observation[:196].reshape(49, 4).sum(axis=1) == 1).all()
    assert observation[196:].sum() == 1
    return observation[:196].reshape(7, 7, 4).argmax(axis=-1), int(observation[196:].argmax())


def poses_by_search(env):
    """Steps to the goal of every pose by a breadth-first search in the environment itself."""
    inner, steps = env.unwrapped, {}
    goal = tuple(int(x) for x in np.argwhere(inner.grid.encode()[..., 0] == 8)[0])

    def follow(pose, move):
        inner.agent_pos, inner.agent_dir, inner.step_count = (pose[0], pose[1]), pose[2], 0
        env.step(move)
        return (int(inner.agent_pos[0]), int(inner.agent_pos[1]), int(inner.agent_dir))

    start = (int(inner.agent_pos[0]), int(inner.agent_pos[1]), int(inner.agent_dir))
    # Not from the start alone: a cell can lie behind the goal.
    free = np.argwhere(inner.grid.encode()[..., 0] == 1).tolist()
    following, open_poses = {}, [(x, y, d) for x, y in free for d in range(4)]
    while open_poses:
        pose = open_poses.pop()
        if pose in following or pose[:2] == goal:
            continue
        following[pose] = [follow(pose, move) for move in range(3)]
        open_poses += following[pose]
    steps = {pose: 0 for after in following.values() for pose in after if pose[:2] == goal}
    for number in range(1, 500):
        known = set(steps)
        for pose, after in following.items():
            if pose not in known and any(one in known for one in after):
                steps[pose] = number
    return start, following, steps


def test_the_view_by_hand():
    env = SymbolicView(gymnasium.make("MiniGrid-Empty-5x5-v0"))
    observation, _ = env.reset(seed=0)
    assert env.observation_space.contains(observation)
    assert env.action_space == Discrete(3)
    # In the upper left corner looking right: the robot at (3, 6), two free cells before it, then the outer wall;
    # to its right two more rows, the goal in the far corner. This world lets it see through walls: beyond is wall.
    kinds, compass = cells(observation)
    assert compass == 0
    assert kinds[3].tolist() == [BLOCKED] * 4 + [FREE] * 3
    assert kinds[2].tolist() == [BLOCKED] * 7
    assert kinds[5].tolist() == [BLOCKED] * 4 + [GOAL, FREE, FREE]
    assert open_directions(observation[None]).tolist() == [0b110]  # right and front
    assert open_directions(np.stack([observation, env.step(RIGHT)[0], env.step(RIGHT)[0]])).tolist() == [
        6,
        0b011,
        0b001,
    ]


def test_what_walls_hide_is_unseen():
    env = SymbolicView(gymnasium.make(CROSSING))
    kinds, _ = cells(env.reset(seed=0)[0])
    # At the left wall, which hides all that is to its left.
    assert kinds[2].tolist()[-1] == BLOCKED
    assert (kinds[:2] == UNSEEN).all()
    assert cells(env.step(RIGHT)[0])[1] == 1  # it looks down


@pytest.mark.slow
@settings(deadline=None, max_examples=4)
@given(st.integers(0, 10_000))
@example(75)
def test_poses_are_solved_as_by_walking(seed):
    env = SymbolicView(gymnasium.make(CROSSING))
    env.reset(seed=seed)
    layout = solved_layout(env)
    inner = env.unwrapped
    start, following, steps = poses_by_search(env)
    poses = sorted(pose for pose in following if pose in steps)
    assert layout.steps.tolist() == [steps[pose] for pose in poses]
    best = [[steps[after] + 1 == steps[pose] for after in following[pose]] for pose in poses]
    assert layout.best.tolist() == best
    passed, open_poses = set(), [start]
    while open_poses:
        pose = open_poses.pop()
        if pose in following and pose not in passed:
            passed.add(pose)
            open_poses += [after for after in following[pose] if steps[after] + 1 == steps[pose]]
    assert layout.passed.tolist() == [pose in passed for pose in poses]
    for pose, ways in zip(poses, layout.open_directions, strict=True):
        inner.agent_pos, inner.agent_dir = (pose[0], pose[1]), pose[2]
        assert open_directions(env.observation(inner.gen_obs())[None]).tolist() == [ways]


def test_a_layout_may_be_open_to_the_edge_and_the_robot_may_stand_in_a_door():
    env = gymnasium.make("MiniGrid-Empty-5x5-v0")
    env.reset(seed=0)
    env.unwrapped.agent_pos = (0, 2)  # no cell of the floor
    assert not solved_layout(env).passed.any()
    for place in range(5):
        for edge in ((0, place), (4, place), (place, 0), (place, 4)):
            env.unwrapped.grid.set(*edge, None)
    layout = solved_layout(env)
    assert len(layout.steps) == 4 * (5 * 5 - 1)
    # The goal (3, 3) is 3 columns and 3 rows away from the corner (0, 0), and a robot that faces away turns twice.
    assert (layout.steps.min(), layout.steps.max()) == (1, 3 + 3 + 2)


def test_what_cannot_be_solved():
    with pytest.raises(InputError, match="must be a MiniGrid environment"):
        solved_layout(gymnasium.make("CartPole-v1"))
    env = gymnasium.make("MiniGrid-Empty-5x5-v0")
    env.reset(seed=0)
    env.unwrapped.grid.set(3, 3, None)
    with pytest.raises(InputError, match="must have a goal"):
        solved_layout(env)
