import os
import pickle
import re
import signal
import subprocess
import sys
import textwrap
from collections import Counter
from pathlib import Path
from threading import Event

import gymnasium
import numpy as np
import pytest

from lifelore import ActionPrior, LongLivedAgent, compare_agents, open_memory
from lifelore.agent.any_tasks.experience import Experience, TaskNews
from lifelore.agent.any_tasks.reuse import TaskReuse
from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.buildings.merged_buildings import merge_memories
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.streams import stream
from tests.agent.any_tasks.windy_grid import SETTINGS, WINDS, WindyGrid


def life(tasks, **settings):
    """An agent after tasks with winds that mostly go with the context, and their results."""
    agent = LongLivedAgent(**SETTINGS | settings)
    random = stream(0, "life")
    found = []
    for _ in range(tasks):
        context = int(random.integers(2))
        wind = WINDS[context if random.random() < 0.8 else 1 - context]
        found.append((wind, agent.live(WindyGrid(wind), context=("day", context))))
    return agent, found


@pytest.fixture(scope="module")
def full():
    return life(10)


def mean_of(found):
    return np.mean([np.mean(result.returns) for _, result in found[4:]])


def test_known_types_are_recognised_and_their_policies_pay(full):
    _agent, found = full
    assert [result.new for _, result in found[:1]] == [True]
    owner = {}
    for wind, result in found:
        assert len(result.returns) == len(result.policies) == SETTINGS["episodes"]
        if not result.new:
            assert owner.get(result.type.split("+")[0], wind) == wind  # never taken for the other wind
        for name in result.type.split("+"):
            owner.setdefault(name, wind)
    assert set(owner.values()) == set(WINDS)
    textbook = life(10, agent="textbook")[1]
    assert mean_of(found) > mean_of(textbook) + 2
    firsts = [result.returns[0] for _, result in found[4:]]
    assert np.mean(firsts) > np.mean([result.returns[0] for _, result in textbook[4:]]) + 3


def test_what_is_known_can_be_read(full):
    agent, _found = full
    assert set(agent.policies) == {name for joined in agent.types for name in joined.split("+")}
    for summary in agent.types.values():
        assert set(summary.contexts) <= {("day", 0), ("day", 1)}
        assert summary.tasks == pytest.approx(sum(summary.contexts.values()))
        assert all(np.isfinite(list(summary.returns.values())))
    assert sum(summary.tasks for summary in agent.types.values()) == pytest.approx(10, abs=0.2)
    assert 1 <= len(agent.prior) <= 3
    curious = agent.curiosity()
    assert {one.context for one in curious} == {("day", 0), ("day", 1)}
    assert curious[0].entropy * curious[0].frequency >= curious[1].entropy * curious[1].frequency


def test_a_result_explains_itself(full):
    agent, found = full
    new = next(result for _, result in found[1:] if result.new)
    known = next(result for _, result in found[4:] if not result.new)
    text = agent.explain(new)
    assert f"taken for {new.type}, a new type" in text
    assert re.search(r"learner × \d+", text)
    assert f"expected  {max(known.prior, key=known.prior.get)} 0." in agent.explain(known)
    assert "('day'" in text
    assert known.to_dict()["returns"] == known.returns


def test_ablations_keep_what_they_lack():
    for name, types in {"no-reuse": 0, "scratch": 0, "textbook": 0, "no-prior": 1, "no-context": 1}.items():
        agent, _found = life(2, agent=name)
        assert len(agent.types) >= types if types else not agent.types, name
        assert bool(len(agent.prior)) == (name not in ("scratch", "textbook")), name
    for learner in ("model", "textbook"):
        assert life(2, learner=learner)[1][0][1].new


