"""Bayesian policy reuse (Algorithm 7) for exact models, type by type in plain Python: the slow twin.

    β ← G₀
    for each episode:  for each of its signals:  β(τ) ← F(σ | τ, π) β(τ) / Σ F β
                       once, at its end:         β ← the step of the dynamics

Beliefs are logarithms, and every sum of probabilities is `math.fsum` of exponentials below 1, which is exact up to
its last rounding. Nothing is imported from the code under test. Thesis: §4.2, Alg. 7.
"""

from collections.abc import Callable, Sequence
from math import exp, fsum, inf, lgamma, log, log1p, pi

Logs = list[float]
Step = Callable[[Logs], Logs]

MAX_SURPRISE = 745.0
"""Largest surprise of a single signal in nats, that of an impossible signal too."""


# ---- sums of probabilities as logarithms ----------------------------------------------------------------------


def log_of(probability: float) -> float:
    """log p, minus infinity for 0."""
    return log(probability) if probability > 0 else -inf


def log_sum(logs: Sequence[float]) -> float:
    """log Σ exp; minus infinity where all terms are."""
    top = max(logs)
    return -inf if top == -inf else top + log(fsum(exp(value - top) for value in logs))


def normalised(logs: Sequence[float]) -> Logs:
    """The logs less their `log_sum`; none above 0."""
    total = log_sum(logs)
    return [min(value - total, 0.0) for value in logs]


# ---- the two steps of an episode ------------------------------------------------------------------------------


def bayes(log_belief: Logs, log_likelihood: Sequence[float]) -> tuple[Logs, float]:
    """The log belief after a signal, and log Σ F β; the belief stays where no type explains the signal."""
    joint = [b + f if b > -inf else -inf for b, f in zip(log_belief, log_likelihood, strict=True)]
    evidence = log_sum(joint)
    return (list(log_belief), -inf) if evidence == -inf else (normalised(joint), evidence)


def static() -> Step:
    """Types never change."""
    return list


def hazard(rate: float, prior: Sequence[float]) -> Step:
    """With probability `rate` the type is drawn anew: β'(τ) = (1 − h) β(τ) + h G₀(τ)."""

    def step(log_belief: Logs) -> Logs:
        stays = [log_of(1 - rate) + b for b in log_belief]
        anew = [log_of(rate) + log_of(p) for p in prior]
        return [min(log_sum(pair), 0.0) for pair in zip(stays, anew, strict=True)]

    return step


def transitions(matrix: Sequence[Sequence[float]]) -> Step:
    """β'(j) = Σᵢ β(i) P(j | i); `matrix` [type before][type after], rows sum to 1."""

    def step(log_belief: Logs) -> Logs:
        into = range(len(matrix))
        return [
            min(log_sum([b + log_of(row[j]) for b, row in zip(log_belief, matrix, strict=True)]), 0.0)
            for j in into
        ]

    return step


class NaiveReuse:
    """The belief about one user.

    Parameters
    ----------
    prior : (n_types,) float
    step : callable
        Log belief to log belief at the end of an episode: `static`, `hazard` or `transitions`.

    Attributes
    ----------
    log_belief : (n_types,) float
    surprise : float
        Sum of −log evidence in nats over the signals, each at most `MAX_SURPRISE`.
    unexplained : int
        Number of signals that no type explains.
    """

    def __init__(self, prior: Sequence[float], step: Step | None = None) -> None:
        self.log_belief = [log_of(p) for p in prior]
        self.step = step or static()
        self.surprise, self.unexplained = 0.0, 0

    def observe(self, log_likelihood: Sequence[float]) -> float:
        """Learn from a signal by its log likelihood of each type; the log evidence."""
        self.log_belief, evidence = bayes(self.log_belief, log_likelihood)
        self.unexplained += evidence == -inf
        self.surprise += min(-evidence, MAX_SURPRISE)
        return evidence

    def end_episode(self) -> None:
        """Take the step of the dynamics once, however many signals the episode had; none is allowed."""
        self.log_belief = self.step(self.log_belief)

    def update(self, log_likelihood: Sequence[float]) -> float:
        """An episode of a single signal; the log evidence."""
        evidence = self.observe(log_likelihood)
        self.end_episode()
        return evidence

    @property
    def belief(self) -> list[float]:
        """β, (n_types,), sums to 1."""
        return [exp(b) for b in normalised(self.log_belief)]


# ---- log likelihoods of signals, for one pair of type and policy -----------------------------------------------


def normal_log_density(value: float, mean: float, deviation: float) -> float:
    """Of a Gaussian outcome."""
    return -0.5 * ((value - mean) / deviation) ** 2 - log(deviation) - 0.5 * log(2 * pi)


def student_t_log_density(value: float, location: float, scale: float, freedom: float) -> float:
    """Of an outcome with a t distribution."""
    height = lgamma((freedom + 1) / 2) - lgamma(freedom / 2) - 0.5 * log(pi * freedom) - log(scale)
    return height - (freedom + 1) / 2 * log1p(((value - location) / scale) ** 2 / freedom)


def histogram_log_density(value: float, edges: Sequence[float], probs: Sequence[float]) -> float:
    """Of an outcome between rising edges; the last edge belongs to the last bin. Minus infinity outside."""
    for low, high, prob in zip(edges, edges[1:], probs, strict=False):
        if low <= value < high or (value == high == edges[-1]):
            return log_of(prob) - log(high - low)
    return -inf


def steps_log_probability(
    steps: Sequence[tuple[int, int, int]], table: Sequence[Sequence[Sequence[float]]]
) -> float:
    """Of independent steps (state, action, outcome) by `table` [state][action][outcome]."""
    return sum(log_of(table[state][action][outcome]) for state, action, outcome in steps)
