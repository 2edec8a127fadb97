"""Bayes-OKR: the naive twin of both beliefs, switches within few steps, the edges of an episode."""

from math import exp, pi, sqrt

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction import BayesOKR, LikelihoodSignal, PolicyLibrary

MOVES = np.array([[0.7, 0.2, 0.1], [0.1, 0.7, 0.2], [0.2, 0.1, 0.7]])
"""P(move | type); the policy of the same number wins the move."""
STEPS = 5


def log_moves(policy, move):
    return np.log(MOVES[:, move])


def library(prior=None):
    """Returns are numbers of moves won in an episode of five, taken as normal."""
    deviation = np.sqrt(STEPS * MOVES * (1 - MOVES))
    signal = LikelihoodSignal(log_moves, n_types=3)
    return PolicyLibrary.from_means(STEPS * MOVES, deviation, signal=signal, prior=prior)


def raised(belief, floor):
    total = sum(belief)
    belief = [max(value / total, floor) for value in belief]
    return [value / sum(belief) for value in belief]


class NaiveOKR:
    """Both beliefs in plain Python, by the equations of the module."""

    def __init__(self, prior, weight, window, floor):
        self.between, self.weight, self.window, self.floor = list(prior), weight, window, floor
        self.start()

    def start(self):
        self.within, self.moves = list(self.between), []

    def observe(self, move):
        self.moves.append(move)
        for last in self.moves[-self.window :]:
            self.within = [own * MOVES[type_][last] for type_, own in enumerate(self.within)]
        self.within = raised(self.within, self.floor)

    def belief(self):
        pairs = zip(self.between, self.within, strict=True)
        return [self.weight * between + (1 - self.weight) * within for between, within in pairs]

    def end(self, policy, paid):
        for type_ in range(3):
            variance = STEPS * MOVES[type_][policy] * (1 - MOVES[type_][policy])
            density = exp(-((paid - STEPS * MOVES[type_][policy]) ** 2) / (2 * variance)) / sqrt(2 * pi * variance)
            self.between[type_] *= density
        self.between = raised(self.between, self.floor)
        self.start()


@pytest.mark.parametrize("settings", [
    {"weight": 0.1, "window": 1, "floor": 0.01},
    {"weight": 0.4, "window": 3, "floor": 0.001},
    {"weight": 0.0, "window": 2, "floor": 0.1},
])  # fmt: skip
def test_a_naive_bayes_okr_has_the_same_beliefs_and_choices(settings):
    random, prior = np.random.default_rng(1), [0.5, 0.3, 0.2]
    agent, naive = BayesOKR(library(prior), **settings), NaiveOKR(prior, **settings)
    for episode in range(30):
        won, policy, type_ = 0, 0, episode // 4 % 3
        for move in random.choice(3, STEPS, p=MOVES[type_]).tolist():
            expected = [sum(b * MOVES[t][p] for t, b in enumerate(naive.belief())) for p in range(3)]
            policy = agent.select()
            assert policy == expected.index(max(expected))
            agent.observe(policy, move)
            naive.observe(move)
            won += policy == move
            assert agent.belief.tolist() == pytest.approx(naive.belief(), rel=1e-9)
        agent.end_episode(won)
        naive.end(policy, won)
        assert np.exp(agent.between).tolist() == pytest.approx(naive.between, rel=1e-9)
        assert agent.belief.tolist() == pytest.approx(naive.between, rel=1e-9)


def test_only_available_policies_are_selected():
    agent = BayesOKR(library([0.0, 1.0, 0.0]))
    assert agent.select() == 1
    assert agent.select(["policy 0", 2]) == 2
    with pytest.raises(InputError, match="available must hold at least one policy"):
        agent.select([])


def test_a_bad_signal_or_return_changes_nothing():
    signal = LikelihoodSignal(lambda policy, move: [move, 0.0, 0.0], n_types=3)
    agent = BayesOKR(PolicyLibrary.from_means(MOVES, 0.2, signal=signal), window=2)
    with pytest.raises(InputError, match="the return is of no policy"):
        agent.end_episode(1.0)
    agent.observe(0, -1.0)
    before = agent.belief
    with pytest.raises(InputError):
        agent.observe(0, np.nan)
    with pytest.raises(NotFoundError):
        agent.observe(3, -1.0)
    with pytest.raises(InputError, match="value must be a finite number"):
        agent.end_episode(np.nan)
    assert agent.belief.tolist() == before.tolist()
    twin = BayesOKR(agent.library, window=2)
    for each in (agent, twin):
        each.observe(0, -1.0)
    twin.observe(0, -1.0)
    assert agent.belief == pytest.approx(twin.belief)
