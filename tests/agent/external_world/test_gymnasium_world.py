"""Any Gymnasium environment as a World: what is fixed by a task, what is refused, and what contexts mean."""

import gymnasium
import minigrid
import numpy as np
import pytest
from gymnasium.envs.toy_text.frozen_lake import generate_random_map
from gymnasium.spaces import Box, Discrete, MultiDiscrete

from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld, hashable
from lifelore.core.errors import InputError
from lifelore.core.protocols import World


class Probe(gymnasium.Env):
    """Writes down what is done to it; observes `answer`."""

    def __init__(self, actions=None, answer=0, reward=0.0):
        self.action_space = actions or Discrete(3)
        self.observation_space = Discrete(9)
        self.answer, self.reward = answer, reward
        self.taken, self.seeds, self.closed = [], [], 0

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.seeds.append(seed)
        return self.answer, {}

    def step(self, action):
        self.taken.append(action)
        return self.answer, self.reward, False, False, {}

    def close(self):
        self.closed += 1


class OldStep(Probe):
    def step(self, action):
        return self.answer, self.reward, False, {}


class OldReset(Probe):
    def reset(self, *, seed=None, options=None):
        return self.answer


class NoSeed(Probe):
    def reset(self):
        return 0, {}


def lake(task, slippery=False):
    return gymnasium.make("FrozenLake-v1", desc=generate_random_map(4, seed=task), is_slippery=slippery)


def walk(world, task, seed, actions):
    seen = [world.reset(task, seed)]
    for action in actions:
        state, _, terminated, truncated = world.step(action)
        seen.append(state)
        if terminated or truncated:
            break
    return seen


@pytest.mark.parametrize("name", ["Blackjack-v1", "CartPole-v1", "MiniGrid-SimpleCrossingS9N1-v0"])
def test_environments_of_every_kind_are_worlds(name):
    world = GymnasiumWorld(gymnasium.make(name))
    assert isinstance(world, World)
    assert walk(world, 0, 1, [0, 1, 0]) == walk(world, 0, 1, [0, 1, 0])
    assert world.name == name
    state = world.reset(0, 0)
    assert world.context(state, 0.0) == state  # by default


# ---- actions -------------------------------------------------------------------------------------


def test_actions_are_numbered_from_the_start_of_the_space():
    env = Probe(Discrete(3, start=5))
    world = GymnasiumWorld(env)
    walk(world, 0, 0, [0, 2])
    assert world.n_actions == 3
    assert env.taken == [5, 7]


# ---- tasks ---------------------------------------------------------------------------------------


def test_a_task_of_minigrid_keeps_its_layout_and_another_task_has_another():
    env = minigrid.wrappers.FullyObsWrapper(gymnasium.make("MiniGrid-SimpleCrossingS9N1-v0"))
    world = GymnasiumWorld(env, state=lambda seen: seen["image"].tobytes())
    layouts = [{world.reset(task, seed) for seed in range(5)} for task in range(6)]
    assert [len(layout) for layout in layouts] == [1] * 6
    # One river with one gap on a 9 x 9 grid: 6 places of the river, 7 of the gap, so six tasks hardly all agree.
    assert len(set.union(*layouts)) > 1


def test_outcomes_follow_the_episodes_seed():
    world = GymnasiumWorld(lambda task: lake(task, slippery=True))
    walks = [tuple(walk(world, 3, seed, [2, 1] * 10)) for seed in (*range(10), 0)]
    assert walks[0] == walks[-1]
    assert len(set(walks)) > 1


def test_reset_by_episode_deals_anew_and_reset_by_task_does_not():
    # 10 hands from one seed each: ten equal ones by chance are out of the question.
    dealt = {
        by: {GymnasiumWorld(gymnasium.make("Blackjack-v1"), reset_by=by).reset(0, seed) for seed in range(10)}
        for by in ("task", "episode")
    }
    assert len(dealt["task"]) == 1
    assert len(dealt["episode"]) > 1


