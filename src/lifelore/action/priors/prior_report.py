"""What a prior knows, in numbers for people: what it counted, how open it leaves the choice, what it excludes."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

SURE = 1e-9
"""Nats of entropy below which a context leaves nothing to choose."""


def prior_report(
    prior: ActionPrior, contexts: ArrayLike | None = None, best: ArrayLike | None = None, threshold: float = 0.0
) -> dict[str, Any]:
    """Plain data about a prior; NaN never, None where there is nothing to measure.

    Parameters
    ----------
    prior : ActionPrior
    contexts : (n,) int, optional
        Contexts met, say the states of a held-out task; default every context with counts.
    best : (n, n_actions) bool, optional
        Best actions there; rows of goals and completed configurations all False. Needs `contexts`.
    threshold : float
        As in `ActionPrior.mask`.

    Returns
    -------
    dict
        ``contexts`` (with counts), ``counted`` (Σ w U), ``unseen_rate`` (share of the contexts met that have no
        counts), ``entropy`` (mean over the contexts met, nats), ``entropy_by_counts`` (mean over all counts, nats:
        Eq. 3.11), ``sure_rate`` (share of contexts met with one action only), ``useful_actions`` (share of actions
        that the mask allows, Fig. 3.1), ``exclusion_rate`` (share of contexts met whose every best action the mask
        excludes; None without `best`).
    """
    if best is not None and contexts is None:
        raise InputError("best needs the contexts it belongs to: pass contexts=")
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
