"""Life in a world of the user's own: lore that carries over, and a memory that goes on."""

import json
from threading import Event

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.toy_text.frozen_lake import generate_random_map
from scipy.stats import binomtest

from lifelore.action.priors.action_prior import ONE
from lifelore.agent.any_tasks.live_in import AGENTS, live_in
from lifelore.agent.external_world.context_code import context_code
from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld
from lifelore.core.errors import InputError
from lifelore.memory import open_memory

# Most worlds here are one task again and again, which `live_in` warns of.
pytestmark = pytest.mark.filterwarnings("ignore:Nothing that was observed")


class Doors:
    """One state, `n_actions` doors, episodes of one step: door 3 holds 1, the others `nothing`."""

    name = "doors"

    def __init__(self, n_actions=8, nothing=0.0, context="hall"):
        self.n_actions, self.nothing, self._context = n_actions, nothing, context
        self.resets = []

    def reset(self, task, seed):
        self.resets.append((task, seed))
        return "hall"

    def step(self, action):
        return "behind", 1.0 if action == 3 else self.nothing, True, False

    def context(self, state, last_reward):
        return self._context


def lake(task, size=4, slippery=False):
    """A random map; the agent sees its number and the tiles around it."""
    env = gymnasium.make("FrozenLake-v1", desc=generate_random_map(size, seed=task), is_slippery=slippery)
    tiles = np.pad(env.unwrapped.desc, 1, constant_values=b"#")

    def look(place):
        row, column = divmod(place, size)
        return place, tiles[row : row + 3, column : column + 3].tobytes()

    return gymnasium.wrappers.TransformObservation(env, look, env.observation_space)


def lakes(**how):
    return GymnasiumWorld(lambda task: lake(task, **how), state=lambda seen: seen[0], context=lambda seen: seen[1])


def numbers_of(report, agent, measure):
    return [task["agents"][agent][measure] for task in report["tasks"]]


# ---- learning ------------------------------------------------------------------------------------


def test_only_what_is_worth_something_is_counted(tmp_path):
    """One state, one good door: each task counts that door once and no other."""
    path = tmp_path / "m.db"
    live_in(Doors(), tasks=5, episodes=60, memory=path, key="doors")
    with open_memory(path) as memory:
        ((key, version, about),) = memory.keys("action_prior")
        record = memory.recall("action_prior", key, version)
    assert record.slots.tolist() == [context_code("hall") * 8 + 3]
    assert record.values.tolist() == [5 * ONE]
    assert (key, about) == ("doors/prior", {"prior": "tasks", "means": "doors"})


def test_a_world_whose_returns_are_all_equal_teaches_nothing_and_warns():
    class Dull(Doors):
        def step(self, action):
            return "behind", -1.0, True, False

    with pytest.warns(UserWarning, match="The action prior is empty after 3 tasks in doors"):
        report = live_in(Dull(), tasks=3, episodes=20)
    assert report["n_contexts"] == 0
    assert numbers_of(report, "lore", "mean_return") == numbers_of(report, "scratch", "mean_return")
    assert not any(numbers_of(report, "lore", "reached"))


def test_a_world_of_costs_teaches_by_the_best_returns():
    """Door 3 costs 1, every other door 10: the best tenth of the episodes took door 3."""

    class Costly(Doors):
        def step(self, action):
            return "behind", -1.0 if action == 3 else -10.0, True, False

    report = live_in(Costly(), tasks=12, episodes=60)
    assert report["n_contexts"] == 1
    # After t tasks the first choice is right with (t + α⁰) / (t + 8 α⁰), 0.89 on average over the last six tasks:
    # two wrong choices of six, which make the mean -4, have odds below 1 in 7.
    assert np.mean(numbers_of(report, "lore", "first_return")[6:]) > -4
    # Uniform exploration takes door 3 first once in eight tasks: a mean of -8.9.
    lore, scratch, textbook = (np.mean(numbers_of(report, who, "mean_return")) for who in AGENTS)
    assert lore > scratch > textbook


@pytest.mark.slow
def test_lore_of_twelve_lakes_helps_on_the_next_forty(tmp_path):
    """A sign test: were the prior useless, each would win equally often, and this fail but once in a hundred."""
    path = tmp_path / "lake.db"
    live_in(lakes(), tasks=12, episodes=100, max_steps=60, memory=path, key="tiles around")
    later = live_in(lakes(), tasks=40, episodes=10, max_steps=60, memory=path, key="tiles around")
    for measure in ("first_return", "mean_return"):
        lore, scratch = (np.array(numbers_of(later, name, measure)) for name in ("lore", "scratch"))
        wins, losses = int((lore > scratch).sum()), int((lore < scratch).sum())
        assert binomtest(wins, wins + losses, alternative="greater").pvalue < 0.01
    assert later["tasks"][0]["index"] == 12
    assert later["summary"]["lore_vs_scratch"]["mean_return_difference"]["value"] > 0


# ---- memory --------------------------------------------------------------------------------------


