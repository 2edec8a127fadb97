"""Bandits whose arms start from an action prior: UCB1 and Thompson sampling, many problems at once.

An action prior gives the probability that each action is useful in a context. It enters as pseudo-pulls of every
arm whose mean payoff is that probability. Thesis: §3.8.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.baselines.arm_statistics import ArmBaseline, ArmStatistics
from lifelore.interaction.baselines.ucb1 import UCB1


class BetaThompson(ArmBaseline):
    """Thompson sampling of payoffs in {0, 1}: an arm's value is drawn from Beta(1 + paid, 1 + not paid)."""

    name: ClassVar[str] = "beta"

    def __init__(self, n_policies: int, **common: Any) -> None:
        super().__init__(n_policies, **common)
        self.arms = ArmStatistics.empty(self.rows, n_policies)

    def _scores(self) -> NDArray[np.float64]:
        paid = self.arms.pulls * self.arms.mean
        return self._generator.beta(1 + paid, 1 + np.maximum(self.arms.pulls - paid, 0.0))


BANDITS: dict[str, type[UCB1] | type[BetaThompson]] = {"ucb1": UCB1, "beta": BetaThompson}


def regret(
    name: str,
    theta: NDArray[np.float64],
    strength: ArrayLike,
    payoffs: NDArray[np.float64],
    means: NDArray[np.float64],
    generator: np.random.Generator,
) -> NDArray[np.float64]:
    """Regret of each problem over all pulls, (n_problems,): best mean payoff less that of the arm pulled, summed.

    Parameters
    ----------
    name : str
        Of `BANDITS`.
    theta : (n_problems, n_arms) float
        Mean payoff of the pseudo-pulls.
    strength : float or (n_problems, 1) float
        Pseudo-pulls of every arm; 0 for none.
    payoffs : (n_problems, n_pulls, n_arms) float
        Payoff of each arm at each pull, in {0, 1}.
    means : (n_problems, n_arms) float
        True mean payoff of each arm.
    generator : numpy generator
        Serves draws and ties.
    """
    player = BANDITS[name](theta.shape[1], n_tasks=len(theta), seed=generator)
    player.arms.pulls[:], player.arms.mean[:] = strength, theta
    every, lost = np.arange(len(theta)), np.zeros(len(theta))
    for paid in payoffs.swapaxes(0, 1):
        arm = player.select()
        player.update(arm, paid[every, arm])
        lost += means.max(axis=1) - means[every, arm]
    return lost
