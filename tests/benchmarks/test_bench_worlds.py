"""`bench worlds`, small: the worlds differ by task, the baseline learns, and the comparison is right by hand."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from benchmarks.lives.foreign_worlds import CLIFF, WORLDS, ForeignWorld, _reachable, cliff
from benchmarks.lives.textbook_q import textbook_q_returns
from benchmarks.lives.worlds import AGENTS, MEASURES, bench_worlds, compared
from lifelore.core.protocols import World
from lifelore.core.streams import stream


def walk(world, task, seed=0, steps=30):
    """States, contexts and rewards of a walk by a fixed law."""
    random = np.random.default_rng(5)
    state, reward, seen = world.reset(task, seed), 0.0, []
    for _ in range(steps):
        seen.append((state, world.context(state, reward), reward))
        state, reward, terminated, truncated = world.step(int(random.integers(world.n_actions)))
        if terminated or truncated:
            break
    return seen


@pytest.mark.parametrize("name", WORLDS)
def test_a_task_is_the_same_each_time_and_tasks_and_runs_differ(name):
    with WORLDS[name].make(1) as world, WORLDS[name].make(2) as other:
        assert isinstance(world, World)
        assert walk(world, 0) == walk(world, 0)
        walks = [walk(world, task) for task in range(4)] + [walk(other, task) for task in range(4)]
    assert len({repr(seen) for seen in walks}) >= 6
    assert len({context for seen in walks for _, context, _ in seen}) > 1


def test_a_cliff_is_fallen_from_to_the_start_and_ends_at_the_goal():
    env = cliff(7)
    table = env.unwrapped.P
    (start,) = np.flatnonzero(env.unwrapped.initial_state_distrib)
    outcomes = [outcome for moves in table.values() for ((_, *outcome),) in moves.values()]
    falls = [place for place, reward, _ in outcomes if reward == -100]
    assert falls
    assert set(falls) == {start}
    assert {place % 12 for place, _, over in outcomes if over} == {11}
    assert {reward for _, reward, _ in outcomes} == {-1, -100}


def test_a_goal_behind_the_cliff_is_not_reachable():
    kinds = np.zeros((4, 12), int)
    kinds[:, 5] = CLIFF
    assert {column for _, column in _reachable(kinds, (0, 0))} == set(range(5))


class Corridor:
    """Three cells; moving right from the last one pays 1 and ends, moving left goes back."""

    n_actions, name = 2, "corridor"

    def __init__(self):
        self.resets = []

    def __enter__(self):
        return self

    def __exit__(self, *error):
        pass

    def reset(self, task, seed):
        self.resets.append((task, seed))
        self.place = 0
        return 0

    def step(self, action):
        self.place = max(0, self.place + (1 if action else -1))
        return self.place, float(self.place == 3), self.place == 3, False

    def context(self, state, last_reward):
        return "corridor"


def test_the_textbook_learns_the_corridor():
    returns = textbook_q_returns(Corridor(), 0, range(200), 50, 0.9, 0.5, stream(0, "t"))
    assert returns[0] < 0.9**2
    # Greedy with ε = 0.1: three steps right, each with probability 0.95.
    assert np.mean(np.isclose(returns[-100:], 0.9**2)) > 0.7


def test_the_bench_pairs_all_agents_and_reports_every_measure():
    made, ticks = [], []

    def make(run):
        made.append(Corridor())
        return made[-1]

    worlds = {"corridor": ForeignWorld(make, "nothing", {"episodes": 40, "max_steps": 30})}
    result = bench_worlds(3, lambda *tick: ticks.append(tick), tasks=4, worlds=worlds)
    assert ticks[-1][:2] == (3, 3)
    for world in made:
        # Of each task: 40 episodes of lore, of scratch, and of the textbook, with the same seeds.
        lived, textbook = world.resets[:320], world.resets[320:]
        assert [lived[80 * task : 80 * task + 40] for task in range(4)] == [
            textbook[40 * task : 40 * task + 40] for task in range(4)
        ]
    names = [row["name"] for row in result["rows"]]
    assert len(names) == len(set(names)) == len(MEASURES) * (len(AGENTS) + 2 * 2)
    assert result["worlds"]["corridor"]["contexts"] == 1
    # The corridor's prior says right: the first episode is better than that of a newcomer.
    gained = result["worlds"]["corridor"]["measures"]["first_return"]["lore_minus"]["scratch"]["mean"]
    assert gained["value"] > 0.1
    (goal,) = result["goals"]
    assert goal["met"] is False


def test_differences_are_paired_over_the_second_half():
    lives = [
        {
            "agents": {
                measure: {"lore": [0, 0, run, run + 3], "scratch": [9, 9, run, run + 1], "textbook": [0] * 4}
                for measure in MEASURES
            },
            "contexts": 2,
        }
        for run in range(5)
    ]
    found = compared(lives)["measures"]["mean_return"]
    assert found["agents"]["lore"]["mean"]["value"] == pytest.approx(2 + 1.5)
    difference = found["lore_minus"]["scratch"]
    assert (difference["mean"]["value"], difference["mean"]["ci95"]) == (1.0, None)
    # Five zeros and five twos: the middle half holds as many of each, up to one.
    assert difference["interquartile_mean"]["value"] == pytest.approx(1.0)


def test_the_page_shows_the_committed_numbers():
    root = Path(__file__).parents[2]
    page = (root / "docs" / "start" / "learning.md").read_text(encoding="utf-8")
    committed = json.loads((root / "results" / "bench_worlds.json").read_text(encoding="utf-8"))["worlds"]
    assert list(committed) == list(WORLDS)
    for name, world in committed.items():
        measure = world["measures"]["mean_return"]
        numbers = [measure["agents"][who]["mean"]["value"] for who in AGENTS]
        for who in AGENTS[1:]:
            for estimate in measure["lore_minus"][who].values():
                numbers += [estimate["value"], *estimate["ci95"]]
        (line,) = [line for line in page.splitlines() if line.startswith(f"| {name} |")]
        told = re.findall(r"[−+]?\d+\.\d+", line.split("|", 2)[2])
        assert len(told) == len(numbers)
        for text, number in zip(told, numbers, strict=True):
            digits = len(text.split(".")[1])
            assert float(text.replace("−", "-")) == pytest.approx(number, abs=0.51 * 10**-digits)
