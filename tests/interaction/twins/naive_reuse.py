"""Bayes' rule and the dynamics of types, type by type in plain Python: the slow twin of Algorithm 7's two steps.

    for each signal of an episode:  β(τ) ← F(σ | τ, π) β(τ) / Σ F β
    once, at its end:               β ← the step of the dynamics

Beliefs are logarithms, and every sum of probabilities is `math.fsum` of exponentials below 1, which is exact up to
its last rounding. Nothing is imported from the code under test. Thesis: §4.2, Alg. 7.
"""

from collections.abc import Callable, Sequence
from math import exp, fsum, inf, log, pi

Logs = list[float]
Step = Callable[[Logs], Logs]


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


# ---- log likelihoods of signals, for one pair of type and policy -----------------------------------------------


def normal_log_density(value: float, mean: float, deviation: float) -> float:
    """Of a Gaussian outcome."""
    return -0.5 * ((value - mean) / deviation) ** 2 - log(deviation) - 0.5 * log(2 * pi)


def steps_log_probability(
    steps: Sequence[tuple[int, int, int]], table: Sequence[Sequence[Sequence[float]]]
) -> float:
    """Of independent steps (state, action, outcome) by `table` [state][action][outcome]."""
    return sum(log_of(table[state][action][outcome]) for state, action, outcome in steps)
