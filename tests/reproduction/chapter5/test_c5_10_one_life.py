"""C5.10: families obey Gymnasium and their types differ, streams have usual types, measures of made-up lives."""

import functools
import itertools
import warnings
from typing import Any

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from lifelore.core.streams import stream
from reproduction.chapter5.c5_10_one_life import lives
from reproduction.chapter5.c5_10_one_life.lives import (
    AGENTS,
    FULL,
    SCRATCH,
    agent_of,
    drawn_tasks,
    first_return_told,
    lived,
    own_name,
)
from reproduction.chapter5.c5_10_one_life.run import first_returns, is_recognised, measure, pairs, readings, seen
from reproduction.chapter5.c5_10_one_life.worlds import FAMILIES, taxi, windy_grid
from reproduction.chapter5.c5_10_one_life.worlds.grid_preference import ACTIONS

pytest.importorskip("minigrid")
EVERY = [pytest.param(family, id=name) for name, family in FAMILIES.items()]


# ---- families ----------------------------------------------------------------------------------------------


def played(env, family, actions, seed):
    """States, features, rewards and ends of an episode under given actions."""
    seen, _ = env.reset(seed=seed)
    found = [family.state(seen)]
    for action in actions:
        seen, paid, ended, truncated, _ = env.step(action)
        assert env.observation_space.contains(seen)
        assert isinstance(paid, int | float)
        found.append((family.state(seen), family.features(seen), paid, ended))
        if ended or truncated:
            break
    return found


@functools.cache
def n_actions_of(family):
    return family.make(family.types[0], 0).action_space.n


def drawn_actions(family, n, seed=0):
    return stream(seed, "actions").integers(n_actions_of(family), size=n).tolist()


@pytest.mark.parametrize("family", EVERY)
def test_every_type_passes_the_checker_of_gymnasium(family):
    for hidden in family.types:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # it advises on wrappers, and on spaces of observations
            env = family.make(hidden, 3)
            env.unwrapped.spec = None  # wrappers of a claim are not registered, so that no spec makes them again
            check_env(env, skip_render_check=True)


@pytest.mark.parametrize("family", EVERY)
def test_a_type_a_life_and_a_seed_fix_an_episode(family):
    actions = drawn_actions(family, 30)
    env = family.make(family.types[-1], 1)
    for hidden in family.types:
        env, again = family.make(hidden, 1), family.make(hidden, 1)
        first = played(env, family, actions, 5)
        assert first == played(env, family, actions, 5) == played(again, family, actions, 5)
    assert len({str(played(env, family, actions, seed)) for seed in range(20)}) > 1


@pytest.mark.parametrize("family", EVERY)
def test_types_differ_in_what_follows_on_the_same_actions(family):
    """Every two types of a life differ in some of 150 episodes of random actions."""

    def episodes(hidden):
        env = family.make(hidden, 0)
        return [played(env, family, actions[n], n) for n in range(150)]

    actions = [drawn_actions(family, family.max_steps, n) for n in range(150)]
    found = {hidden: episodes(hidden) for hidden in family.types}
    for one, other in itertools.combinations(family.types, 2):
        assert found[one] != found[other]


@pytest.mark.parametrize("family", EVERY)
def test_contexts_show_their_usual_type_four_times_of_five(family):
    """Of 1,000 tasks; the bound is four standard errors of a share of 0.8."""
    tasks = family.stream(7)
    draws = [tasks.draw(number) for number in range(1000)]
    usual = [one.hidden_type == tasks.usual_type(one.context) for one in draws]
    assert np.mean(usual) == pytest.approx(0.8, abs=4 * (0.8 * 0.2 / 1000) ** 0.5)
    of_context = {one.context: tasks.usual_type(one.context) for one in draws}
    assert sorted(of_context.values()) == sorted(family.types)


