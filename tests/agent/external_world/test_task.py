"""One task in a foreign world: the kernel's learning bit for bit, and what the world is asked."""

from threading import Event

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.external_world.context_code import ContextCodes
from lifelore.agent.external_world.task import STOP_CHECK, ExternalLearner, ExternalTask
from lifelore.agent.life.loop import Stopped
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import uniform_rows
from lifelore.core.mdp import TERMINAL
from lifelore.core.streams import stream
from lifelore.domains import make_world


class Tabled:
    """A domain's tables as a world; for tasks with one start and certain outcomes."""

    def __init__(self, tables):
        self.tables, self.n_actions, self.state = tables, tables.n_actions, 0

    def reset(self, task, seed):
        self.state = int(self.tables.starts[0])
        return self.state

    def step(self, action):
        at = self.state, action, 0
        self.state = int(self.tables.next_state[at])
        return self.state, float(self.tables.reward[at]), bool(self.tables.event[at] & TERMINAL), False

    def context(self, state, last_reward):
        return state % 3


class Countdown:
    """Three steps an episode, whatever is done, worth `rewards`; the context is the reward just received."""

    n_actions = 2

    def __init__(self, rewards=(0.5, 1.5, 2.5), truncated=False):
        self.rewards, self.truncated, self.asked, self.resets = rewards, truncated, [], []

    def reset(self, task, seed):
        self.resets.append((task, seed))
        self.left = 3
        return 3

    def step(self, action):
        self.left -= 1
        over = self.left == 0
        return self.left, self.rewards[2 - self.left], over and not self.truncated, over and self.truncated

    def context(self, state, last_reward):
        self.asked.append((state, last_reward))
        return last_reward


def lived(world, method, stop=None, seeds=None):
    """The learner and its numbers, of one task without a prior."""
    learner = ExternalLearner(world.n_actions, None, PriorSettings(), stream(0, "own"))
    seeds = seeds or list(range(method.episodes))
    task = ExternalTask(world, ContextCodes(), method, 0.95, 7, seeds, stop or Event())
    return learner, task.live(learner)


@pytest.mark.parametrize("ties", ["uniform", "prior"])
@pytest.mark.parametrize("guided", [False, True])
def test_learning_is_the_kernels(guided, ties):
    """Tables with one start and certain outcomes draw nothing from the world, so Q must agree bit for bit."""
    world = make_world("lattice", size=15)
    task = world.task(goal=5, starts=np.array([world.n_states - 1], np.int32))
    tables, method, codes = task.tables(), QLearning(60, 2000, epsilon_decay=0.95), ContextCodes()
    context = np.arange(tables.n_states) % 3
    prior = ActionPrior(4)
    prior.update([codes[0], codes[1]], [[True, False, False, True], [False, True, False, False]])
    probs = prior.probs([codes[c] for c in range(3)]) if guided else np.full((3, 4), 0.25)
    rows = uniform_rows(tables, probs, probs if guided and ties == "prior" else None, context)
    expected, curve = method.learn(tables, 0.9, world=stream(1, "w"), own=stream(1, "own"), rows=rows)

    learner = ExternalLearner(4, prior if guided else None, PriorSettings(ties=ties), stream(1, "own"))
    result = ExternalTask(Tabled(tables), codes, method, 0.9, 0, [0] * 60, Event()).live(learner)
    visited = np.flatnonzero(expected.visits.any(axis=1))
    assert len(visited) > 64
    for state in visited:
        assert learner.q[state].tolist() == [expected.q[state].tolist()]
    assert result["first_return"] == curve.returns[0]
    assert result["mean_return"] == pytest.approx(curve.returns.mean())
    assert result["final_return"] == pytest.approx(curve.returns[-6:].mean())
    assert result["reached"] == bool(curve.reached.any())


def test_context_is_asked_with_the_reward_just_received():
    world = Countdown()
    learner, result = lived(world, QLearning(1))
    assert world.asked == [(3, 0.0), (2, 0.5), (1, 1.5)]
    assert result["first_return"] == pytest.approx(0.5 + 0.95 * 1.5 + 0.95**2 * 2.5)
    # Each state's first value is half its reward, for nothing is known of what follows it.
    assert [learner.value(state) for state in (3, 2, 1)] == [0.25, 0.75, 1.25]
    # The end was never acted in, so nothing is known of it.
    assert set(learner.q) == {3, 2, 1}


@pytest.mark.parametrize(
    ("rewards", "truncated", "reached"),
    [((0, 0, 1), False, True), ((1, 1, 0), False, False), ((0, 0, 1), True, False)],
)
def test_reached_is_a_positive_end_that_no_clock_called(rewards, truncated, reached):
    assert lived(Countdown(rewards, truncated), QLearning(2))[1]["reached"] is reached


def test_a_truncated_episode_may_have_had_a_future():
    """The end of a truncated episode is a state like others, with values of its own."""
    learner, _ = lived(Countdown(truncated=True), QLearning(1))
    assert set(learner.q) == {3, 2, 1, 0}


def test_episodes_have_the_seeds_given():
    world = Countdown()
    lived(world, QLearning(3), seeds=[11, 5, 8])
    assert world.resets == [(7, 11), (7, 5), (7, 8)]


def test_best_actions_count_where_a_state_is_worth_something():
    learner = ExternalLearner(3, None, PriorSettings(), stream(0, "own"))
    assert [part.shape for part in learner.best()] == [(0,), (0, 3)]
    for state, code in (("tie", 4), ("bad", 9), ("new", 4), ("tie", 5)):
        learner.act(state, code, 0.0)
    learner.q["tie"][0] = [2.0, 1.0, 2.0]
    learner.q["bad"][0] = [-1.0, -2.0, -1.0]
    codes, best = learner.best()
    assert codes.tolist() == [4, 9, 4, 5]
    assert best.astype(int).tolist() == [[1, 0, 1], [0, 0, 0], [0, 0, 0], [1, 0, 1]]


def test_stop_is_heard_within_an_episode():
    stop = Event()

    class Endless(Countdown):
        steps = 0

        def step(self, action):
            self.steps += 1
            stop.set()
            return 3, 0.0, False, False

    world = Endless()
    with pytest.raises(Stopped):
        lived(world, QLearning(1, 10**6), stop)
    assert world.steps == STOP_CHECK


@pytest.mark.parametrize("reward", [float("nan"), float("inf")])
def test_rewards_must_be_finite(reward):
    with pytest.raises(InputError, match=rf"reward must be a finite number, got {reward} for action \d in task 7"):
        lived(Countdown((0.5, reward, 0.5)), QLearning(1))


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"alpha0": 0}, "alpha0 must be positive"),
        ({"weight": float("nan")}, "weight must lie in"),
        ({"form": "best"}, "form must be one of proportion"),
        ({"ties": "none"}, "ties must be one of uniform, prior"),
    ],
)
def test_guidance_that_breaks_its_rule(settings, said):
    with pytest.raises(InputError, match=said):
        PriorSettings(**settings)
