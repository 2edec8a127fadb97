"""Baselines of policy reuse: bandits, and methods of other papers that know a library's types.

All have the methods ``select()`` and ``update(policy, reward)``; see `Baseline`. They learn from the payoffs of
the policies they play. `BPRPlus` and `LinUCB` also know what each type pays; the others know no types. `BayesOKR`
reads signals within an episode, so it has the methods of policy reuse and is no `Baseline`.
"""

from lifelore.interaction.baselines.baseline import Baseline
from lifelore.interaction.baselines.bayes_okr import BayesOKR
from lifelore.interaction.baselines.bpr_plus import BPRPlus
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
        TryAll, UCB1, SlidingWindowUCB, IntervalEstimation, EXP3, GPUCB, LinUCB, GaussianThompson, BPRPlus,
    )
}  # fmt: skip
"""Every baseline by its name."""

__all__ = [
    "BASELINES",
    "EXP3",
    "GPUCB",
    "UCB1",
    "BPRPlus",
    "Baseline",
    "BayesOKR",
    "GaussianThompson",
    "IntervalEstimation",
    "LinUCB",
    "SlidingWindowUCB",
    "TryAll",
]
