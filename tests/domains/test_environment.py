"""Conformance of every registered environment: one definition, three ways to run it."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils import seeding
from gymnasium.utils.env_checker import check_env

from lifelore.core.errors import InputError
from lifelore.core.mdp import COLLISION, TERMINAL, _enumerate_with
from lifelore.domains import ENVIRONMENTS
from lifelore.domains.worlds import domain_names

CASES = {
    "lifelore/Building-v0": {"seed": 3, "cell": 0.8},
    "lifelore/Lattice-v0": {"size": 11},
    "lifelore/NoiseMaze-v0": {"size": 13, "seed": 2},
}
"""Arguments that keep the plain enumeration short."""
EVERY = pytest.mark.parametrize("name", sorted(CASES))


def plain(name: str, **changes):
    return gymnasium.make(f"lifelore.domains:{name}", **(CASES[name] | changes)).unwrapped


def test_every_registered_environment_and_domain_is_covered():
    registered = {name for name in gymnasium.registry if name.startswith("lifelore/")}
    assert registered == set(ENVIRONMENTS) == set(CASES)
    assert {plain(name).world.name for name in CASES} == set(domain_names())


@EVERY
def test_gymnasium_finds_nothing_to_say(name):
    check_env(plain(name))
    check_env(plain(name, render_mode="rgb_array"))
    check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


@EVERY
def test_environment_tables_and_step_agree_bit_for_bit(name):
    env = plain(name)
    task, tables = env.task, env.task.tables()
    goal_sides = np.flatnonzero((env.world.neighbour == task.goal).any(axis=1))
    uniforms, _ = seeding.np_random(11)
    actions = np.random.default_rng(5)
    seen = {"terminal": 0, "collision": 0}
    state, info = env.reset(seed=11)
    assert state == tables.starts[int(uniforms.random() * len(tables.starts))]
    for _ in range(2000):
        assert info["percept"] == env.world.percepts[state]
        action, u = int(actions.integers(4)), uniforms.random()
        outcome = int(np.searchsorted(tables.outcome_cum, u, side="right"))
        index = (state, action, outcome)
        row = (int(tables.next_state[index]), float(tables.reward[index]), int(tables.event[index]))
        assert task.domain.step(task.params, state, action, u) == row
        state, reward, terminated, truncated, info = env.step(action)
        event = TERMINAL * terminated | COLLISION * info["collision"]
        assert (state, reward, event) == row
        assert (type(state), type(reward), truncated) == (int, float, False)
        seen["terminal"] += terminated
        seen["collision"] += info["collision"]
        if terminated or actions.random() < 0.05:
            state, info = env.reset(options={"state": actions.choice(goal_sides)})
            uniforms.random()
    assert min(seen.values()) > 10


@EVERY
def test_the_compiled_table_equals_the_plain_enumeration(name):
    task = plain(name).task
    compiled = task.tables()
    for fast, slow in zip(compiled[:3], _enumerate_with(task.domain)(task.params, [0.5]), strict=True):
        assert fast.dtype == slow.dtype
        assert np.array_equal(fast, slow)


@EVERY
def test_an_episode_is_cut_at_its_limit(name):
    env = gymnasium.make(name, **CASES[name])
    limit = ENVIRONMENTS[name][1]
    env.reset(seed=0)
    # Two cells apart and back: never into the goal.
    state = next(
        s
        for s in env.unwrapped.task.starts
        if env.unwrapped.world.neighbour[s, 2] not in (-1, env.unwrapped.task.goal)
    )
    env.reset(options={"state": state})
    outcomes = [env.step(2 + t % 2)[2:4] for t in range(limit)]
    assert outcomes[-1] == (False, True)
    assert not any(truncated for _, truncated in outcomes[:-1])


@EVERY
def test_pictures(name):
    env = plain(name, render_mode="rgb_array")
    here, there = env.task.starts[[0, -1]]
    env.reset(options={"state": here})
    first = env.render()
    assert first.dtype == np.uint8
    assert first.shape[2] == 3
    env.reset(options={"state": there})
    assert (env.render() != first).any()
    assert plain(name).render() is None


def test_the_goal_may_be_a_state_or_a_cell():
    env = plain("lifelore/Lattice-v0", goal=7)
    cell = tuple(env.world.cells[7].tolist())
    assert env.task.goal == plain("lifelore/Lattice-v0", goal=cell).task.goal == 7
    for wrong in ((0, 0), (-1, 1), (99, 1)):
        with pytest.raises(InputError, match="goal must be a free cell"):
            plain("lifelore/Lattice-v0", goal=wrong)
    with pytest.raises(InputError, match="goal must be a state"):
        plain("lifelore/Lattice-v0", goal=10_000)
    assert len({plain("lifelore/Lattice-v0", seed=seed).task.goal for seed in range(6)}) > 1


@EVERY
def test_docstrings_have_gymnasiums_headings(name):
    headings = ["Action Space", "Observation Space", "Rewards", "Starting State", "Episode End", "Arguments"]
    documented = type(plain(name)).__doc__
    places = [documented.index(f"## {heading}") for heading in headings]
    assert places == sorted(places)