def test_an_alarm_in_a_task_that_a_known_type_explains_adds_no_type_and_replaces_no_policy(monkeypatch):
    """Whatever the learner earned that began elsewhere: here it is said to have earned a thousand."""
    agent, found = life(2)
    known = found[-1][1].type
    before = {state: row.copy() for state, row in agent._experience.types[known].policy.items()}
    monkeypatch.setattr(TaskReuse, "alarmed", property(lambda self: True))
    monkeypatch.setattr("lifelore.agent.any_tasks.one_task.discounted", lambda steps, discount: 1000.0)
    result = agent.live(WindyGrid(found[-1][0]))
    assert result.alarm
    assert not result.new
    assert result.type == known
    after = agent._experience.types[known].policy
    assert all(np.array_equal(after[state], row) for state, row in before.items())


def test_a_policy_is_explored_ever_more_rarely_and_again_in_states_that_it_does_not_know(monkeypatch):
    """In the second wing it earns as much as it promises, and the other action pays more."""

    class Wing(gymnasium.Env):
        observation_space = gymnasium.spaces.MultiDiscrete([2, 21])
        action_space = gymnasium.spaces.Discrete(2)

        def __init__(self, wing):
            self.pays = ((1.0, 0.0), (1.0, 5.0))[wing]
            self.wing = wing

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.place = 0
            return np.array((self.wing, self.place)), {}

        def step(self, action):
            self.place += 1
            return np.array((self.wing, self.place)), self.pays[action], self.place == 20, False, {}

    agent = LongLivedAgent(key="wings", state=lambda seen: tuple(seen.tolist()), features=lambda seen: 0)
    agent.live(Wing(0))
    assert set(agent.live(Wing(0)).policies) == {"robot.0", "learner"}
    # The only policy of a life is the best and the worst that it has seen.
    monkeypatch.setattr(Experience, "is_hopeless", lambda self, name: False)
    agent._experience.types["robot.0"].rounds["robot.0"] = 10**6
    assert set(agent.live(Wing(0)).policies) == {"robot.0"}
    result = agent.live(Wing(1))
    assert result.policies[:2] == ["robot.0", "learner"]
    assert result.returns[-1] > result.returns[0]


# ---- memory ----------------------------------------------------------------------------------------------


def test_a_life_goes_on_in_another_agent(tmp_path):
    one = life(4)[1]
    found = []
    for wind, before in one:
        with LongLivedAgent(**SETTINGS, memory=tmp_path / "life.db") as agent:
            found.append(agent.live(WindyGrid(wind), context=before.context))
    assert [result.number for result in found] == [0, 1, 2, 3]
    with LongLivedAgent(**SETTINGS, memory=tmp_path / "life.db") as agent:
        for summary in agent.types.values():
            assert set(summary.contexts) <= {("day", 0), ("day", 1)}
        assert {("day", 0), ("day", 1)} >= {one.context for one in agent.curiosity()}
        assert set(agent.prior.to_columns()["label"].tolist()) <= {"-1", "0", "1"}
    assert [result.type for result in found] == [result.type for _, result in one]
    for before, after in zip(one, found, strict=True):
        assert after.returns == pytest.approx(before[1].returns)


def test_features_behind_contexts_are_found_from_another_folder_and_can_be_pickled(tmp_path, monkeypatch):
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path)
    with LongLivedAgent(**SETTINGS, memory="life.db") as agent:
        agent.live(WindyGrid(1))
    agent = LongLivedAgent(**SETTINGS, memory="life.db")
    monkeypatch.chdir(tmp_path / "elsewhere")
    text = pickle.dumps(agent.prior)
    assert dict(pickle.loads(text).labels) == dict(agent.prior.labels)
    assert set(agent.prior.labels) == set(agent.prior.contexts.tolist())
    assert set(agent.prior.labels.values()) <= {-1, 0, 1}
    agent.close()


