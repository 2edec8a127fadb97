"""Bandits whose arms start from an action prior: UCB1 and Thompson sampling.

An action prior says how likely each action is to be a useful one in the context at hand. As pseudo-counts it
stands for pulls made before the first: `strength` pulls of every arm that paid `useless + (useful - useless) θ`
on average. Many problems are played at once, row by row. Thesis: §3.8.

UCB1 (Auer et al., 2002) pulls the arm of the largest mean + √(2 ln t / n), where n and t count pseudo-pulls too.
Thompson sampling draws each arm's value from what is believed of it and pulls the largest: Beta(1 + paid,
1 + not paid), or a normal around the mean of the payoffs and one weak guess.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

GUESS, GUESS_PULLS = 0.5, 0.25
"""Mean and weight in pulls of the normal belief about an arm never pulled: its deviation is twice the noise's."""


class Arms(NamedTuple):
    """What is known of every arm of every problem: pulls, pseudo-pulls too, and their summed payoff.

    pulls, paid : (n_problems, n_arms) float64, at least 0
    """

    pulls: NDArray[np.float64]
    paid: NDArray[np.float64]


ArmIndex = Callable[[Arms, np.random.Generator], NDArray[np.float64]]
"""What an arm is worth pulling, (n_problems, n_arms); the largest of a row is pulled, equals at random."""


def flat_arms(n_problems: int, n_arms: int) -> Arms:
    """Arms of which nothing is known."""
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
        Mean payoff believed of a useful and of a useless action.

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
    # Fewer than one pull in all would have a negative logarithm.
    seen = np.log(np.maximum(arms.pulls.sum(axis=1, keepdims=True), 1.0))
    pulls = np.where(arms.pulls > 0, arms.pulls, 1.0)
    return np.where(arms.pulls > 0, arms.paid / pulls + np.sqrt(2 * seen / pulls), np.inf)


def beta_thompson(arms: Arms, generator: np.random.Generator) -> NDArray[np.float64]:
    """One draw of each arm's value, payoffs in {0, 1}, from a flat belief and the pulls."""
    return generator.beta(1 + arms.paid, 1 + np.maximum(arms.pulls - arms.paid, 0.0))


def gaussian_thompson(noise: float) -> ArmIndex:
    """Thompson sampling for payoffs with a normal noise of known deviation `noise` > 0."""
    if not noise > 0:
        raise InputError(f"noise must be positive, got {noise}")

    def index(arms: Arms, generator: np.random.Generator) -> NDArray[np.float64]:
        pulls = arms.pulls + GUESS_PULLS
        mean = (arms.paid + GUESS_PULLS * GUESS) / pulls
        return generator.normal(mean, noise / np.sqrt(pulls))

    return index


def play(
    index: ArmIndex, arms: Arms, payoffs: NDArray[np.float64], generator: np.random.Generator
) -> NDArray[np.int64]:
    """The arms pulled, (n_problems, horizon).

    Parameters
    ----------
    index : callable
        `ucb1`, `beta_thompson` or ``gaussian_thompson(noise)``.
    arms : Arms
        What is known before the first pull; left as it is.
    payoffs : (n_problems, horizon, n_arms) float
        What each arm would pay at each pull: the same for all that are compared.
    generator : numpy generator
        For draws and among equals.
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
        worth = index(known, generator)
        equals = worth == worth.max(axis=1, keepdims=True)
        pulled[:, t] = np.where(equals, generator.random(worth.shape), -1.0).argmax(axis=1)
        known.pulls[every, pulled[:, t]] += 1
        known.paid[every, pulled[:, t]] += payoffs[every, t, pulled[:, t]]
    return pulled


def regret(pulled: NDArray[np.int64], means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Regret summed up to each pull, (n_problems, horizon): what the best arm would have paid more on average.

    Parameters
    ----------
    pulled : (n_problems, horizon) int
    means : (n_problems, n_arms) float
        True mean payoff of each arm.
    """
    means = np.asarray(means, np.float64)
    lost = means.max(axis=1, keepdims=True) - np.take_along_axis(means, pulled, axis=1)
    return np.cumsum(lost, axis=1)
