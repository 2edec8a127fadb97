"""Describes a prior in numbers: counts, entropy, and how often its mask excludes the best action."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

SURE = 1e-9
"""Nats of entropy below which a context has only one action."""


def prior_report(
    prior: ActionPrior, contexts: ArrayLike | None = None, best: ArrayLike | None = None, threshold: float = 0.0
) -> dict[str, Any]:
    """Numbers about a prior as JSON data; None where a number is undefined.

    Parameters
    ----------
    prior : ActionPrior
    contexts : (n,) int, optional
        Contexts to report on, for example those of a held-out task; default: all contexts with counts.
    best : (n, n_actions) bool, optional
        Best actions in `contexts`; rows of goals and completed configurations all False.
    threshold : float
        As in `ActionPrior.mask`.

    Returns
    -------
    dict
        ``contexts`` (with counts), ``counted`` (Σ w U), ``unseen_rate`` (share of `contexts` without
        counts), ``entropy`` (mean over `contexts`, nats), ``entropy_by_counts`` (mean over all counts, nats:
        Eq. 3.11), ``sure_rate`` (share of `contexts` with one action only), ``useful_actions`` (share of actions
        that the mask allows, Fig. 3.1), ``exclusion_rate`` (share of `contexts` whose every best action the mask
        excludes; None without `best`).

    Examples
    --------
    >>> prior = ActionPrior(2)
    >>> prior.update([7, 9], [[True, False], [True, True]])
    >>> prior_report(prior)["contexts"]
    2
    """
    if best is not None and contexts is None:
        raise InputError("best needs contexts, got none: pass contexts=")
    met = prior.contexts if contexts is None else np.asarray(contexts, np.int64).ravel()
    weight = prior.counts(prior.contexts).sum(axis=1)
    entropy = prior.entropy(met)
    some = len(met) > 0
    return {
        "contexts": len(prior),
        "counted": float(weight.sum()),
        "unseen_rate": float(prior.unseen(met).mean()) if some else None,
        "entropy": float(entropy.mean()) if some else None,
        "entropy_by_counts": float(np.average(prior.entropy(prior.contexts), weights=weight))
        if len(prior)
        else None,
        "sure_rate": float((entropy < SURE).mean()) if some else None,
        "useful_actions": float(prior.mask(met, threshold).mean()) if some else None,
        "exclusion_rate": None if best is None else prior.exclusion_rate(met, best, threshold),
    }
