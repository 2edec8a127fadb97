"""Off-policy estimators of a target policy's mean outcome from logged decisions.

    inverse propensity (IPS)   1/n Σ w y                            unbiased; large weights make it noisy
    self-normalised IPS        Σ w y / Σ w                          biased by order 1/n, less noisy
    doubly robust              1/n Σ [q̂(h, π) + w (y − q̂(h, a))]    right where the weights or the model are

y is the outcome, w the importance weight, q̂ a reward model learnt without the row's user (`reward_models`),
q̂(h, π) its expectation under the target. Weights are those of single decisions, or products along each user's
decisions (`importance_weights.trajectory_weights`); the latter are for targets that depend on earlier outcomes.

Horvitz and Thompson (1952); Swaminathan and Joachims (2015); Dudík, Langford and Li (2011); Jiang and Li (2016).
The thesis has no off-policy evaluation.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.evaluation.estimate_by_user import ClusteredEstimate, clustered_estimate, user_codes

Array = NDArray[np.float64]

ALONE = 1e-12
"""Share of the other users in the weights below which a user stands alone."""


def logged_value(outcomes: ArrayLike, users: ArrayLike) -> ClusteredEstimate:
    """Mean outcome of the decisions in the log.

    Parameters
    ----------
    outcomes : (n,) float
    users : (n,)
        Who each decision was for; intervals are clustered by user.

    Raises
    ------
    InputError
        Arrays of different lengths, without rows, or with values that are not finite.

    Examples
    --------
    >>> logged_value([1.0, 0.0, 1.0, 1.0], ["ann", "ann", "ben", "carl"]).value
    0.75
    """
    (outcomes,) = _checked(users, outcomes=outcomes)
    value = outcomes.mean()
    return clustered_estimate(value, (outcomes - value) / len(outcomes), users)


def inverse_propensity(outcomes: ArrayLike, weights: ArrayLike, users: ArrayLike) -> ClusteredEstimate:
    """The estimate by inverse propensity scores.

    Parameters
    ----------
    outcomes : (n,) float
    weights : (n,) float
        See `importance_weights`.
    users : (n,)

    Raises
    ------
    InputError
        As in `logged_value`.

    Examples
    --------
    >>> inverse_propensity([1.0, 0.0, 1.0, 1.0], [2.0, 2.0, 0.0, 0.0], [0, 1, 2, 3]).value
    0.5
    """
    outcomes, weights = _checked(users, outcomes=outcomes, weights=weights)
    value = (weights * outcomes).mean()
    return clustered_estimate(value, (weights * outcomes - value) / len(outcomes), users)


def self_normalised(
    outcomes: ArrayLike, weights: ArrayLike, users: ArrayLike, steps: ArrayLike | None = None
) -> ClusteredEstimate:
    """The estimate by self-normalised inverse propensity scores.

    Parameters
    ----------
    outcomes, weights, users
        As in `inverse_propensity`.
    steps : (n,) int, optional
        Number of each decision among its user's. With weights that are products along decisions, the weights of
        each step are normalised on their own.

    Raises
    ------
    InputError
        As in `logged_value`, or all weights of a step are 0.

    Examples
    --------
    >>> weights = np.array([2.0, 0.0, 2.0, 0.0])
    >>> self_normalised([8.0, 2.0, 3.0, 9.0], weights, ["ann", "ann", "ben", "ben"]).value
    5.5
    """
    outcomes, weights = _checked(users, outcomes=outcomes, weights=weights)
    step = np.zeros(len(outcomes), np.int64) if steps is None else np.unique(steps, return_inverse=True)[1]
    total = np.bincount(step, weights)
    if not (total > 0).all():
        raise InputError("weights of each step must have a sum above 0; the log has no decision of the target")
    share = np.bincount(step) / len(outcomes)
    mean = np.bincount(step, weights * outcomes) / total
    value = float(share @ mean)
    # As in the jackknife, a user's contribution is its effect on the estimate of the other users.
    own = user_codes(users) * len(total) + step
    others = total[step] - np.bincount(own, weights)[own]
    alone = others <= ALONE * total[step]
    effect = np.where(alone, 0.0, weights * (outcomes - mean[step]) / np.where(alone, 1.0, others))
    influence = share[step] * effect + (mean[step] - value) / len(outcomes)
    return clustered_estimate(value, influence, users)


def doubly_robust(
    outcomes: ArrayLike,
    weights: ArrayLike,
    model_of_logged: ArrayLike,
    model_of_target: ArrayLike,
    users: ArrayLike,
    before: ArrayLike | None = None,
) -> ClusteredEstimate:
    """The doubly robust estimate.

    Parameters
    ----------
    outcomes, weights, users
        As in `inverse_propensity`.
    model_of_logged, model_of_target : (n,) float
        The model's expected outcome of the logged policy, and under the target's probabilities.
    before : (n,) float, optional
        Product of the weights of the user's earlier decisions; 1 by default, for weights of single decisions.

    Raises
    ------
    InputError
        As in `logged_value`.

    Examples
    --------
    >>> weights = np.array([2.0, 0.0, 2.0, 0.0])
    >>> users = ["ann", "ann", "ben", "ben"]
    >>> doubly_robust([8.0, 2.0, 3.0, 9.0], weights, [7.0, 3.0, 4.0, 8.0], [7.0, 7.0, 4.0, 4.0], users).value
    5.5
    """
    earlier = np.ones(np.shape(outcomes)) if before is None else before
    outcomes, weights, logged, target, earlier = _checked(
        users,
        outcomes=outcomes,
        weights=weights,
        model_of_logged=model_of_logged,
        model_of_target=model_of_target,
        before=earlier,
    )
    terms = earlier * target + weights * (outcomes - logged)
    value = terms.mean()
    return clustered_estimate(value, (terms - value) / len(terms), users)


def _checked(users: ArrayLike, **arrays: ArrayLike) -> list[Array]:
    n = np.shape(users)
    found = []
    for name, values in arrays.items():
        array = np.asarray(values, np.float64)
        if len(n) != 1 or n[0] == 0 or array.shape != n:
            raise InputError(f"{name} must be (n,) like users, with n at least 1, got {array.shape} and {n}")
        if not np.isfinite(array).all():
            row = int(np.flatnonzero(~np.isfinite(array))[0])
            raise InputError(f"{name} must be finite, got {array[row]} in row {row}; leave such rows out")
        found.append(array)
    return found
