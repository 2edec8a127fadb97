"""Back-off for contexts with few counts: the posterior mean shrinks towards the mean of a coarser context.

    θ_c = (counts of c + m θ_coarser(c)) / (n_c + m)

level by level, from the full context to the uniform distribution.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError


def posterior_mean(
    prior: ActionPrior, contexts: ArrayLike, coarser: Sequence[int] = (), strength: float = 4.0
) -> NDArray[np.float64]:
    """Mean action probabilities with back-off, (n, n_actions), rows sum to 1.

    Parameters
    ----------
    prior : ActionPrior
    contexts : (n,) int
        Codes whose bits are features.
    coarser : sequence of int
        Bit masks, finest first: ``code & mask`` is the simpler context of that level.
    strength : float
        m > 0, the number of counts that the coarser level is equivalent to.
    """
    if not (strength > 0 and np.isfinite(strength)):
        raise InputError(f"strength must be positive and finite, got {strength}")
    contexts = np.asarray(contexts, np.int64).ravel()
    known = prior.contexts
    theta = np.full((len(contexts), prior.n_actions), 1 / prior.n_actions)
    # The coarsest level shrinks towards the uniform distribution with the prior's own pseudo-counts.
    weight = prior.uniform_alpha0 * prior.n_actions
    for mask in reversed(coarser):
        counts = prior.marginalise(known & mask).counts(contexts & mask)
        theta = _shrink(counts, theta, weight)
        weight = strength
    return _shrink(prior.counts(contexts), theta, weight)


def _shrink(counts: NDArray[np.float64], towards: NDArray[np.float64], weight: float) -> NDArray[np.float64]:
    return (counts + weight * towards) / (counts.sum(axis=1, keepdims=True) + weight)