def test_robots_share_what_they_learn(tmp_path):
    for robot, wind in {"ann": -1, "bob": 1}.items():
        with LongLivedAgent(**SETTINGS, memory=tmp_path / f"{robot}.db", robot=robot) as agent:
            agent.live(WindyGrid(wind), context=wind)
    with open_memory(tmp_path / "ann.db") as memory:
        memory.merge_from(tmp_path / "bob.db")
    with LongLivedAgent(**SETTINGS, memory=tmp_path / "ann.db", robot="cleo") as agent:
        # The tasks of a robot on the same memory are heard before the next one.
        with LongLivedAgent(**SETTINGS, memory=tmp_path / "ann.db", robot="dan") as other:
            assert other.live(WindyGrid(-1), context=-1).type == "ann.0"
        result = agent.live(WindyGrid(1), context=1)
        assert set(agent.policies) >= {"ann.0", "bob.0"}
        assert sum(one.tasks for one in agent.types.values()) == pytest.approx(4, abs=0.1)
        assert result.type == "bob.0"
        assert result.policies[0] in ("ann.0", "bob.0")


def test_types_of_two_robots_of_one_name_are_not_mixed(tmp_path):
    for name, wind in {"here": -1, "there": 1}.items():
        with LongLivedAgent(**SETTINGS, memory=tmp_path / f"{name}.db") as agent:
            agent.live(WindyGrid(wind))
    with open_memory(tmp_path / "here.db") as memory:
        with pytest.raises(StoreError, match=r"each met a type 'robot.0' of '.*nothing was merged.*robot=NAME"):
            merge_memories(memory, [tmp_path / "there.db"])
        assert memory.tasks("robot") == 1
        memory.export_to(tmp_path / "copy.db")
        assert merge_memories(memory, [tmp_path / "copy.db"])[0][0]["already_there"] == 1
        memory.merge_from(tmp_path / "there.db")  # as earlier versions mixed them: nothing more is lost
    with open_memory(tmp_path / "fleet.db") as fleet:
        assert merge_memories(fleet, [tmp_path / "here.db"])[0][0]["added"] == 2


def test_returns_do_not_go_on_with_a_life_that_was_told_by_moves(tmp_path):
    with LongLivedAgent(**SETTINGS, memory=tmp_path / "life.db") as agent:
        agent.live(WindyGrid(-1))
    with (
        LongLivedAgent(**SETTINGS, memory=tmp_path / "life.db", signals="returns") as agent,
        pytest.raises(InputError, match=r"signals must be 'moves'.*or give another key"),
    ):
        agent.live(WindyGrid(-1))


def test_a_killed_task_is_lived_again(tmp_path):
    program = textwrap.dedent(f"""
        import os, signal
        from tests.agent.any_tasks.windy_grid import SETTINGS, WindyGrid
        from lifelore import LongLivedAgent
        agent = LongLivedAgent(**SETTINGS, memory={str(tmp_path / "life.db")!r})
        agent.live(WindyGrid(-1))
        class Dies(WindyGrid):
            def step(self, action):
                os.kill(os.getpid(), signal.SIGKILL)
        agent.live(Dies(-1))
    """)
    root = Path(__file__).parents[3]
    killed = subprocess.run(
        [sys.executable, "-c", program], cwd=root, env=os.environ | {"PYTHONPATH": f"{root}/src:{root}"}
    )
    assert killed.returncode == -signal.SIGKILL
    with LongLivedAgent(**SETTINGS, memory=tmp_path / "life.db") as agent:
        result = agent.live(WindyGrid(-1))
        assert result.number == 1
        assert result.type == "robot.0"


def test_what_memory_refuses_was_not_learnt(tmp_path, monkeypatch):
    with LongLivedAgent(**SETTINGS, memory=tmp_path / "life.db") as agent:
        with monkeypatch.context() as patched:
            patched.setattr(type(agent._memory), "contribute", lambda *_, **__: raised(StoreError("disk full")))
            with pytest.raises(StoreError, match="disk full"):
                agent.live(WindyGrid(-1))
            assert not agent.types
            patched.setattr(type(agent._memory), "contribute", lambda *_, **__: False)
            with pytest.raises(
                StoreError, match="another process took it over; its result here is not used; live"
            ):
                agent.live(WindyGrid(-1))
            assert not agent.types
        result = agent.live(WindyGrid(-1))
        assert result.new
        assert agent.types[result.type].tasks == 1


