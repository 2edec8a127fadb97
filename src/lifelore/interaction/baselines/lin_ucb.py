"""LinUCB: upper confidence bounds of payoffs that are linear in a policy's features (Li et al., 2010).

A contextual-bandit approach to personalized news article recommendation, Algorithm 1, with a single weight vector
for all policies of a user, so that a play of one policy tells of the others. With x the features of a policy and
the payoffs r of the policies played:

    A = λ I + Σ x xᵀ,  b = Σ r x,  w = A⁻¹ b,  score = x·w + α √(xᵀ A⁻¹ x)

That is GP-UCB with the covariance X Xᵀ / λ and a constant β = α². A user whose means are a mixture of types' means
is linear in the library: x are a policy's mean payoffs on each type, and w are the shares of the types.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.baseline import LEAST, library_moments
from lifelore.interaction.baselines.gp_ucb import GPUCB
from lifelore.interaction.library.policy_library import PolicyLibrary

LEAST_NOISE = 1e-3
"""Least noise as a share of the largest mean payoff: smaller numbers lose the precision of A⁻¹."""


class LinUCB(GPUCB):
    """Ridge regression of each task's payoffs on the policies' features, and its upper confidence bound.

    Parameters
    ----------
    features : (n_policies, n_features) float
        In units of payoffs where weights are shares of types.
    noise : float
        Deviation > 0 of a payoff.
    alpha : float
        α ≥ 0; smaller explores less. The paper's 1 + √(ln(2/δ) / 2) is 2 at δ = 0.27.
    ridge : float
        λ > 0; 1 as in the paper.
    n_policies, n_tasks, seed
        As in `Baseline`.

    `from_library` takes the mean payoffs on the library's types as features, and the root mean square of payoffs'
    deviations as noise.

    Examples
    --------
    >>> player = LinUCB(3, features=[[1, 0], [0, 1], [0, 2]], alpha=0)
    >>> player.update(1, 1.0)    # w = (0, 1/2), and policy 2 has twice the feature
    >>> player.select()
    2
    """

    name: ClassVar[str] = "lin-ucb"

    def __init__(
        self,
        n_policies: int,
        *,
        features: ArrayLike,
        noise: float = 1.0,
        alpha: float = 2.0,
        ridge: float = 1.0,
        **common: Any,
    ) -> None:
        rows = np.array(features, np.float64)
        if rows.ndim != 2 or len(rows) != max(n_policies, 1) or not rows.size or not np.isfinite(rows).all():
            raise InputError(f"features must be ({n_policies}, n_features), finite, got shape {rows.shape}")
        if not (ridge > 0 and np.isfinite(ridge)):
            raise InputError(f"ridge must be finite and positive, got {ridge}")
        if not (alpha >= 0 and np.isfinite(alpha)):
            raise InputError(f"alpha must be finite and at least 0, got {alpha}")
        super().__init__(n_policies, kernel=rows @ rows.T / ridge, noise=noise, beta=alpha**2, **common)

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """Mean payoffs on each type, and the noise of payoffs."""
        means = np.asarray(library.performance.mean)
        noise = float(np.sqrt((library_moments(library).noise ** 2).mean()))
        return {"features": means.T, "noise": max(noise, LEAST_NOISE * float(np.abs(means).max()), LEAST)}
