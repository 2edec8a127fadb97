"""Baselines of policy reuse: methods that learn from the payoffs of the policies they play.

All have the methods ``select()`` and ``update(policy, reward)``; see `Baseline`. `LinUCB` also knows what each type
of a library pays; the others know no types.
"""

from lifelore.interaction.baselines.baseline import Baseline
from lifelore.interaction.baselines.epsilon_greedy_means import EpsilonGreedyMeans
from lifelore.interaction.baselines.exp3 import EXP3
from lifelore.interaction.baselines.gp_ucb import GPUCB
from lifelore.interaction.baselines.interval_estimation import IntervalEstimation
from lifelore.interaction.baselines.lin_ucb import LinUCB
from lifelore.interaction.baselines.sliding_window_ucb import SlidingWindowUCB
from lifelore.interaction.baselines.thompson import GaussianThompson
from lifelore.interaction.baselines.try_all import TryAll
from lifelore.interaction.baselines.ucb1 import UCB1

BASELINES: dict[str, type[Baseline]] = {
    kind.name: kind
    for kind in (
        TryAll, UCB1, SlidingWindowUCB, IntervalEstimation, EXP3, GPUCB, LinUCB, GaussianThompson,
        EpsilonGreedyMeans,
    )
}  # fmt: skip
"""Every baseline by its name."""

__all__ = [
    "BASELINES",
    "EXP3",
    "GPUCB",
    "UCB1",
    "Baseline",
    "EpsilonGreedyMeans",
    "GaussianThompson",
    "IntervalEstimation",
    "LinUCB",
    "SlidingWindowUCB",
    "TryAll",
]