def raised(error):
    raise error


def test_a_stopped_task_teaches_nothing(tmp_path):
    stop = Event()

    class Stops(WindyGrid):
        def reset(self, *, seed=None, options=None):
            stop.set()
            return super().reset(seed=seed)

    for memory in (None, tmp_path / "life.db"):
        with LongLivedAgent(**SETTINGS, memory=memory) as agent:
            stop.clear()
            with pytest.raises(Stopped):
                agent.live(Stops(-1), stop=stop)
            assert not agent.types
            assert agent.live(WindyGrid(-1)).number == 0


# ---- learners of the user --------------------------------------------------------------------------------


class Constant:
    """Always the same action, and it can be stored."""

    def __init__(self, action):
        self.action = action

    def __call__(self, observation):
        return self.action

    def to_bytes(self):
        return bytes([self.action])


class RightLearner:
    """Plays an episode at random and returns the policy that goes right."""

    def __init__(self):
        self.starts = []

    def __call__(self, env, prior, start):
        self.starts.append(start)
        env.reset(seed=1)
        ended = False
        for _ in range(20):
            if not ended:
                _, _, ended, _, _ = env.step(env.action_space.sample())
        env.reset(seed=2)
        return Constant(3)

    @staticmethod
    def from_bytes(content):
        return Constant(content[0])


def test_a_learner_of_the_user_is_called_and_its_policy_reused(tmp_path):
    settings = SETTINGS | {"learner": RightLearner(), "memory": tmp_path / "life.db"}
    with LongLivedAgent(**settings) as agent:
        first = agent.live(WindyGrid(0))
    assert settings["learner"].starts == [None]
    assert len(first.returns) == SETTINGS["episodes"]
    assert first.new
    settings["learner"] = RightLearner()
    with LongLivedAgent(**settings) as agent:
        second = agent.live(WindyGrid(0))
    assert second.policies[0] == "robot.0"
    for start in settings["learner"].starts:
        assert isinstance(start, Constant)
    with pytest.raises(InputError, match="from_bytes"), LongLivedAgent(**settings | {"learner": "q"}) as agent:
        agent.live(WindyGrid(0))


def test_a_learner_of_the_user_may_play_more_episodes_than_a_task_has():
    n_played = 2 * SETTINGS["episodes"]

    def learner(env, prior, start):
        for seed in range(n_played):
            env.reset(seed=seed)
            env.step(3)
        env.reset(seed=n_played)
        return Constant(3)

    agents = {"full": None, "scratch": None}
    with LongLivedAgent(**SETTINGS, learner=learner) as agent:
        assert len(agent.live(WindyGrid(0)).returns) == n_played + 1  # and one by what it has learnt
    assert compare_agents(WindyGrid, [0], agents, **SETTINGS, learner=learner)["tasks"][0]["agents"].keys() == set(
        agents
    )


def test_states_that_hardly_repeat_are_a_warning():
    env = gymnasium.make("CartPole-v1")
    with pytest.warns(UserWarning, match="began in a state that the task had not met before"):
        LongLivedAgent(key="pole", episodes=40).live(env)
    LongLivedAgent(key="pole", episodes=40, state=lambda seen: tuple(seen[2:].round(1))).live(env)


def test_rewards_that_hardly_repeat_are_a_warning():
    class Noisy(gymnasium.RewardWrapper):
        """Pays with noise, which hides what tells types apart."""

        def reward(self, reward):
            return reward + self.np_random.normal()

    with pytest.warns(UserWarning, match="paid a reward that no move had paid before, so known types look new"):
        LongLivedAgent(**SETTINGS).live(Noisy(WindyGrid(0)))
    LongLivedAgent(**SETTINGS, signals="returns").live(Noisy(WindyGrid(0)))
    LongLivedAgent(**SETTINGS).live(gymnasium.wrappers.TransformReward(Noisy(WindyGrid(0)), round))


