"""Shares of yes among answers, with exact (Clopper–Pearson) 95 % intervals, and of no answers."""

from collections.abc import Iterable

from scipy.stats import beta

from lifelore.core.metrics import Estimate, mean_estimate

UNMEASURED = Estimate(float("nan"), float("nan"), None, 0)
"""What a run that lacks its scenes says of them."""


def exact_share(answers: Iterable[bool]) -> Estimate:
    """Share of true answers, each of a scene of its own; `UNMEASURED` of none."""
    given = [bool(answer) for answer in answers]
    n, right = len(given), sum(given)
    if not n:
        return UNMEASURED
    low = float(beta.ppf(0.025, right, n - right + 1)) if right else 0.0
    high = float(beta.ppf(0.975, right + 1, n - right)) if right < n else 1.0
    return Estimate(right / n, float(2 * right > n) if 2 * right != n else 0.5, (low, high), n)


def mean_or_unmeasured(values: Iterable[float]) -> Estimate:
    """Mean with its bootstrap interval; `UNMEASURED` of no values."""
    given = list(values)
    return mean_estimate(given) if given else UNMEASURED