def test_moves_of_a_windy_grid_by_hand():
    env = windy_grid.WindyGrid("south wind", 3)
    env.reset(seed=0)
    env.place = (5, 6)  # a wind of two rows carries it north
    assert env.step(1)[:3] == (3 * 10 + 7, -1.0, True)
    calm = windy_grid.WindyGrid("calm", 3)
    calm.reset(seed=0)
    calm.place = (0, 0)
    assert [calm.step(move)[0] for move in (0, 3, 2, 1)] == [0, 0, 10, 11]
    gusty = windy_grid.WindyGrid("gusts", 3)
    gusty.reset(seed=0)
    rows = set()
    for _ in range(50):
        gusty.place = (5, 6)
        rows.add(gusty.step(1)[0] // 10)
    assert rows == {2, 3, 4}


def test_the_slip_is_that_of_the_type():
    """The share of steps that go where they were meant to, of 2,000; four standard errors."""
    family = FAMILIES["slippery lake"]
    for hidden, success in (("dry", 1.0), ("wet", 2 / 3), ("icy", 1 / 3)):
        env = family.make(hidden, 0)
        goes = []
        for seed in range(2000):
            env.reset(seed=seed)
            goes.append(family.state(env.step(2)[0]) == 1)  # east of the corner
        assert np.mean(goes) == pytest.approx(success, abs=4 * (success * (1 - success) / 2000) ** 0.5)


def test_only_the_wanted_goal_of_a_grid_pays():
    for name in ("DoorKey", "MultiRoom"):
        family = FAMILIES[name]
        for life in range(5):
            env: Any = family.make(family.types[0], life)
            for hidden in family.types:
                pays = {}
                for place in family.types:
                    wanted = family.make(hidden, life)
                    wanted.reset(seed=0)
                    # Stand beside the goal of that name and walk onto it.
                    pays[place] = walked_onto(wanted, env.goals[place])
                assert pays == {place: float(place == hidden) for place in family.types}


def walked_onto(env, goal):
    """What an agent is paid that steps onto a goal from the cell of a door, a key or nothing beside it."""
    base = env.unwrapped
    for facing, (right, down) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
        cell = goal[0] - right, goal[1] - down
        thing = base.grid.get(*cell)
        if thing is None or thing.type in ("door", "key"):
            base.agent_pos, base.agent_dir = cell, facing
            _, paid, ended, _, _ = env.step(ACTIONS.index(2))
            assert ended
            return paid
    raise AssertionError("every goal can be walked onto")


def test_a_taxi_hides_its_destination():
    for colour, stop in taxi.STOPS.items():
        env: Any = taxi.make(colour, 0)
        for seed in range(20):
            place, info = env.reset(seed=seed)
            assert env.unwrapped.s % 4 == stop
            assert env.unwrapped.s // 4 == place
            assert place % 5 not in (stop, taxi.ON_BOARD)
            assert info == {}  # the action mask would tell
    # Row 0, column 0, passenger at R, which is here; the border stops north and west.
    assert taxi.features(0) == (False, True, 0, 0, (False, True, False, True))
    assert taxi.features(taxi.ON_BOARD) == (True, True, (False, True, False, True))


# ---- lives -------------------------------------------------------------------------------------------------


class Fake:
    """An agent that names each task after its context, knows what it is asked, and plays nothing."""

    def __init__(self):
        self.n = 0

    def live(self, env, context):
        self.n += 1

        class Result:
            returns = [float(self.n), 0.0]  # noqa: RUF012
            type, new, alarm = f"type {context}", self.n == 1, False
            beliefs = [{"a": 1.0}, {"a": 0.4, "b": 0.6}] if self.n > 1 else []

        return Result


def test_a_life_stores_what_happened_in_each_task(monkeypatch):
    monkeypatch.setattr(lives, "agent_of", lambda *_: Fake())
    monkeypatch.setattr(lives, "first_return_told", lambda agent, env, name, number: 100.0)
    found = lived("surveillance", FULL, 4, 6, 0.05)
    types, contexts = drawn_tasks("surveillance", 4, 6)
    assert found["first"] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    assert found["mean"] == [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]
    assert found["named"] == [f"type {context}" for context in contexts]
    assert found["soon"] == [None] + ["b"] * 5
    assert [value is not None for value in found["informed"]] == seen(types).tolist()
    assert set(lived("surveillance", SCRATCH, 4, 2, 0.05)) == {"first", "mean"}


def test_who_is_told_the_type_runs_its_policy_and_learns_nothing():
    agent, streams = agent_of("surveillance", FULL, 4, 0.05), drawn_tasks("surveillance", 4, 6)
    for hidden, context in zip(*streams, strict=True):
        result = agent.live(FAMILIES["surveillance"].make(hidden, 4), context=context)
    before = {name: one.tasks for name, one in agent.types.items()}
    told = first_return_told(agent, FAMILIES["surveillance"].make(hidden, 4), result.type, 6)
    assert told >= result.returns[0]
    assert {name: one.tasks for name, one in agent.types.items()} == before


def test_the_own_name_of_a_type():
    assert own_name(["a", "b", "a"], ["x", "y"]) == "x"
    assert own_name(["a", "a", "a", "b", "a"], ["x", "y", "y", "z"]) == "y"
    assert own_name(["a", "b"], ["x"]) is None
    assert own_name(["a", "a"], [""]) is None


# ---- measures ----------------------------------------------------------------------------------------------


def life(family, number, full, others, *, informed, **thought):
    """A made-up life of four tasks of types a, b, a, b; each agent earns the same in all tasks."""
    n = 4
    agents = {name: {"first": [others.get(name, 0.0)] * n, "mean": [others.get(name, 0.0)] * n} for name in AGENTS}
    agents[FULL] = {
        "first": [full] * n,
        "mean": [full] * n,
        "informed": [None, None, informed, informed],
        "named": ["x", "y", "x", "y"],
        "new": [True, True, False, False],
        "alarm": [False, True, False, False],
        "soon": [None, "x", "x", "y"],
    } | thought
    return {"family": family, "life": number, "types": ["a", "b", "a", "b"], "agents": agents}


SETTINGS = {"families": ["Taxi", "Pacman"], "lives": 4, "tasks": 4, "false_alarm": 0.05}


def made_up():
    taxis = [
        life("Taxi", n, -2.0 + 0.1 * n, {"scratch": -10.0, "textbook": -8.0, "no-prior": -3.0, "no-reuse": -9.0,
                                         "no-context": -1.8}, informed=-1.0)
        for n in range(4)
    ]  # fmt: skip
    games = [
        life("Pacman", n, 5.0, {"textbook": 6.0 + n, "no-prior": 4.0}, informed=10.0, soon=[None, "x", "x", "x"])
        for n in range(4)
    ]
    return taxis + games


def test_measures_by_hand():
    found = {reading["family"]: numbers for reading, numbers in readings(SETTINGS, made_up())}
    taxi, game = found["Taxi"], found["Pacman"]
    # Full −1.85 on average, scratch −10, informed −1.
    assert taxi["first_share"].value == pytest.approx(8.15 / 9)
    assert game["first_share"].value == pytest.approx(0.5)
    # Spreads of first returns: −1 − (−10) and 10 − 0.
    both = measure(SETTINGS, made_up())
    assert both["first_share"].value == pytest.approx((8.15 / 9 + 0.5) / 2)
    assert both["first_least"].value == pytest.approx(0.5)
    # One pair a life, of type b: a is there from the first task.
    assert (taxi["recognised"].value, taxi["recognised"].n) == (1.0, 4)
    assert (game["recognised"].value, both["recognised"].value, both["recognised_least"].value) == (0.0, 0.5, 0.0)
    # Two tasks of seen types a life; the alarm at the first visit of b is none of a known type.
    assert (both["alarms"].value, both["alarms"].n) == (0.0, 16)
    # The best with fewer parts: reuse only in Taxi, the textbook in Pacman, which is above in every life.
    assert taxi["best_upper"].value > 0
    assert game["best_upper"].value == both["best_upper"].value < 0
    assert taxi["prior_gain"].value == pytest.approx(1.15 / 8.2)
    assert [taxi[f"{part}_families"].value for part in ("prior", "reuse", "context")] == [1.0, 1.0, 0.0]
    assert [both[f"{part}_families"].value for part in ("prior", "reuse", "context")] == [1.0, 1.0, 0.5]


def test_a_life_without_informed_returns_is_left_out():
    lives_ = made_up()
    lives_[0]["agents"][FULL]["informed"] = [None] * 4
    values = first_returns(lives_[:4], FULL)
    assert np.isnan(values[0])
    assert values[1:] == pytest.approx([-1.9, -1.8, -1.7])
    assert measure({**SETTINGS, "families": ["Taxi"]}, lives_[:4])["first_share"].n == 3


def test_pairs_and_what_is_recognised():
    types = ["a", "b", "c", "a", "b", "b", "d"]
    assert list(pairs({"types": types})) == [(1, 4)]
    thought = {"new": [False, True], "named": ["x", "y", "y"], "soon": [None, None, "y"]}
    assert is_recognised(thought, 1, 2)
    assert not is_recognised(thought | {"new": [False, False]}, 1, 2)
    assert not is_recognised(thought | {"named": ["x", "y", "x"]}, 1, 2)
    assert not is_recognised(thought | {"soon": [None, None, "x"]}, 1, 2)
