"""Outside bandits as players of one task: MABWiser's UCB1 and Thompson sampling, Vowpal Wabbit's cb_explore.

All are optional; without them their rows are left empty. They see payoffs and no types. MABWiser starts from one
pull of each arm at its mean over the types; Vowpal Wabbit learns from one line of text for each payoff.
"""

from collections.abc import Callable
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

Player = tuple[Callable[[], int], Callable[[int, float], None]]
"""Selects a policy; learns from its payoff."""


def installed(name: str) -> bool:
    """Whether the program can be imported."""
    return find_spec(name) is not None


def mabwiser_ucb1(prior_means: NDArray[np.float64], seed: int) -> Player:
    """UCB1 of MABWiser with its default factor."""
    from mabwiser.mab import LearningPolicy  # pyright: ignore[reportMissingImports]

    return _mabwiser(LearningPolicy.UCB1(), prior_means, seed)


def mabwiser_thompson(prior_means: NDArray[np.float64], seed: int) -> Player:
    """Thompson sampling of MABWiser; a payoff above the mean of all arms is a success."""
    from mabwiser.mab import LearningPolicy  # pyright: ignore[reportMissingImports]

    middle = float(prior_means.mean())
    return _mabwiser(LearningPolicy.ThompsonSampling(lambda arm, payoff: payoff > middle), prior_means, seed)


def vowpal_wabbit(prior_means: NDArray[np.float64], seed: int) -> Player:
    """``--cb_explore`` of Vowpal Wabbit, ε-greedy with its default ε; costs are minus the payoffs."""
    from vowpalwabbit import Workspace  # pyright: ignore[reportMissingImports]

    learner, random = Workspace(f"--cb_explore {len(prior_means)} --quiet"), np.random.default_rng(seed)
    probs: list[float] = []

    def select() -> int:
        probs[:] = learner.predict("|")
        return min(int(np.searchsorted(np.cumsum(probs), random.random())), len(probs) - 1)

    def update(policy: int, payoff: float) -> None:
        learner.learn(f"{policy + 1}:{-payoff}:{probs[policy]} |")

    return select, update


PEERS: dict[str, tuple[str, Callable[[NDArray[np.float64], int], Player]]] = {
    "MABWiser UCB1": ("mabwiser", mabwiser_ucb1),
    "MABWiser Thompson sampling": ("mabwiser", mabwiser_thompson),
    "Vowpal Wabbit cb_explore": ("vowpalwabbit", vowpal_wabbit),
}
"""Each peer with the package it needs."""


def _mabwiser(policy, prior_means: NDArray[np.float64], seed: int) -> Player:
    from mabwiser.mab import MAB  # pyright: ignore[reportMissingImports]

    arms = list(range(len(prior_means)))
    bandit = MAB(arms, policy, seed=seed)
    bandit.fit(decisions=arms, rewards=prior_means.tolist())

    def update(policy: int, payoff: float) -> None:
        bandit.partial_fit(decisions=[policy], rewards=[payoff])

    return bandit.predict, update