def test_a_factory_makes_one_environment_a_task_and_the_last_is_closed():
    made = {}

    def make(task):
        made[task] = Probe()
        return made[task]

    with GymnasiumWorld(make) as world:
        for task in (0, 0, 1, 1, 2):
            world.reset(task, 0)
        assert {task: env.closed for task, env in made.items()} == {0: 1, 1: 1, 2: 0}
    assert made[2].closed == 1
    assert [len(made[task].seeds) for task in range(3)] == [2, 2, 1]
    given, other = Probe(), Probe()
    world = GymnasiumWorld(given)
    world.reset(0, 0)
    world.reset(1, 0)
    assert (given.closed, given.seeds[0] == given.seeds[1]) == (0, False)
    GymnasiumWorld(other, seed=2).reset(0, 0)
    assert other.seeds[0] != given.seeds[0]  # another seed has other tasks


# ---- states and contexts -------------------------------------------------------------------------


def test_context_sees_the_observation_and_the_last_reward_if_it_asks_for_it():
    env = Probe(answer=7)
    assert GymnasiumWorld(env, context=lambda seen: seen % 2).reset(0, 0) == 7
    world = GymnasiumWorld(env, context=lambda seen, reward: (seen, reward > 0))
    assert world.context(world.reset(0, 0), 0.5) == (7, True)
    optional = GymnasiumWorld(env, context=lambda seen, scale=10: seen * scale)
    assert optional.context(optional.reset(0, 0), 0.5) == 70


def test_hashable_by_hand():
    seen = {"b": np.array([[1, 2]], np.uint8), "a": (np.int64(3), [True, "x"], None)}
    known = (("a", (3, (True, "x"), None)), ("b", ("|u1", (1, 2), b"\x01\x02")))
    assert hashable(seen) == hashable(dict(reversed(seen.items()))) == known
    assert type(hashable(np.float32(0.5))) is float
    with pytest.raises(InputError, match=r"observation must be made of numbers.*got object"):
        hashable({"a": object()})
    with pytest.raises(InputError, match="got ndarray"):
        hashable(np.array([object()]))


# ---- refusals ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("refused", "said"),
    [
        (lambda: GymnasiumWorld("Lake-v1"), "env_or_factory must be a gymnasium.Env or a function.*got str"),
        (
            lambda: GymnasiumWorld(lambda task: "env"),
            "env_or_factory must make a gymnasium.Env, got str for task 0",
        ),
        (lambda: GymnasiumWorld(Probe(), 3), "context must be a function of the observation, got int"),
        (lambda: GymnasiumWorld(Probe(), None, 3), "state must be a function of the observation, got int"),
        (lambda: GymnasiumWorld(Probe(), reset_by="year"), "reset_by must be one of task, episode, got 'year'"),
        (lambda: GymnasiumWorld(Probe(MultiDiscrete([2, 3]))), "actions must be Discrete, got"),
        (lambda: GymnasiumWorld(Probe(Box(0, 1, (1,)))), "actions must be Discrete, got"),
        (
            lambda: GymnasiumWorld(lambda task: Probe(Discrete(3 + task))).reset(1, 0),
            "task 1 has 4 actions from 0",
        ),
        (lambda: GymnasiumWorld(Probe()).step(0), "step must follow reset"),
        (lambda: begun(reward=None).step(0), "reward of Probe must be a number, got NoneType"),
        (lambda: begun(reward=np.ones(1)).step(0), "reward of Probe must be a number, got ndarray"),
        (lambda: begun(made=OldStep).step(0), r"step of OldStep must return \(observation.*info\), got 4 values"),
        (lambda: begun(made=OldReset), r"reset of OldReset must return \(observation, info\), got int"),
        (lambda: begun(made=NoSeed), r"reset of NoSeed must take seed=, as reset\(self, \*, seed=None"),
        (lambda: GymnasiumWorld(Probe()).context(0, 0.0), "state must be the last state"),
        (lambda: begun().context(8, 0.0), "state must be the last state"),
    ],
)
def test_mistakes_are_named(refused, said):
    with pytest.raises(InputError, match=said):
        refused()


def begun(context=None, state=None, made=Probe, **how):
    """A world in its first episode."""
    world = GymnasiumWorld(made(**how), context, state)
    world.reset(0, 0)
    return world
