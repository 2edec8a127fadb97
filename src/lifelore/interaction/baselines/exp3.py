"""EXP3: exponential weights against payoffs that may change in any way (Auer et al., 2002)."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.baseline import Baseline
from lifelore.interaction.baselines.ucb1 import checked_scale, to_unit
from lifelore.interaction.library.policy_library import PolicyLibrary


class EXP3(Baseline):
    """p = (1 - γ) w / Σw + γ / P; the policy played gets w ← w·exp(γ x / (p P)), x the payoff in [0, 1].

    A `select` and an `update` are a pull of any length: k steps of an episode, as the thesis prints it (the payoff
    is then 0 until the goal is reached), or a whole episode.

    Parameters
    ----------
    gamma : float, optional
        Share of uniform play, in (0, 1].
    horizon : int, optional
        Number of pulls to come: γ = min(1, √(P ln P / ((e - 1) horizon))), which minimises the bound on regret.
        Give either gamma or horizon.
    scale : (float, float), optional
        Payoffs that are mapped to 0 and 1; default (0, 1). Payoffs outside are clipped: weights need [0, 1].
    n_policies, n_tasks, seed
        As in `Baseline`.

    A payoff is weighted by the probability of its policy at the time of the update, also if it comes late.

    Thesis: §4.8.5.

    Examples
    --------
    >>> player = EXP3(2, gamma=0.5)
    >>> player.update(0, 1.0)                      # w ← (exp(0.5 · 1 / (½ · 2)), 1)
    >>> player.probabilities.round(4).tolist()     # 0.5 · e^½ / (e^½ + 1) + 0.25
    [0.5612, 0.4388]
    """

    name: ClassVar[str] = "exp3"

    def __init__(
        self,
        n_policies: int,
        *,
        gamma: float | None = None,
        horizon: int | None = None,
        scale: tuple[float, float] | None = None,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        self.gamma, self.scale = _gamma(gamma, horizon, n_policies), checked_scale(scale)
        self._log_weights = np.zeros((self.rows, n_policies))

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Scale from the library's bounds."""
        return {"scale": library.performance.bounds()}

    @property
    def probabilities(self) -> NDArray[np.float64]:
        """Probability that each policy is played next, (n_policies,) or (n_tasks, n_policies)."""
        probs = self._scores()
        return probs[0] if self.n_tasks is None else probs

    def _scores(self) -> NDArray[np.float64]:
        weights = np.exp(self._log_weights - self._log_weights.max(axis=1, keepdims=True))
        weights /= weights.sum(axis=1, keepdims=True)
        return (1 - self.gamma) * weights + self.gamma / self.n_policies

    def _choose(self) -> NDArray[np.int64]:
        steps = self._scores().cumsum(axis=1)
        drawn = self._generator.random((self.rows, 1)) * steps[:, -1:]
        # The last step is the sum itself, which no draw reaches.
        return (drawn >= steps).sum(axis=1)

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        every = np.arange(self.rows)
        payoff = np.clip(to_unit(rewards, self.scale), 0.0, 1.0)
        weighed = payoff / self._scores()[every, policies]
        self._log_weights[every, policies] += self.gamma * weighed / self.n_policies


def _gamma(gamma: float | None, horizon: int | None, n_policies: int) -> float:
    if (gamma is None) == (horizon is None):
        raise InputError("give either gamma or horizon")
    if horizon is not None:
        if not horizon >= 1:
            raise InputError(f"horizon must be at least 1, got {horizon}")
        return float(min(1.0, np.sqrt(n_policies * np.log(n_policies) / ((np.e - 1) * horizon)))) or 1.0
    assert gamma is not None
    if not 0 < gamma <= 1:
        raise InputError(f"gamma must lie in (0, 1], got {gamma}")
    return float(gamma)
