"""Statistics of each policy: number of plays, mean payoff and variance; the base of baselines that learn them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.baseline import Baseline, row_of


@dataclass
class ArmStatistics:
    """Pulls, means and summed squared deviations of every policy of every task; pseudo-pulls count as pulls.

    pulls, mean, squares : (rows, n_policies) float64
        `squares` is Σ (payoff - mean)²; `mean` is 0 where nothing was pulled.
    """

    pulls: NDArray[np.float64]
    mean: NDArray[np.float64]
    squares: NDArray[np.float64]

    @classmethod
    def empty(cls, rows: int, n_policies: int) -> "ArmStatistics":
        """Nothing known."""
        return cls(*(np.zeros((rows, n_policies)) for _ in range(3)))

    @classmethod
    def from_prior(
        cls,
        rows: int,
        n_policies: int,
        means: ArrayLike | None,
        pulls: ArrayLike,
        deviations: ArrayLike | None = None,
    ) -> "ArmStatistics":
        """As if each policy had been pulled `pulls` times and paid `means`, with sample deviation `deviations`.

        Nothing known where `means` is None.
        """
        arms = cls.empty(rows, n_policies)
        if means is None:
            return arms
        arms.pulls[:] = row_of("prior_pulls", pulls, n_policies, least=0.0)
        arms.mean[:] = row_of("prior_means", means, n_policies)
        if deviations is not None:
            spread = row_of("prior_deviations", deviations, n_policies)
            if (spread < 0).any() or (arms.pulls <= 1).any():
                raise InputError(
                    "prior_deviations must be at least 0 and need prior_pulls above 1, got "
                    f"{deviations!r} and {pulls!r}"
                )
            arms.squares[:] = spread**2 * (arms.pulls - 1)
        return arms

    def add(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        """One payoff a row (Welford's update)."""
        every = np.arange(len(policies))
        self.pulls[every, policies] += 1
        away = rewards - self.mean[every, policies]
        self.mean[every, policies] += away / self.pulls[every, policies]
        self.squares[every, policies] += away * (rewards - self.mean[every, policies])

    def remove(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        """Undo `add` of one payoff a row; a policy without a pull left has the mean 0 again."""
        every = np.arange(len(policies))
        left = self.pulls[every, policies] - 1
        away = rewards - self.mean[every, policies]
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = np.where(left > 0, self.mean[every, policies] - away / left, 0.0)
        self.squares[every, policies] = np.where(
            left > 0, self.squares[every, policies] - away * (rewards - mean), 0.0
        )
        self.pulls[every, policies], self.mean[every, policies] = left, mean


class ArmBaseline(Baseline):
    """Base class of baselines that learn nothing but the statistics of each policy.

    Attributes
    ----------
    arms : ArmStatistics
    """

    arms: ArmStatistics

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        self.arms.add(policies, rewards)