@pytest.mark.parametrize("unit", [1e-4, 1.0, 1e6, 1e9])
def test_returns_of_any_size_keep_their_deviation(tmp_path, unit):
    """The fixed point of memory keeps squares of small returns, and those of large ones do not overflow."""
    news = TaskNews(0, 0, {"a": 1.0}, Counter(), {"p": [3 * unit, 4 * unit, 8 * unit] * 20}, ActionPrior(2))
    with open_memory(tmp_path / "m.db") as memory:
        for task in range(50):
            memory.contribute("robot", Experience("k", 2).learn(news), process="one", seq=task, task={})
        number, total, squares = Experience.recalled("k", memory).types["a"].returns["p"]
    assert number == 3000
    np.testing.assert_allclose([total, squares], [15_000 * unit, 89_000 * unit**2], rtol=1e-3)


def test_returns_alone_tell_types_apart_too():
    class Paid(gymnasium.Env):
        """A bandit whose states never come again; the hidden type says which arm pays."""

        observation_space, action_space = gymnasium.spaces.Box(0, 1, (1,)), gymnasium.spaces.Discrete(2)

        def __init__(self, arm):
            self.arm = arm

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            return self.np_random.random(1), {}

        def step(self, action):
            reward = 10.0 * (action == self.arm) + self.np_random.normal()
            return self.np_random.random(1), reward, True, False, {}

    settings = {"key": "arms", "state": lambda seen: 0, "signals": "returns", "episodes": 20}
    found, earned = [], []
    for seed in range(6):
        agent = LongLivedAgent(**settings, seed=seed)
        results = [agent.live(Paid(arm)) for arm in (0, 1, 0, 1, 0, 1)]
        found.append(len(agent.types))
        earned.append(np.mean([np.mean(result.returns[3:]) for result in results[2:]]))
    # Two lives in 42 miss the second type: an explored 0 in the first task makes returns of 0 look usual.
    assert sum(n >= 2 and by > 8 for n, by in zip(found, earned, strict=True)) >= 5
    # Each of 24 tasks of known types adds one by a false alarm at 5 %: more than 4 in 0.6 % of such tests.
    assert sum(found) - 2 * len(found) <= 4


# ---- mistakes --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"agent": "fulll"}, "agent must be one of full"),
        ({"learner": "sarsa"}, "learner must be q, model"),
        ({"signals": "steps"}, "signals must be moves or returns"),
        ({"discount": 1.5}, "discount must lie"),
        ({"false_alarm": 1.0}, "false_alarm must lie"),
        ({"key": " "}, "key must be a name"),
        ({"robot": "a/b"}, "robot must be a name"),
        ({"episodes": 0}, "episodes must"),
    ],
)
def test_a_wrong_setting_is_named(settings, says):
    with pytest.raises((InputError, NotFoundError), match=says):
        LongLivedAgent(**SETTINGS | settings)


class Nan(WindyGrid):
    def step(self, action):
        return np.array(self.place), float("nan"), True, False, {}


def unfinished(env, prior, start):
    env.reset()
    env.step(0)


@pytest.mark.parametrize(
    ("live", "says"),
    [
        (lambda agent: agent.live("FrozenLake-v1"), r"env must be a gymnasium\.Env, got str"),
        (lambda agent: agent.live(gymnasium.make("Pendulum-v1")), "actions must be Discrete"),
        (lambda agent: agent.prior, "prior needs a task"),
        (lambda agent: agent.live(Nan(0)), "reward must be a finite number, got nan"),
        (lambda _: LongLivedAgent(**SETTINGS, learner=unfinished).live(Nan(0)), "reward must be a finite number"),
        (
            lambda agent: [agent.live(WindyGrid(0)), agent.live(gymnasium.make("CartPole-v1"))],
            "have the 4 actions",
        ),
    ],
)
def test_a_wrong_environment_is_named(live, says):
    with pytest.raises(InputError, match=says):
        live(LongLivedAgent(**SETTINGS))
