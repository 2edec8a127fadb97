"""One task learnt by table: the kernel's learning bit for bit, what a world is asked, what teaches the prior."""

from threading import Event

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.external_world.context_code import ContextCodes
from lifelore.agent.external_world.episode import STOP_CHECK, Step, discounted, play, reached
from lifelore.agent.external_world.table_learner import TableLearner
from lifelore.agent.external_world.useful_actions import EpisodeReturns, useful_actions
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
        self.rewards, self.truncated, self.asked = rewards, truncated, []

    def reset(self, task, seed):
        self.left = 3
        return 3

    def step(self, action):
        self.left -= 1
        over = self.left == 0
        return self.left, self.rewards[2 - self.left], over and not self.truncated, over and self.truncated

    def context(self, state, last_reward):
        self.asked.append((state, last_reward))
        return last_reward


def learner_of(n_actions, learning, prior=None, ties="uniform", discount=0.95):
    return TableLearner(n_actions, prior, learning, discount, PriorSettings(ties=ties), stream(1, "own"))


def lived(world, learner, codes, most_steps, stop=None):
    """An episode of task 7, learnt."""
    steps = play(world, 7, 0, codes, most_steps, stop or Event(), learner.act, learner.observe)
    learner.end_episode(steps, discounted(steps, learner.discount), steps[-1].ended)
    return steps


@pytest.mark.parametrize(("guided", "ties"), [(False, "uniform"), (True, "uniform"), (True, "prior")])
def test_learning_is_the_kernels(guided, ties):
    """Tables with one start and certain outcomes draw nothing from the world, so Q must agree bit for bit."""
    world = make_world("lattice", size=15)
    tables = world.task(goal=5, starts=np.array([world.n_states - 1], np.int32)).tables()
    method, codes, prior = QLearning(60, 2000, epsilon_decay=0.95), ContextCodes(), ActionPrior(4)
    prior.update([codes[0], codes[1]], [[True, False, False, True], [False, True, False, False]])
    probs = prior.probs([codes[c] for c in range(3)]) if guided else np.full((3, 4), 0.25)
    rows = uniform_rows(tables, probs, probs if ties == "prior" else None, np.arange(tables.n_states) % 3)
    expected, curve = method.learn(tables, 0.9, world=stream(1, "w"), own=stream(1, "own"), rows=rows)
    learner = learner_of(4, method, prior if guided else None, ties, 0.9)
    ended_well = [reached(lived(Tabled(tables), learner, codes, 2000)) for _ in range(60)]
    visited = np.flatnonzero(expected.visits.any(axis=1))
    assert len(visited) > 64
    for state in visited:
        assert learner.q[codes[int(state)]].tolist() == [expected.q[state].tolist()]
    assert learner.returns.returns == curve.returns.tolist()
    assert ended_well == curve.reached.astype(bool).tolist()


def test_context_is_asked_with_the_reward_just_received():
    world, learner, codes = Countdown(), learner_of(2, QLearning(1)), ContextCodes()
    steps = lived(world, learner, codes, 9)
    assert world.asked == [(3, 0.0), (2, 0.5), (1, 1.5)]
    assert learner.returns.returns == [pytest.approx(0.5 + 0.95 * 1.5 + 0.95**2 * 2.5)]
    assert (steps[-1].following, reached(steps)) == (codes[0], True)
    # Each state's first value is half its reward, for nothing is known of what follows; the end has no value.
    assert {code: row.max() for code, row in learner.q.items()} == {codes[3]: 0.25, codes[2]: 0.75, codes[1]: 1.25}


def test_an_episode_is_replayed_backwards_at_a_falling_rate():
    learner, codes = (
        TableLearner(2, None, QLearning(1), 0.95, PriorSettings(), stream(1, "own"), "q"),
        ContextCodes(),
    )
    lived(Countdown(), learner, codes, 9)
    rate, last = 0.5 / 1.1, 1.25 + 0.5 / 1.1 * (2.5 - 1.25)  # the second time that a move is learnt
    middle = 0.75 + rate * (1.5 + 0.95 * last - 0.75)
    found = [learner.q[codes[state]].max() for state in (1, 2, 3)]
    assert found == pytest.approx([last, middle, 0.25 + rate * (0.5 + 0.95 * middle - 0.25)])


@pytest.mark.parametrize(
    ("rewards", "truncated", "well"),
    [((0, 0, 1), False, True), ((1, 1, 0), False, False), ((0, 0, 1), True, False)],
)
def test_reached_is_a_positive_end_that_no_clock_called(rewards, truncated, well):
    learner, codes = learner_of(2, QLearning(1)), ContextCodes()
    assert reached(lived(Countdown(rewards, truncated), learner, codes, 9)) is well
    assert not learner.knows(codes[0])  # it only arrived there