def test_two_lives_on_one_memory_are_one_life_also_after_a_stop_and_an_exception(tmp_path):
    path, stop, size = tmp_path / "m.db", Event(), {"episodes": 30, "max_steps": 30}

    class Breaks(GymnasiumWorld):
        def reset(self, task, seed):
            if task == 3:
                raise RuntimeError("battery empty")
            return super().reset(task, seed)

    def after_two(done, total, label):
        if done == 2:
            stop.set()

    key = "tiles around"
    whole = live_in(lakes(), tasks=5, **size)
    first = live_in(lakes(), tasks=9, **size, memory=path, key=key, progress=after_two, stop=stop)
    with pytest.raises(RuntimeError, match="battery empty"):
        live_in(Breaks(lake, lambda seen: seen[1], lambda seen: seen[0]), tasks=9, **size, memory=path, key=key)
    last = live_in(lakes(), tasks=2, **size, memory=path, key=key)
    assert first["memory"] == {"tasks_before": 0, "tasks_after": 2}
    assert last["memory"] == {"tasks_before": 3, "tasks_after": 5}
    assert first["tasks"] + whole["tasks"][2:3] + last["tasks"] == whole["tasks"]
    assert last["n_contexts"] == whole["n_contexts"]
    with open_memory(path) as memory:
        assert (memory.tasks("robot"), memory.check()) == (5, [])


def test_a_task_that_is_stopped_teaches_nobody():
    """The user's agent lives last, and stops the second task after the others have lived it."""
    stop = Event()

    def idle(world, task, seeds, max_steps):
        if task:
            stop.set()
        for seed in seeds:
            world.reset(task, seed)
            world.step(0)

    world = Doors()
    world.context = lambda state, last_reward: world.resets[-1][0]  # each task has a context of its own
    report = live_in(world, tasks=3, episodes=60, agents={"idle": idle}, stop=stop)
    assert (len(report["tasks"]), report["n_contexts"]) == (1, 1)


@pytest.mark.filterwarnings("ignore:The action prior is empty")
def test_lore_is_shared_by_key_only(tmp_path):
    path = tmp_path / "m.db"
    live_in(Doors(), tasks=4, episodes=60, memory=path, key="doors", robot="a")
    same = live_in(Doors(), tasks=1, episodes=1, memory=path, key="doors", robot="b")
    other = live_in(Doors(), tasks=1, episodes=1, memory=path, key="gates", robot="c")
    assert same["n_contexts"] == 1
    assert (same["memory"]["tasks_before"], other["memory"]["tasks_before"]) == (0, 0)
    # One episode of ε = 1 may itself find the door; what the two had to start from is in the memory's keys.
    assert same["tasks"][0]["agents"]["lore"]["first_return"] == 1.0
    assert other["settings"]["key"] == "gates"
    assert other["n_contexts"] <= 1
    with pytest.raises(InputError, match="env must have the 8 actions of the tasks before, got 5"):
        live_in(Doors(5), tasks=1, episodes=1, memory=path, key="doors", robot="d")


# ---- the report ----------------------------------------------------------------------------------


def test_report_is_plain_json_of_the_shape_of_live():
    ticks = []
    report = live_in(Doors(), tasks=4, episodes=10, progress=lambda *tick: ticks.append(tick))
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert set(report) == {
        "domain", "map", "n_states", "n_contexts", "seed", "settings", "tasks", "summary", "memory", "warnings",
        "seconds",
    }  # fmt: skip
    assert (report["domain"], report["map"], report["n_states"]) == ("doors", None, 1)
    task = report["tasks"][2]
    assert (task["index"], task["goal"], task["optimal_return"]) == (2, None, None)
    assert set(task["agents"]) == {"lore", "scratch", "textbook"}
    own = task["agents"]["lore"]
    assert [own[name] for name in ("collisions", "steps_to_80", "episodes_to_80")] == [None] * 3
    assert {"first_return", "reached", "final_return", "mean_return"} < set(own)
    assert {"value", "median", "ci95", "n"} < set(report["summary"]["lore_vs_scratch"]["jumpstart"])
    assert ticks == [(0, 4, ""), *((done, 4, f"task {done - 1}") for done in range(1, 5))]
    again, other = (live_in(Doors(), tasks=4, episodes=10, seed=seed)["tasks"] for seed in (0, 1))
    assert report["tasks"] == again != other


# ---- refusals ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"tasks": 0}, "tasks must be a whole number from 1 to 10\\^9, got 0"),
        ({"episodes": 2.5}, "episodes must be a whole number"),
        ({"max_steps": 0}, "max_steps must be a whole number"),
        ({"discount": float("nan")}, "discount must lie in \\[0, 1\\], got nan"),
        ({"learning_rate": 2}, "learning_rate must lie in"),
        ({"alpha0": 0}, "alpha0 must be positive"),
        ({"weight": float("nan")}, "weight must lie in"),
        ({"form": "best"}, "form must be one of proportion"),
        ({"ties": "none"}, "ties must be one of uniform, prior"),
        ({"robot": " "}, "robot must be a name without '/', got ' '"),
        ({"key": "a/b"}, "key must be a name without '/', got 'a/b'"),
    ],
)
def test_settings_that_break_their_rule(settings, said):
    with pytest.raises(InputError, match=said):
        live_in(Doors(), **settings)


def test_what_is_no_world_is_refused_and_a_memory_needs_the_meaning_of_contexts(tmp_path):
    with pytest.raises(InputError, match="world must have n_actions, reset, step and context"):
        live_in(gymnasium.make("FrozenLake-v1"))  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"world\.n_actions must lie in"):
        live_in(Doors(2**16))
    with pytest.raises(InputError, match="a state or context must be"):
        live_in(Doors(context=object()))
    with pytest.raises(InputError, match="key must name the meaning of the contexts in the memory"):
        live_in(Doors(), memory=tmp_path / "m.db")
    assert not (tmp_path / "m.db").exists()
