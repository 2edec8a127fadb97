"""Bandits whose arms start from an action prior: UCB1 and Thompson sampling.

An action prior gives the probability that each action is useful in a context. It enters as `strength` pseudo-pulls
of every arm with the mean payoff `useless + (useful - useless) θ`. Many problems are played at the same time, one
in each row. Use it to measure how much an action prior saves in a bandit: play `prior_arms` and `flat_arms` on the
same payoffs, and compare their `regret`. Thesis: §3.8.

UCB1 (Auer et al., 2002) pulls the arm of the largest mean + √(2 ln t / n), where n and t count pseudo-pulls too.
Thompson sampling draws the value of each arm from its posterior, Beta(1 + paid, 1 + not paid), and pulls the
largest.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError


class Arms(NamedTuple):
    """Pulls of every arm of every problem, with pseudo-pulls, and the sum of their payoffs.

    pulls, paid : (n_problems, n_arms) float64, at least 0
    """

    pulls: NDArray[np.float64]
    paid: NDArray[np.float64]


ArmIndex = Callable[[Arms, np.random.Generator], NDArray[np.float64]]
"""Gives the index of each arm, (n_problems, n_arms); the arm with the largest index of a row is pulled."""


def flat_arms(n_problems: int, n_arms: int) -> Arms:
    """Arms without pulls."""
    if n_problems < 1 or n_arms < 1:
        raise InputError(f"n_problems and n_arms must be at least 1, got {n_problems} and {n_arms}")
    return Arms(np.zeros((n_problems, n_arms)), np.zeros((n_problems, n_arms)))


def prior_arms(theta: ArrayLike, strength: float, useful: float = 1.0, useless: float = 0.0) -> Arms:
    """Arms that start from an action prior.

    Parameters
    ----------
    theta : (n_problems, n_arms) float
        Action probabilities of each problem's context, e.g. ``ActionPrior.probs``, in [0, 1].
    strength : float
        Pseudo-pulls of every arm, ≥ 0; 0 gives `flat_arms`.
    useful, useless : float
        Expected payoff of a useful and of a useless action.

    Examples
    --------
    >>> prior_arms([[0.75, 0.25]], strength=4).paid.tolist()
    [[3.0, 1.0]]
    """
    theta = np.asarray(theta, np.float64)
    if theta.ndim != 2 or not theta.size or not ((theta >= 0) & (theta <= 1)).all():
        raise InputError("theta must be (n_problems, n_arms) probabilities, each in [0, 1]")
    if not (strength >= 0 and np.isfinite(strength)):
        raise InputError(f"strength must be finite and at least 0, got {strength}")
    return Arms(np.full(theta.shape, float(strength)), strength * (useless + (useful - useless) * theta))


def ucb1(arms: Arms, generator: np.random.Generator) -> NDArray[np.float64]:
    """Upper confidence bounds; infinite for arms never pulled, pseudo-pulls counted."""
    # With fewer than one pull in all, the logarithm would be negative.
    seen = np.log(np.maximum(arms.pulls.sum(axis=1, keepdims=True), 1.0))
    pulls = np.where(arms.pulls > 0, arms.pulls, 1.0)
    return np.where(arms.pulls > 0, arms.paid / pulls + np.sqrt(2 * seen / pulls), np.inf)


def beta_thompson(arms: Arms, generator: np.random.Generator) -> NDArray[np.float64]:
    """One draw of each arm's value from a flat prior and the pulls; payoffs are in {0, 1}."""
    return generator.beta(1 + arms.paid, 1 + np.maximum(arms.pulls - arms.paid, 0.0))


def play(
    index: ArmIndex, arms: Arms, payoffs: NDArray[np.float64], generator: np.random.Generator
) -> NDArray[np.int64]:
    """The arms pulled, (n_problems, horizon).

    Parameters
    ----------
    index : callable
        `ucb1` or `beta_thompson`; ties are broken at random.
    arms : Arms
        The arms before the first pull; not changed.
    payoffs : (n_problems, horizon, n_arms) float
        Payoff of each arm at each pull; use the same payoffs for all methods that you compare.
    generator : numpy generator
        For the draws of `index`, and to break ties.
    """
    payoffs = np.asarray(payoffs, np.float64)
    if payoffs.ndim != 3 or (payoffs.shape[0], payoffs.shape[2]) != arms.pulls.shape:
        raise InputError(
            f"payoffs must be (n_problems, horizon, n_arms) for arms {arms.pulls.shape}, got {payoffs.shape}"
        )
    known = Arms(arms.pulls.copy(), arms.paid.copy())
    every = np.arange(len(payoffs))
    pulled = np.empty(payoffs.shape[:2], np.int64)
    for t in range(payoffs.shape[1]):
        values = index(known, generator)
        equals = values == values.max(axis=1, keepdims=True)
        pulled[:, t] = np.where(equals, generator.random(values.shape), -1.0).argmax(axis=1)
        known.pulls[every, pulled[:, t]] += 1
        known.paid[every, pulled[:, t]] += payoffs[every, t, pulled[:, t]]
    return pulled


def regret(pulled: NDArray[np.int64], means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cumulated regret up to each pull, (n_problems, horizon): best mean payoff less that of the arm pulled.

    Parameters
    ----------
    pulled : (n_problems, horizon) int
    means : (n_problems, n_arms) float
        True mean payoff of each arm.
    """
    means = np.asarray(means, np.float64)
    lost = means.max(axis=1, keepdims=True) - np.take_along_axis(means, pulled, axis=1)
    return np.cumsum(lost, axis=1)