def test_stop_is_heard_within_an_episode():
    class Endless(Countdown):
        def step(self, action):
            self.asked.append("step")
            stop.set()
            return 3, 0.0, False, False

    world, stop = Endless(), Event()
    with pytest.raises(Stopped):
        lived(world, learner_of(2, QLearning(1)), ContextCodes(), 10**6, stop)
    assert world.asked.count("step") == STOP_CHECK


@pytest.mark.parametrize("reward", [float("nan"), float("inf")])
def test_rewards_must_be_finite(reward):
    with pytest.raises(InputError, match=rf"reward must be a finite number, got {reward} for action \d in task 7"):
        lived(Countdown((0.5, reward, 0.5)), learner_of(2, QLearning(1)), ContextCodes(), 9)


@pytest.mark.parametrize(
    ("tries", "value", "trust"), [(0, 1.0, 0.5), (4, 1.0, 0.25), (12, 1.0, 0.125), (12, 0.0, 0.5)]
)
def test_a_cautious_learner_trusts_the_prior_by_half_and_less_where_its_type_has_learnt(tries, value, trust):
    """The prior counts as a try of each of 4 actions: its share is 0.5 · 4 / (4 + tries) where values differ."""
    prior, n = ActionPrior(4), 4000
    prior.update([7], [[True, False, False, False]])
    learner = TableLearner(
        4, prior, QLearning(10, epsilon=1.0), 0.9, PriorSettings(form="support", ties="prior"), stream(0, "own"),
        cautious=True, start={state: np.array([0, 0, 0, value]) for state in range(n)},
        met=lambda state, action: tries / 4,
    )  # fmt: skip
    expected = trust * prior.probs([7], "support")[0, 0] + (1 - trust) / 4
    share = np.mean([learner.act(state, 7) == 0 for state in range(n)])
    assert share == pytest.approx(expected, abs=4 * 0.5 / n**0.5)  # four deviations of a share of n draws
    assert learner.visited[3, 7] == tries + 1


def test_a_cautious_learner_does_not_trust_the_prior_where_all_episodes_earn_the_same():
    learner = TableLearner(
        4, ActionPrior(4), QLearning(10), 0.9, PriorSettings(), stream(0, "own"), cautious=True
    )  # fmt: skip
    guided = []
    for earned in (1.0, 1.0, 1.0, 2.0, 1.0):
        learner.end_episode([], earned, True)
        guided.append(learner._guided)
    assert guided == [False, True, False, True, True]


# ---- which actions teach the prior -----------------------------------------------------------------

HALL, STAIRS = (5, 0), (6, 1)


def returns_of(*episodes):
    returns = EpisodeReturns(3)
    for steps, earned, ended in episodes:
        returns.add([Step(*place, action, 0.0, 7, False) for place, action in steps], earned, ended)
    return returns


def test_a_positive_value_decides_by_sign():
    q = np.array([[2.0, 1.0, 2.0], [-1.0, 0.0, -1.0]])
    returns = returns_of(([(STAIRS, 1)], -1.0, True), ([(STAIRS, 0)], -9.0, True))
    assert useful_actions(q, [HALL, STAIRS], returns).tolist() == [[True, False, True], [False] * 3]


def test_without_a_positive_value_the_best_taken_in_the_best_tenth_counts():
    """Twenty episodes: the two best return -2. Action 2 of the hall was never taken, so its value 0 is no news."""
    q = np.array([[-3.0, -1.5, 0.0], [-4.0, -4.0, -1.0]])
    worse = [([(HALL, 0), (STAIRS, 0)], -9.0, True)] * 18
    best = [([(HALL, 0), (HALL, 1)], -2.0, True), ([(HALL, 1), (STAIRS, 1)], -2.0, True)]
    useful = useful_actions(q, [HALL, STAIRS], returns_of(*worse, *best))
    assert useful.tolist() == [[False, True, False], [False, True, False]]


def test_episodes_that_did_not_end_and_equal_returns_teach_nothing():
    idle = returns_of(*[([(HALL, 0)], -9.0, True)] * 9, ([(HALL, 1)], -2.0, False))
    assert not useful_actions(np.array([[-3.0, -1.0, 0.0]]), [HALL], idle).any()
    assert not useful_actions(-np.ones((1, 3)), [HALL], returns_of(*[([(HALL, 0)], -1.0, True)] * 9)).any()
    assert [part.shape for part in learner_of(3, QLearning(1)).best()] == [(0,), (0, 3)]
